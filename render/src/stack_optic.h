// What the tree of maps (pvrr_stack.h) needs of an optic at one place in it: curved ones (pvrr_optic.h) send
// rays through their vertices, planar ones (planar_optic.h) move the view.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>

#include "optics/placement.h"
#include "optics/vertex_hits.h"
#include "render/frame.h"
#include "render/src/raster_view.h"

namespace catoptra::render {

/// By which way light comes from the eye to points beyond an optic.
class LightWay {
 public:
  virtual ~LightWay() = default;
  /// To a point in the world; nullopt where none does.
  [[nodiscard]] virtual std::optional<optics::Arrival> light_to(const glm::dvec3& point_mm) const = 0;
  /// Counts up whenever it has changed.
  [[nodiscard]] virtual std::size_t changes() const = 0;
};

class StackOptic {
 public:
  virtual ~StackOptic() = default;

  /// The optic itself has changed; or something else that its maps show; or the bounds of everything.
  virtual void optic_changed() = 0;
  virtual void map_changed() = 0;
  virtual void set_bounds(const cad_import::BoundingBox& bounds) = 0;
  /// The optic is somewhere else.
  virtual void place(const optics::Placement& placement) = 0;
  /// Other optics have changed or moved.
  virtual void others_changed() = 0;

  /// The rest after update(). Whether any map of it shows something.
  [[nodiscard]] virtual bool faces_eye() const = 0;
  /// Its maps are numbered from 0 on; some may not be there.
  [[nodiscard]] virtual std::size_t patch_count() const = 0;
  [[nodiscard]] virtual bool has_map(std::size_t patch) const = 0;
  /// The view of a map, in the world and without sample offset, and the offset of its samples within its
  /// texels.
  [[nodiscard]] virtual RasterView map_camera(std::size_t patch) const = 0;
  [[nodiscard]] virtual glm::dvec2 map_offset(glm::dvec2 offset_px) const = 0;
  [[nodiscard]] virtual double texels_per_pixel(std::size_t patch) const = 0;
  /// How light comes to what a map shows; null: from the one eye of the map.
  [[nodiscard]] virtual const LightWay* light(std::size_t patch) const = 0;

  [[nodiscard]] virtual OpticStats statistics() const = 0;
  /// Texels of all maps.
  [[nodiscard]] virtual std::size_t map_texels() const = 0;
};

}  // namespace catoptra::render
