#include "optics/vertex_hits.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <glm/geometric.hpp>
#include <string>

#include "cad_import/error.h"
#include "optics/reflection.h"
#include "optics/src/ray_differentials.h"

namespace catoptra::optics {
namespace {

constexpr std::size_t kVerticesPerTask = 64;  // some 50 us of paths, well above what a task costs

LocalSurface surface_at(const tessellate::OpticVertex& vertex) {
  return {vertex.normal, vertex.k1, vertex.k2, vertex.direction1};
}

LocalSurface surface_at(std::span<const cad_import::Face> faces, const ExactHit& hit) {
  const auto curvature =
      faces[static_cast<std::size_t>(hit.face)].surface->principal_curvatures(hit.uv.x, hit.uv.y);
  return {hit.normal, curvature.k1, curvature.k2, curvature.direction1};
}

VertexHit arrived(const tessellate::OpticVertex& vertex, const Arrival& arrival) {
  VertexHit hit;
  hit.surface_point_mm = vertex.position_mm;
  hit.from_eye = arrival.direction;
  hit.beyond_mm = arrival.beyond_mm;
  return hit;
}

}  // namespace

Arrival arrival_from_eye(const glm::dvec3& eye_mm, const glm::dvec3& point_mm) {
  const glm::dvec3 towards = point_mm - eye_mm;
  const double distance = glm::length(towards);
  Arrival arrival{eye_mm, towards / distance, glm::dmat3(0)};
  const glm::dvec3& d = arrival.direction;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 move{0};
    move[axis] = 1;
    arrival.turn[axis] = (move - d[axis] * d) / distance;
  }
  return arrival;
}

VertexHit reflect_vertex(const tessellate::OpticVertex& vertex, const Optic& mirror,
                         const glm::dvec3& eye_mm) {
  return reflect_vertex(vertex, mirror, arrival_from_eye(eye_mm, vertex.position_mm));
}

VertexHit reflect_vertex(const tessellate::OpticVertex& vertex, const Optic& mirror, const Arrival& arrival) {
  VertexHit hit = arrived(vertex, arrival);
  hit.faces_eye = glm::dot(hit.from_eye, reflecting_normal(mirror, vertex.normal)) < 0;
  if (!hit.faces_eye) return hit;
  hit.direction = reflect(hit.from_eye, vertex.normal);
  hit.differential =
      reflected(arriving_differential(arrival, vertex.normal), hit.from_eye, surface_at(vertex));
  return hit;
}

std::vector<VertexHit> reflect_vertices(const Optic& mirror, const glm::dvec3& eye_mm) {
  if (mirror.kind != OpticKind::mirror)
    throw Error("", mirror.name, "is no mirror, and only mirrors can be traced so");
  std::vector<VertexHit> hits;
  hits.reserve(mirror.mesh.vertices.size());
  for (const tessellate::OpticVertex& vertex : mirror.mesh.vertices)
    hits.push_back(reflect_vertex(vertex, mirror, eye_mm));
  return hits;
}

VertexHit refract_vertex(const tessellate::OpticVertex& vertex, const Optic& lens, const LensTracer& tracer,
                         LensSide entered, const LensIndices& indices, const glm::dvec3& eye_mm) {
  return refract_vertex(vertex, lens, tracer, entered, indices, arrival_from_eye(eye_mm, vertex.position_mm));
}

VertexHit refract_vertex(const tessellate::OpticVertex& vertex, const Optic& lens, const LensTracer& tracer,
                         LensSide entered, const LensIndices& indices, const Arrival& arrival) {
  VertexHit hit = arrived(vertex, arrival);
  const double distance = glm::distance(arrival.origin_mm, vertex.position_mm);
  hit.end = LensPathEnd::missed;
  hit.transmittance = 0;
  if (!(glm::dot(hit.from_eye, vertex.normal) < 0)) return hit;
  const ExactHit entry{distance, vertex.position_mm, vertex.normal, vertex.face, vertex.uv, 0};
  const LensPath path = tracer.trace_from({arrival.origin_mm, hit.from_eye}, entry, entered, indices);
  hit.end = path.end;
  if (path.end != LensPathEnd::passed) return hit;
  hit.faces_eye = true;
  hit.surface_point_mm = path.exit.position_mm;
  hit.direction = path.outside;
  hit.transmittance = path.transmittance;
  const LocalSurface exit = surface_at(side_of(lens, other_side(entered)).faces, path.exit);
  const double inwards = indices.around / indices.lens;
  const auto inside = refracted(arriving_differential(arrival, vertex.normal), hit.from_eye, path.inside,
                                inwards, surface_at(vertex));
  hit.differential = refracted(transferred(inside, path.inside, path.exit.t_mm, exit.normal), path.inside,
                               path.outside, 1 / inwards, exit);
  return hit;
}

std::vector<VertexHit> refract_vertices(const Optic& lens, const LensTracer& tracer, LensSide entered,
                                        double wavelength_nm, const glm::dvec3& eye_mm) {
  if (lens.kind != OpticKind::lens)
    throw Error("", lens.name, "is no lens, and only lenses can be traced so");
  std::vector<Arrival> arrivals;
  for (const auto& vertex : side_of(lens, entered).mesh->vertices)
    arrivals.push_back(arrival_from_eye(eye_mm, vertex.position_mm));
  return refract_vertices(lens, tracer, entered, wavelength_nm, arrivals);
}

std::vector<VertexHit> refract_vertices(const Optic& lens, const LensTracer& tracer, LensSide entered,
                                        double wavelength_nm, std::span<const Arrival> arrivals) {
  const auto& vertices = side_of(lens, entered).mesh->vertices;
  if (arrivals.size() != vertices.size())
    throw Error(
        "", lens.name,
        std::to_string(arrivals.size()) + " arrivals for " + std::to_string(vertices.size()) + " vertices");
  const LensIndices indices = lens_indices(lens, wavelength_nm);
  std::vector<VertexHit> hits(vertices.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, hits.size(), kVerticesPerTask), [&](const auto& some) {
    for (std::size_t i = some.begin(); i < some.end(); ++i)
      hits[i] = refract_vertex(vertices[i], lens, tracer, entered, indices, arrivals[i]);
  });
  return hits;
}

std::vector<VertexHit> find_scene_hits(std::vector<VertexHit> hits, const RayScene& scene) {
  std::vector<Ray> rays;
  std::vector<std::size_t> vertex_of_ray;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    hits[i].scene_hit = {};
    if (!hits[i].faces_eye) continue;
    rays.push_back({hits[i].surface_point_mm, hits[i].direction, kSelfHitDistance_mm});
    vertex_of_ray.push_back(i);
  }
  const std::vector<Hit> scene_hits = scene.intersect(rays, kSurroundings);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    VertexHit& hit = hits[vertex_of_ray[k]];
    hit.scene_hit = scene_hits[k];
    if (hit.scene_hit) hit.hit_point_mm = rays[k].origin_mm + hit.scene_hit.t_mm * rays[k].direction;
  }
  return hits;
}

std::vector<VertexHit> trace_vertices(const Optic& optic, const glm::dvec3& eye_mm, const RayScene& scene) {
  return find_scene_hits(reflect_vertices(optic, eye_mm), scene);
}

std::vector<VertexHit> trace_vertices(const Optic& lens, const LensTracer& tracer, LensSide entered,
                                      double wavelength_nm, const glm::dvec3& eye_mm, const RayScene& scene) {
  return find_scene_hits(refract_vertices(lens, tracer, entered, wavelength_nm, eye_mm), scene);
}

}  // namespace catoptra::optics
