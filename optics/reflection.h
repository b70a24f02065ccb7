// The law of reflection, and what a curved mirror does to a narrow bundle.
#pragma once

#include <glm/vec3.hpp>

namespace catoptra::optics {

/// Reflects the unit direction `d` at a surface with unit normal `n` (either side). Returns a unit direction.
/// Source: Hecht, Optics, 5th ed. 2017, 4.3.
[[nodiscard]] glm::dvec3 reflect(const glm::dvec3& d, const glm::dvec3& n);

/// Angular magnification of a convex (radius_mm > 0) or concave (< 0) mirror for a far object: image angle /
/// object angle for an eye at `eye_distance_mm` from the mirror point and incidence angle `incidence_rad`.
struct MirrorMagnification {
  double tangential;  ///< in the plane of incidence: 1 / (1 + 2 a / (r cos b))
  double sagittal;    ///< across it: 1 / (1 + 2 a cos b / r)
};
[[nodiscard]] MirrorMagnification mirror_magnification(double eye_distance_mm, double radius_mm,
                                                       double incidence_rad);

}  // namespace catoptra::optics
