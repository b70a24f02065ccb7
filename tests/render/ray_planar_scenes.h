// Planar optics in front of walls of known colour.
#pragma once

#include <cmath>
#include <numbers>

#include "tests/render/ray_chain_scenes.h"

namespace catoptra::test {

/// A square planar optic at `pole_mm` that faces `normal`.
inline optics::Optic planar_optic(optics::OpticKind kind, const glm::dvec3& pole_mm, const glm::dvec3& normal,
                                  double width_mm) {
  optics::Optic optic = plane_mirror(pole_mm, normal, width_mm);
  optic.kind = kind;
  optic.planar = true;
  optic.two_sided = kind == optics::OpticKind::mirror;
  return optic;
}

/// The middle pixel of a narrow picture of `size` pixels a side.
inline std::size_t middle_of(int size) {
  return std::size_t(size / 2) * std::size_t(size) + std::size_t(size / 2);
}

/// A camera before the origin, at `angle_rad` from +z (below 0: or -z, with angles beyond pi / 2) in the
/// plane x = 0, that looks at the origin.
inline render::Camera camera_at_angle(double angle_rad, double distance_mm, double fov_rad = 0.02) {
  return {distance_mm * glm::dvec3(0, std::sin(angle_rad), std::cos(angle_rad)),
          {0, 0, 0},
          {1, 0, 0},
          fov_rad,
          {5, 5}};
}

inline double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

inline double degrees_of(double angle_rad) {
  return angle_rad * 180 / std::numbers::pi;
}

}  // namespace catoptra::test
