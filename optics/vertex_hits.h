// PVRR step 1: what each vertex of an optic shows (paper 3.1, steps 1 and 3.1; lenses 4.5 and 5).
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "optics/lens_path.h"
#include "optics/optic.h"
#include "optics/ray_scene.h"

namespace catoptra::optics {

/// How the ray that leaves the optic changes while the eye stays and the eye's ray is moved, per mm of
/// movement of its point at the vertex (movement along the ray changes nothing). Source: Igehy, Tracing ray
/// differentials, SIGGRAPH 1999, 3.1 and 3.2.
struct RayDifferential {
  glm::dmat3 point{0};      ///< of `surface_point_mm`
  glm::dmat3 direction{0};  ///< of `direction`, 1/mm
};

/// How light travels, against its direction, to a point of an optic: straight from the eye, or by way of
/// other optics.
struct Arrival {
  glm::dvec3 origin_mm{0};  ///< the eye, or the last point on another optic; the ray passes it and the point
  glm::dvec3 direction{0};  ///< unit, from there to the point
  glm::dmat3 turn{0};       ///< change of `direction` per mm by which the point moves across it, 1/mm
  double beyond_mm = 0;     ///< so far beyond the border of what another optic lets pass; 0: light comes here
};

[[nodiscard]] Arrival arrival_from_eye(const glm::dvec3& eye_mm, const glm::dvec3& point_mm);

struct VertexHit {
  glm::dvec3 surface_point_mm{0};  ///< last point on the optic: a mirror's vertex itself, a lens's exit point
                                   ///< (the vertex where the path does not pass)
  glm::dvec3 direction{0};         ///< unit outgoing direction
  bool faces_eye = false;  ///< the optic shows something here: a mirror's reflecting side is towards the eye,
                           ///< a lens's path passes; if not, the direction is meaningless
  LensPathEnd end = LensPathEnd::passed;  ///< of a lens; `missed` where its side looks away from the eye
  double transmittance = 1;               ///< Fresnel, unpolarised; 1 for mirrors, whose reflectance is the
                                          ///< optic's
  glm::dvec3 from_eye{0};                 ///< unit direction in which the eye's ray arrives
  double beyond_mm = 0;                   ///< Arrival::beyond_mm
  RayDifferential differential;           ///< valid where faces_eye
  Hit scene_hit;                          ///< nearest hit among the surroundings; empty: the sky
  glm::dvec3 hit_point_mm{0};             ///< valid where scene_hit is
};

/// Secondary rays start this far from the optic, mm: the mirror's own back and edge are meshed to a chord
/// error and may stick out of the exact glass by about as much.
inline constexpr double kSelfHitDistance_mm = 0.01;

/// The unit normal on the side that reflects, from a face's outward one.
[[nodiscard]] inline glm::dvec3 reflecting_normal(const Optic& optic, const glm::dvec3& normal) {
  return optic.flip ? -normal : normal;
}

/// The reflected ray of each vertex of `optic.mesh`, in its order, without scene hits. Depends on nothing but
/// the positions of eye and mirror. Throws catoptra::Error for a lens.
[[nodiscard]] std::vector<VertexHit> reflect_vertices(const Optic& mirror, const glm::dvec3& eye_mm);

/// One such ray, through any point of the mirror, for which `vertex` holds what a vertex would.
[[nodiscard]] VertexHit reflect_vertex(const tessellate::OpticVertex& vertex, const Optic& mirror,
                                       const glm::dvec3& eye_mm);
/// The same for light that has come another way; `arrival`: at the vertex.
[[nodiscard]] VertexHit reflect_vertex(const tessellate::OpticVertex& vertex, const Optic& mirror,
                                       const Arrival& arrival);

/// The refracted ray of each vertex of the entered side's mesh, in its order, without scene hits: exact on
/// both surfaces. Depends on nothing but the positions of eye and lens, so a renderer keeps it while those
/// stay (paper 5). `tracer` belongs to `lens`.
[[nodiscard]] std::vector<VertexHit> refract_vertices(const Optic& lens, const LensTracer& tracer,
                                                      LensSide entered, double wavelength_nm,
                                                      const glm::dvec3& eye_mm);
/// The same with one arrival per vertex.
[[nodiscard]] std::vector<VertexHit> refract_vertices(const Optic& lens, const LensTracer& tracer,
                                                      LensSide entered, double wavelength_nm,
                                                      std::span<const Arrival> arrivals);

/// One such ray, through any point of the entered side, for which `vertex` holds what a vertex would.
[[nodiscard]] VertexHit refract_vertex(const tessellate::OpticVertex& vertex, const Optic& lens,
                                       const LensTracer& tracer, LensSide entered, const LensIndices& indices,
                                       const glm::dvec3& eye_mm);
[[nodiscard]] VertexHit refract_vertex(const tessellate::OpticVertex& vertex, const Optic& lens,
                                       const LensTracer& tracer, LensSide entered, const LensIndices& indices,
                                       const Arrival& arrival);

/// The same rays with their hits among the surroundings of `scene`; former hits are replaced.
[[nodiscard]] std::vector<VertexHit> find_scene_hits(std::vector<VertexHit> rays, const RayScene& scene);

/// Rays and hits of a mirror: one entry per vertex of `optic.mesh`. Throws catoptra::Error for a lens.
[[nodiscard]] std::vector<VertexHit> trace_vertices(const Optic& optic, const glm::dvec3& eye_mm,
                                                    const RayScene& scene);

/// Rays and hits of a lens: one entry per vertex of the entered side's mesh.
[[nodiscard]] std::vector<VertexHit> trace_vertices(const Optic& lens, const LensTracer& tracer,
                                                    LensSide entered, double wavelength_nm,
                                                    const glm::dvec3& eye_mm, const RayScene& scene);

}  // namespace catoptra::optics
