// Exact hits on a mirror for packets of rays: the surface over each mesh triangle as a polynomial height.
//
// Newton iteration on the CAD surface costs several evaluations of it per ray. Here the surface is evaluated
// once, when the optic is set up: over each triangle the exact height above the triangle's plane is
// interpolated by a polynomial of degree 5 in the triangle's barycentric coordinates and compared with the
// surface at other points. Where both agree to kHeightTolerance and kSlopeTolerance, rays are intersected
// with the polynomial, sixteen at a time; elsewhere (a knot line crosses the triangle, a pole)
// optics::exact_hit does it. A picture in single precision cannot tell the two apart.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "optics/optic.h"
#include "optics/ray_scene.h"

namespace catoptra::render {

inline constexpr double kHeightTolerance =
    1e-8;  ///< mm; 1/1000 of what a float holds of a coordinate of 100 mm
inline constexpr double kSlopeTolerance = 1e-9;  ///< rad; 1/60 of what a float holds of a unit direction

/// Rays as a mirror sends them on. Structure of arrays.
struct alignas(64) MirrorRays {
  static constexpr int kLanes = 16;
  double surface_x[kLanes], surface_y[kLanes], surface_z[kLanes];        ///< exact hit, mm
  double reflected_x[kLanes], reflected_y[kLanes], reflected_z[kLanes];  ///< unit
  double distance[kLanes];                                               ///< eye to hit, mm
  /// Sum and product of the principal curvatures of the reflected wavefront at the hit, 1/mm and 1/mm^2, for
  /// a spherical wave from the eye; diverging positive.
  double wave_sum[kLanes], wave_product[kLanes];

  void copy_lane(const MirrorRays& from, int lane) {
    surface_x[lane] = from.surface_x[lane];
    surface_y[lane] = from.surface_y[lane];
    surface_z[lane] = from.surface_z[lane];
    reflected_x[lane] = from.reflected_x[lane];
    reflected_y[lane] = from.reflected_y[lane];
    reflected_z[lane] = from.reflected_z[lane];
    distance[lane] = from.distance[lane];
    wave_sum[lane] = from.wave_sum[lane];
    wave_product[lane] = from.wave_product[lane];
  }
};

/// Rays from one eye that hit the mesh of one optic, and what becomes of them.
struct alignas(64) MirrorLanes {
  static constexpr int kLanes = MirrorRays::kLanes;
  // In. Directions must be ordinary numbers in every lane, active or not.
  bool active[kLanes];
  double direction_x[kLanes], direction_y[kLanes], direction_z[kLanes];  ///< unit
  std::uint32_t triangle[kLanes];                                        ///< of the optic's mesh
  float u[kLanes], v[kLanes];  ///< weights of its second and third vertex
  // Out, for active lanes.
  MirrorRays out;
};

class ExactMirror {
 public:
  /// Samples every triangle, in parallel. `optic` must outlive this object and stay as it is.
  explicit ExactMirror(const optics::Optic& optic);

  /// Hits and reflects the active lanes.
  void reflect(const glm::dvec3& eye_mm, MirrorLanes& lanes) const;

  /// Share of the triangles over which the polynomial stands for the surface.
  [[nodiscard]] double polynomial_share() const;

 private:
  static constexpr int kDegree = 5, kCoefficients = (kDegree + 1) * (kDegree + 2) / 2;

  /// point = corner + b1 e1 + b2 e2 + height(b1, b2) normal, e1 and e2 the triangle's edges at its first
  /// corner.
  struct alignas(64) Patch {
    glm::dvec3 corner;
    glm::dvec3 g1, g2, normal;         ///< dual basis of (e1, e2, normal): b1 = g1 . (point - corner), ...
    double c[kCoefficients];           ///< of b1^i b2^j, by j, then i
    double h11 = 0, h12 = 0, h22 = 0;  ///< second derivatives of the height at the centroid
    double curvature_sum = 0, gaussian = 0;  ///< of the surface there, convex towards the normal positive
    bool valid = false;
  };
  friend struct PatchBuilder;

  void reflect_on_patch(const Patch& patch, const glm::dvec3& eye_mm,
                        const bool (&chosen)[MirrorLanes::kLanes], MirrorLanes& lanes,
                        bool (&solved)[MirrorLanes::kLanes]) const;
  void reflect_by_newton(const Patch& patch, const glm::dvec3& eye_mm, int lane, MirrorLanes& lanes) const;

  const optics::Optic& optic_;
  std::vector<Patch> patches_;
};

}  // namespace catoptra::render
