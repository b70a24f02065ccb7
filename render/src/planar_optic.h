// One planar optic in mode pvrr (docs/decisions/0015): where it shows, the views of what it reflects and
// passes, and their maps, kept while nothing changes them. No ray is traced.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "optics/planar_glass.h"
#include "render/src/map_colors.h"
#include "render/src/overlay_vertices.h"
#include "render/src/planar_map_view.h"
#include "render/src/pvrr_map.h"
#include "render/src/raster_scene.h"
#include "render/src/raster_target.h"
#include "render/src/stack_optic.h"

namespace catoptra::render {

/// By which view a planar optic is seen.
struct PlanarSight {
  const LightWay* above = nullptr;  ///< how light comes to what that view shows; null: from its eye
  double texels_before = 1;         ///< texels per pixel of the picture in that view
  /// Convex part of that view which shows anything at all, in its pixel coordinates; empty: all of it.
  std::span<const glm::dvec2> aperture;
  /// Whether what cannot be seen is looked for at all: facing alone, or also outlines in the view and
  /// aperture.
  bool checks = true;
  int sample = 0;  ///< of the picture: by it a rough face is tilted
};

class PlanarOptic final : public StackOptic {
 public:
  /// Of the maps.
  static constexpr std::size_t kReflected = 0, kPassed = 1;

  /// Keeps the references.
  PlanarOptic(const Scene& scene, std::size_t optic, RasterScene& raster);

  /// `camera`: the view that shows the optic, in the world, without sample offset. Returns whether the optic
  /// may be seen in it.
  bool update(const RasterView& camera, const FrameOptions& options, const PlanarSight& sight);

  void optic_changed() override;
  void map_changed() override;
  void set_bounds(const cad_import::BoundingBox&) override { map_changed(); }
  void place(const optics::Placement& placement) override;
  void others_changed() override {}
  [[nodiscard]] bool faces_eye() const override { return has_map(kReflected) || has_map(kPassed); }
  [[nodiscard]] std::size_t patch_count() const override { return maps_.size(); }
  [[nodiscard]] bool has_map(std::size_t map) const override {
    return map < maps_.size() && maps_[map].turn.has_value();
  }
  [[nodiscard]] RasterView map_camera(std::size_t map) const override { return maps_[map].camera; }
  [[nodiscard]] glm::dvec2 map_offset(glm::dvec2 offset_px) const override;
  [[nodiscard]] double texels_per_pixel(std::size_t) const override { return texels_before_; }
  [[nodiscard]] const LightWay* light(std::size_t map) const override;
  [[nodiscard]] OpticStats statistics() const override;
  [[nodiscard]] std::size_t map_texels() const override;

  /// Whether the side towards the eye does what the optic is for; if not, a mirror is a plain body and glass
  /// is not there.
  [[nodiscard]] bool works() const { return works_; }
  /// The part of a map that shows anything: convex, in its pixel coordinates; empty: all of it.
  [[nodiscard]] const PixelPolygon& aperture(std::size_t map) const { return maps_[map].aperture; }
  /// The view of a map as `above`, with its sample offset, shows the optic.
  [[nodiscard]] RasterView map_view(std::size_t map, const RasterView& above) const;

  /// Draws the maps as `above` needs them, unless they are there already; returns how many were drawn.
  /// `nested`: per map, the optics that each shows by their own maps.
  std::size_t draw_maps(const RasterView& above, bool geometry, Overlay* overlay,
                        std::span<const NestedOptics> nested);

  /// For mode exact: what is seen of points of the scene in the mirror or through the pane, by the view of
  /// the last draw. The skewed maps behind a refractor are left out.
  void copy_maps(MapColors& maps) const;

  // For PlanarDraw.
  [[nodiscard]] std::size_t index() const { return index_; }
  [[nodiscard]] const RasterTarget& target(std::size_t map) const { return *maps_[map].target; }
  [[nodiscard]] const PixelRect& rect() const { return rect_; }
  [[nodiscard]] double near(std::size_t map) const { return maps_[map].near; }
  [[nodiscard]] const glm::dvec3& passed_eye_mm() const { return maps_[kPassed].turn->eye_mm; }
  [[nodiscard]] const optics::Plane& plane() const { return plane_; }
  /// Index of the medium behind the face over that before it, as the eye meets them.
  [[nodiscard]] double index_ratio() const { return index_ratio_; }

 private:
  /// Of a plane mirror below a curved optic, whose light comes from no one eye.
  class MirroredLight final : public LightWay {
   public:
    void set(const LightWay* above, const optics::Plane& plane);
    [[nodiscard]] std::optional<optics::Arrival> light_to(const glm::dvec3& point_mm) const override;
    [[nodiscard]] std::size_t changes() const override { return above_->changes() + changes_; }
    [[nodiscard]] bool known() const { return above_ != nullptr; }

   private:
    const LightWay* above_ = nullptr;
    optics::Plane plane_;
    std::size_t changes_ = 0;
  };
  struct Drawn {
    RasterView view;
    bool geometry;
    int multisample;
  };
  struct Map {
    std::optional<PlanarTurn> turn;  ///< nullopt: no such map
    double near = 1;
    RasterView camera;  ///< of the map, without sample offset
    PixelPolygon aperture;
    std::unique_ptr<RasterTarget> target, smooth;
    std::optional<Drawn> drawn;
  };

  void set_plane();
  [[nodiscard]] bool see(const RasterView& camera, const PlanarSight& sight);
  void set_turns(const RasterView& camera, const PlanarSight& sight);
  [[nodiscard]] optics::Plane tilted(const glm::dvec3& eye_mm, int sample) const;
  [[nodiscard]] double least_w(const RasterView& camera, const PlanarTurn& turn) const;
  [[nodiscard]] std::optional<PlanarTurn> passed_turn(const RasterView& camera) const;
  [[nodiscard]] optics::Plane keep_plane(const PlanarTurn& turn) const;
  [[nodiscard]] bool reflection_matters(const RasterView& camera) const;
  void draw_map(Map& map, const RasterView& view, bool geometry, Overlay* overlay,
                const NestedOptics* nested);

  const Scene& scene_;
  const optics::Optic& optic_;
  std::size_t index_;
  RasterScene& raster_;
  optics::Placement placement_;
  optics::PlanarFace face_;  ///< in its own frame, as tilts are

  // Of the last update(), in the world.
  std::vector<glm::dvec3> outline_;  ///< convex hull of the face
  optics::Plane plane_;              ///< through the face's centre, its normal towards the eye
  bool works_ = false;
  double index_ratio_ = 1, texels_before_ = 1;
  std::vector<glm::dvec3> seen_;  ///< the part of the outline in the view
  PixelPolygon in_view_;          ///< the same, and within the aperture
  PixelRect rect_;
  MirroredLight light_;
  std::vector<Map> maps_;  ///< one of a mirror, two of glass
  int multisample_ = 1;
};

}  // namespace catoptra::render
