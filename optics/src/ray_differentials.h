// How rays change when they are moved: one step per event along the path (Igehy, SIGGRAPH 1999, 3.1, 3.2).
#pragma once

#include <glm/geometric.hpp>

#include "optics/vertex_hits.h"

namespace catoptra::optics {

/// The surface near a point of a path, to second order.
struct LocalSurface {
  glm::dvec3 normal{0};  ///< unit, out of the material
  double k1 = 0, k2 = 0;
  glm::dvec3 direction1{0};  ///< of k1; k2 goes with cross(normal, direction1)
};

/// A ray where it meets a surface: `moved` of it per mm across.
[[nodiscard]] RayDifferential arriving_differential(const Arrival& arrival, const glm::dvec3& normal);

/// The same ray `length_mm` further on, where it meets a surface of unit normal `normal`.
[[nodiscard]] RayDifferential transferred(const RayDifferential& ray, const glm::dvec3& direction,
                                          double length_mm, const glm::dvec3& normal);

/// After reflection of the unit direction `d`.
[[nodiscard]] RayDifferential reflected(const RayDifferential& ray, const glm::dvec3& d,
                                        const LocalSurface& surface);

/// After refraction of the unit direction `d` into `out`, with eta = n_from / n_to.
[[nodiscard]] RayDifferential refracted(const RayDifferential& ray, const glm::dvec3& d,
                                        const glm::dvec3& out, double eta, const LocalSurface& surface);

}  // namespace catoptra::optics
