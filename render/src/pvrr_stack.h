// Optics in optics: the tree of maps of mode pvrr (paper 4.4, Fig. 11).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/src/optic_bodies.h"
#include "render/src/planar_draw.h"
#include "render/src/planar_optic.h"
#include "render/src/pvrr_draw.h"
#include "render/src/pvrr_optic.h"

namespace catoptra::render {

/// One node for every optic of the scene, as the picture shows it; below a node, one for every other optic
/// that a map of it shows (curved optics have one for each patch, planar ones one for reflected and one for
/// passed light), down to RenderSettings::depth levels (at least 1). To a node's optic the view of the map
/// above is what the camera is to those of the picture; a curved one is one patch. Below the last level
/// mirrors are plain bodies of their reflectance, and lenses and glass are left out. An optic that sees
/// itself directly (a deep concave mirror) is in none of its own maps; by way of another optic it is.
class PvrrStack {
 public:
  /// Keeps the references. `bounds`: of everything in the scene.
  PvrrStack(const Scene& scene, RasterScene& raster, const optics::RayScene& rays,
            const cad_import::BoundingBox& bounds);

  /// The optic has changed, or is somewhere else now (which the raster scene knows already); `bounds` as
  /// above.
  void optic_changed(std::size_t index, const cad_import::BoundingBox& bounds);
  void place_optic(std::size_t index, const optics::Placement& placement,
                   const cad_import::BoundingBox& bounds);

  /// Rays, views and sizes of all maps, from the top down: which optics a map shows depends on its view.
  /// No deeper than `levels`. `use`: of the maps of the first level. `sample`: Camera::sample.
  void update(const RasterView& camera, int sample, const FrameOptions& options, int levels, MapUse use);

  /// All maps that have to be drawn, the deepest first, for the camera of the last update(). Overlays go into
  /// those of the first level alone.
  void draw_maps(glm::dvec2 offset_px, bool geometry, Overlay* overlay);

  /// Of the first level: optics as the picture shows them.
  [[nodiscard]] std::size_t size() const { return roots_.size(); }
  [[nodiscard]] const StackOptic& optic(std::size_t index) const { return *roots_[index]->optic; }
  /// The same by what it is; null if it is not.
  [[nodiscard]] const PvrrOptic* curved(std::size_t index) const { return roots_[index]->curved; }
  [[nodiscard]] const PlanarOptic* planar(std::size_t index) const { return roots_[index]->planar; }
  /// Draws optic `index` into the picture: see PvrrDraw::draw and PlanarDraw::draw.
  void draw(std::size_t index, const RasterTarget& target, const RasterView& camera, glm::dvec2 offset_px,
            bool geometry);

  /// Every map there is, from the top down, and warnings that concern the tree as a whole.
  [[nodiscard]] std::vector<MapStats> statistics() const;
  [[nodiscard]] std::size_t pruned() const { return pruned_; }
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  struct Node {
    std::size_t index;  ///< of the optic
    int level;          ///< 1: in the picture
    std::size_t patch;  ///< of the node above, whose map shows this one
    std::unique_ptr<StackOptic> optic;
    PvrrOptic* curved = nullptr;  ///< the same optic by what it is: one of them
    PlanarOptic* planar = nullptr;
    std::vector<std::unique_ptr<Node>> children;  ///< by patch, then by optic
    std::vector<NestedOptics> nested;             ///< per patch: how its map shows them
    bool drawn = false;                           ///< in the last sample
    std::size_t draws = 0;                        ///< draw calls for that
  };
  /// How a node is seen: the map that shows it, and what of that shows anything.
  struct Sight {
    RasterView camera;
    double texels_before = 1;
    const LightWay* above = nullptr;
    std::span<const glm::dvec2> aperture;
    MapUse use = MapUse::picture;
  };

  [[nodiscard]] std::unique_ptr<Node> make_node(std::size_t index, int level, std::size_t patch) const;
  /// Whether the optic may be seen so.
  bool update_node(Node& node, const FrameOptions& options, const Sight& sight) const;
  [[nodiscard]] bool has_room(std::size_t index) const;
  void update_children(Node& node, const FrameOptions& options, std::vector<Node*>& next);
  void update_patch(Node& node, std::size_t patch, const FrameOptions& options,
                    std::vector<std::unique_ptr<Node>>& former, std::vector<std::unique_ptr<Node>>& children);
  static void set_children(Node& node, std::vector<std::unique_ptr<Node>> children);
  [[nodiscard]] bool may_show(const Node& node, const RasterView& map, std::size_t index) const;
  /// `above`: the view that shows the node, with its sample offset `offset_px`.
  bool draw_map(Node& node, const RasterView& above, glm::dvec2 offset_px, bool geometry, Overlay* overlay);
  void draw_node(const Node& node, const RasterTarget& target, const RasterView& view, glm::dvec2 offset_px,
                 const PvrrDraw::Look& look);
  template <typename Visit>
  void visit(const Visit& each);
  void bounds_changed(const cad_import::BoundingBox& bounds);

  const Scene& scene_;
  RasterScene& raster_;
  const optics::RayScene& rays_;
  cad_import::BoundingBox bounds_;
  OpticBodies bodies_;
  std::vector<optics::Placement> placements_;
  std::vector<std::unique_ptr<Node>> roots_;
  int levels_ = 1, sample_ = 0;
  RasterView camera_;
  std::size_t curved_nodes_ = 0, planar_nodes_ = 0, left_out_ = 0, pruned_ = 0;
  PvrrDraw draw_;
  PlanarDraw planar_draw_;
};

}  // namespace catoptra::render
