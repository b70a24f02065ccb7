#include "optics/src/lens_chief_ray.h"

#include <glm/geometric.hpp>

namespace catoptra::optics {
namespace {

// Near a pole of the parameters (revolved faces meet at one on the axis of a lens) du x dv vanishes and the
// second derivatives say nothing in double precision: below this share of |du|^2 + |dv|^2 they are wrong by
// more than 1e-6.
constexpr double kPole = 1e-5;

// So much of the way to the domain's middle, as principal_curvatures() goes: about 1 um on a lens. Surfaces
// whose curvature changes in proportion to the distance from the pole (a headset's lens does, by 0.09 D per
// mm) lose 1e-4 D by that.
constexpr double kInside = 1e-4;

bool at_pole(const cad_import::SurfaceDerivatives& s) {
  return glm::length(glm::cross(s.du, s.dv)) <= kPole * (glm::dot(s.du, s.du) + glm::dot(s.dv, s.dv));
}

// The same surface in other parameters: arc lengths along the principal directions.
cad_import::SurfaceDerivatives by_curvature(const cad_import::ExactSurface& surface, const ExactHit& hit) {
  const cad_import::ParameterDomain d = surface.domain();
  const double u = hit.uv.x + kInside * (0.5 * (d.u_min + d.u_max) - hit.uv.x),
               v = hit.uv.y + kInside * (0.5 * (d.v_min + d.v_max) - hit.uv.y);
  const cad_import::PrincipalCurvatures c = surface.principal_curvatures(u, v);
  const glm::dvec3 n = hit.normal;
  const glm::dvec3 du = glm::normalize(c.direction1 - n * glm::dot(n, c.direction1)), dv = glm::cross(n, du);
  return {hit.position_mm, du, dv, -c.k1 * n, glm::dvec3(0), -c.k2 * n};
}

}  // namespace

cad_import::SurfaceDerivatives ChiefRayTracer::derivatives(LensSide side, const ExactHit& hit) const {
  const cad_import::ExactSurface& surface = *side_of(lens_, side).faces[std::size_t(hit.face)].surface;
  const cad_import::SurfaceDerivatives exact = surface.d2(hit.uv.x, hit.uv.y);
  return at_pole(exact) ? by_curvature(surface, hit) : exact;
}

ChiefRay ChiefRayTracer::trace(const Ray& ray, const ChiefRayTask& task) const {
  LensPath path = tracer_.trace(ray, LensSide::back, task.indices);
  if (path.end == LensPathEnd::missed) return {};
  ChiefRay chief;
  chief.back_mm = path.entry.position_mm;
  chief.eye_side = ray.direction;
  const ExactHit entry = path.entry;
  const auto path_at = [&](const LensIndices& indices) {
    return tracer_.trace_from({chief.back_mm - chief.eye_side, chief.eye_side}, entry, LensSide::back,
                              indices);
  };
  if (task.kind == ChiefRayKind::along_the_normal) {
    chief.eye_side = -entry.normal;
    path = path_at(task.indices);
  }
  chief.end = path.end;
  if (chief.end != LensPathEnd::passed) return chief;
  chief.object_side = path.outside;

  // The light runs the other way: from the object through the front, across the lens, out at the back.
  const double into = task.indices.around / task.indices.lens;
  const Wavefront arriving = spherical_wavefront(-path.outside, task.object_distance_mm);
  const Wavefront entered =
      refracted(arriving, -path.outside, -path.inside, into, derivatives(LensSide::front, path.exit));
  const Wavefront crossed =
      transferred(entered, -path.inside, glm::distance(entry.position_mm, path.exit.position_mm));
  chief.wave =
      refracted(crossed, -path.inside, -chief.eye_side, 1 / into, derivatives(LensSide::back, entry));

  if (!task.coloured) return chief;
  const LensPath f = path_at(task.indices_f), c = path_at(task.indices_c);
  chief.coloured = f.end == LensPathEnd::passed && c.end == LensPathEnd::passed;
  chief.object_side_f = f.outside;
  chief.object_side_c = c.outside;
  return chief;
}

// A pencil from the ray's origin is a spherical wave: a displacement a across the ray at its surface point
// changes the direction by Q a, and displacements at a surface are taken along the rays onto its tangent
// plane.
std::optional<ChiefRayTracer::Turning> ChiefRayTracer::turning(const Ray& ray, const glm::dvec3& x,
                                                               const glm::dvec3& y,
                                                               const LensIndices& indices) const {
  const LensPath path = tracer_.trace(ray, LensSide::back, indices);
  if (path.end != LensPathEnd::passed) return std::nullopt;
  const double into = indices.around / indices.lens;
  const double before = glm::distance(ray.origin_mm, path.entry.position_mm),
               across = glm::distance(path.entry.position_mm, path.exit.position_mm);
  const Wavefront inside = refracted(spherical_wavefront(ray.direction, before), ray.direction, path.inside,
                                     into, derivatives(LensSide::back, path.entry));
  const Wavefront outside = refracted(transferred(inside, path.inside, across), path.inside, path.outside,
                                      1 / into, derivatives(LensSide::front, path.exit));
  const auto onto = [](const glm::dvec3& a, const glm::dvec3& d, const glm::dvec3& n) {
    return a - d * (glm::dot(n, a) / glm::dot(n, d));
  };
  const auto turned = [&](const glm::dvec3& a) {
    const glm::dvec3 back = onto(before * a, ray.direction, path.entry.normal);
    const glm::dvec3 front = onto(back + across * (inside.curvature * back), path.inside, path.exit.normal);
    return outside.curvature * front;
  };
  return Turning{path.outside, turned(x), turned(y)};
}

}  // namespace catoptra::optics
