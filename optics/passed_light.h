// The light that leaves an optic, as a field: by which way it comes to a given point.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "optics/lens_path.h"
#include "optics/optic.h"
#include "optics/vertex_hits.h"

namespace catoptra::optics {

/// Solves for the ray of the eye that an optic sends through a point: Newton's method over the place at which
/// the optic is met, from the ray of the vertex that passes nearest, with the rays' own differentials as
/// derivatives and every further ray exact. Where another optic stands at that point, the light arrives there
/// so, and not as if it came from the one viewpoint of a map (paper 4.4). Thread-safe.
class PassedLight {
 public:
  using ArrivalAt = std::function<Arrival(const glm::dvec3& point_mm)>;

  /// `rays`: of the vertices of the mirror's mesh, or of that of the side at which the lens is entered, at
  /// one wavelength. `arrival`: how the light comes to any point of that surface. `tracer` and `indices`: of
  /// a lens (else null, unused). Everything that is referred to must outlive this.
  PassedLight(const Optic& optic, LensSide entered, const LensTracer* tracer, const LensIndices& indices,
              std::span<const VertexHit> rays, ArrivalAt arrival);

  /// Nullopt where no ray is found, as for points that the optic has its back to, and on caustics. Beyond the
  /// border of the optic the light goes on as if its surface did, as far as that is known; beyond that of what
  /// a lens lets pass by the differentials of the last ray that passes (`beyond_mm` tells how far).
  [[nodiscard]] std::optional<Arrival> to(const glm::dvec3& point_mm) const;

 private:
  struct Place {
    tessellate::OpticVertex vertex;
    VertexHit ray;
  };
  [[nodiscard]] std::optional<std::size_t> nearest(const glm::dvec3& point_mm) const;
  [[nodiscard]] std::optional<Place> moved(const Place& from, const glm::dvec3& step_mm) const;

  const Optic* optic_;
  LensSide entered_;
  const LensTracer* tracer_;
  LensIndices indices_;
  LensSideView side_;
  std::span<const VertexHit> rays_;
  ArrivalAt arrival_;
  std::vector<std::size_t> starts_;  // vertices with a ray, some of many
  double reach_mm_ = 0;              // of the surface
};

}  // namespace catoptra::optics
