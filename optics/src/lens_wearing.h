// Where the eye is, and which way it looks, in model coordinates.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "optics/lens_evaluation.h"

namespace catoptra::optics {

/// Orthonormal axes in model coordinates: the lens's, or the wearer's.
struct Axes {
  glm::dvec3 x, y, z;

  [[nodiscard]] glm::dvec3 to_model(const glm::dvec3& v) const { return v.x * x + v.y * y + v.z * z; }
  [[nodiscard]] glm::dvec3 from_model(const glm::dvec3& v) const {
    return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)};
  }
};

[[nodiscard]] Axes lens_axes(const LensFrame& frame);

/// The axes of a wearer before whose eye the lens of `frame` sits turned: z straight ahead, y up.
[[nodiscard]] Axes wearer_axes(const LensFrame& frame, const WearingPosition& position);

/// x and y of `axes` after the shortest rotation of z into the unit direction `d`, not opposite to z; z is
/// `d`. Rotation of a into b: v - (a + b) (a + b).v / (1 + a.b) + 2 b a.v, here for v across a.
[[nodiscard]] inline Axes listing_axes(const Axes& axes, const glm::dvec3& d) {
  const glm::dvec3 sum = axes.z + d;
  const double scale = 1 / (1 + glm::dot(axes.z, d));
  return {axes.x - sum * (glm::dot(d, axes.x) * scale), axes.y - sum * (glm::dot(d, axes.y) * scale), d};
}

/// Unit direction of a gaze, and back.
[[nodiscard]] glm::dvec3 gaze_direction(const Axes& axes, const glm::dvec2& gaze_rad);
[[nodiscard]] glm::dvec2 gaze_of(const Axes& axes, const glm::dvec3& d);

}  // namespace catoptra::optics
