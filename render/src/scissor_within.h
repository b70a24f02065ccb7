// The part of a view in which a light volume may show, as scissor rectangle.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>

#include "render/src/gl_objects.h"
#include "render/src/raster_view.h"

namespace catoptra::render {

/// Pixels of the target, first column and row and size, within which `view` shows the volume behind `corners`
/// of an aperture, away from `light` ((position, 1), or (direction towards the light, 0)) to infinity; both
/// in the world. Two pixels wider, for sample offsets and rounding. All of the view where it is parallel,
/// turned round or has its bottom row first.
[[nodiscard]] glm::ivec4 pixels_of_beam(const RasterView& view, std::span<const glm::vec3> corners,
                                        const glm::dvec4& light);

/// While it lives, nothing is drawn elsewhere, nor outside the scissor rectangle that was there before.
class ScissorWithin {
 public:
  ScissorWithin(const RasterView& view, std::span<const glm::vec3> corners, const glm::dvec4& light);
  ~ScissorWithin();
  ScissorWithin(const ScissorWithin&) = delete;
  ScissorWithin& operator=(const ScissorWithin&) = delete;

  [[nodiscard]] bool empty() const { return empty_; }

 private:
  bool was_on_ = false, empty_ = false;
  std::array<GLint, 4> before_{};
};

}  // namespace catoptra::render
