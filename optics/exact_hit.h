// From a mesh hit to the exact surface by Newton iteration.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "cad_import/exact_surface.h"
#include "optics/optic.h"
#include "optics/ray_packet.h"

namespace catoptra::optics {

/// Where a ray meets an exact surface.
struct ExactHit {
  double t_mm = 0;
  glm::dvec3 position_mm{0};
  glm::dvec3 normal{0};  ///< unit, out of the material
  int face = 0;          ///< index in the faces of the optic (or of the side of a lens)
  glm::dvec2 uv{0};
  int iterations = 0;
};

/// Distance between ray and surface point at which the iteration has converged, mm.
inline constexpr double kExactHitTolerance = 1e-10;

/// Solves surface(u, v) = origin + t direction from the start (u, v). Nullopt where the iteration leaves the
/// surface or does not converge within 20 steps, or t lies outside the ray's range. Trimming is not tested.
[[nodiscard]] std::optional<ExactHit> newton_hit(const cad_import::ExactSurface& surface, const Ray& ray,
                                                 glm::dvec2 start_uv);

/// The exact hit that belongs to a hit `mesh_hit` on the optic's mesh: Newton from the interpolated (u, v) of
/// the triangle; where that fails or lands outside the face's trimming, from the neighbouring faces of the
/// optic.
[[nodiscard]] std::optional<ExactHit> exact_hit(const Optic& optic, const Ray& ray, const Hit& mesh_hit);

/// The same for one side of a lens.
[[nodiscard]] std::optional<ExactHit> exact_hit(std::span<const cad_import::Face> faces,
                                                const tessellate::OpticArrays& mesh, const Ray& ray,
                                                const Hit& mesh_hit);

}  // namespace catoptra::optics
