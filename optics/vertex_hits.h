// PVRR step 1: what each vertex of an optic reflects (paper 3.1, steps 1 and 3.1).
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "optics/optic.h"
#include "optics/ray_scene.h"

namespace catoptra::optics {

struct VertexHit {
  glm::dvec3 surface_point_mm{0};  ///< last point on the optic: the vertex itself for a mirror
  glm::dvec3 direction{0};         ///< unit outgoing direction
  bool faces_eye = false;  ///< the reflecting side is towards the eye; if not, the direction is meaningless
  Hit scene_hit;           ///< nearest hit among the surroundings; empty: the sky
  glm::dvec3 hit_point_mm{0};  ///< valid where scene_hit is
};

/// Secondary rays start this far from the optic, mm: the mirror's own back and edge are meshed to a chord
/// error and may stick out of the exact glass by about as much.
inline constexpr double kSelfHitDistance_mm = 0.01;

/// The unit normal on the side that reflects, from a face's outward one.
[[nodiscard]] inline glm::dvec3 reflecting_normal(const Optic& optic, const glm::dvec3& normal) {
  return optic.flip ? -normal : normal;
}

/// One entry per vertex of `optic.mesh`, in its order. `scene` is asked for surroundings only. Throws
/// catoptra::Error for a lens.
[[nodiscard]] std::vector<VertexHit> trace_vertices(const Optic& optic, const glm::dvec3& eye_mm,
                                                    const RayScene& scene);

}  // namespace catoptra::optics
