// Optics in optics: the tree of maps of mode pvrr (paper 4.4, Fig. 11).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "render/src/optic_bodies.h"
#include "render/src/pvrr_draw.h"
#include "render/src/pvrr_optic.h"

namespace catoptra::render {

/// One node for every optic of the scene, as the picture shows it; below a node, one for every other optic
/// that a map of it shows (one map for each patch), down to RenderSettings::depth levels (at least 1). To a
/// node's optic the view of the map above is what the camera is to those of the picture; it is one patch.
/// Below the last level mirrors are plain bodies of their reflectance, and lenses are left out. An optic that
/// sees itself directly (a deep concave mirror) is in none of its own maps; by way of another optic it is.
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
  /// No deeper than `levels`. `use`: of the maps of the first level.
  void update(const RasterView& camera, const FrameOptions& options, int levels, MapUse use);

  /// All maps that have to be drawn, the deepest first. Overlays go into those of the first level alone.
  void draw_maps(glm::dvec2 offset_px, bool geometry, Overlay* overlay);

  /// Of the first level: optics as the picture shows them.
  [[nodiscard]] std::size_t size() const { return roots_.size(); }
  [[nodiscard]] const PvrrOptic& optic(std::size_t index) const { return roots_[index]->optic; }
  [[nodiscard]] PvrrDraw& drawer() { return draw_; }

  /// Every map there is, from the top down, and warnings that concern the tree as a whole.
  [[nodiscard]] std::vector<MapStats> statistics() const;
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  struct Node {
    Node(const Scene& scene, std::size_t optic_index, RasterScene& raster, const optics::RayScene& rays,
         const cad_import::BoundingBox& bounds, const OpticPlace& place, int at_level, std::size_t in_patch)
        : index(optic_index),
          level(at_level),
          patch(in_patch),
          optic(scene, optic_index, raster, rays, bounds, place) {}
    std::size_t index;  ///< of the optic
    int level;          ///< 1: in the picture
    std::size_t patch;  ///< of the node above, whose map shows this one
    PvrrOptic optic;
    std::vector<std::unique_ptr<Node>> children;  ///< by patch, then by optic
    std::vector<NestedOptics> nested;             ///< per patch: how its map shows them
    bool drawn = false;                           ///< in the last sample
  };

  [[nodiscard]] std::unique_ptr<Node> make_node(std::size_t index, int level, std::size_t patch) const;
  void update_children(Node& node, const FrameOptions& options, std::vector<Node*>& next);
  static void set_children(Node& node, std::vector<std::unique_ptr<Node>> children);
  [[nodiscard]] bool may_show(const Node& node, const RasterView& map, std::size_t index) const;
  bool draw_map(Node& node, glm::dvec2 offset_px, bool geometry, Overlay* overlay);
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
  int levels_ = 1;
  std::size_t nodes_ = 0, left_out_ = 0;
  PvrrDraw draw_;
};

}  // namespace catoptra::render
