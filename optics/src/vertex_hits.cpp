#include "optics/vertex_hits.h"

#include <glm/geometric.hpp>

#include "cad_import/error.h"
#include "optics/reflection.h"

namespace catoptra::optics {

std::vector<VertexHit> trace_vertices(const Optic& optic, const glm::dvec3& eye_mm, const RayScene& scene) {
  if (optic.kind != OpticKind::mirror)
    throw Error("", optic.name, "is a lens, and only mirrors can be traced");
  std::vector<VertexHit> hits(optic.mesh.vertices.size());
  std::vector<Ray> rays;
  std::vector<std::size_t> vertex_of_ray;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const tessellate::OpticVertex& vertex = optic.mesh.vertices[i];
    const glm::dvec3 towards = vertex.position_mm - eye_mm;
    const double distance = glm::length(towards);
    hits[i].surface_point_mm = vertex.position_mm;
    hits[i].faces_eye = glm::dot(towards, reflecting_normal(optic, vertex.normal)) < 0;
    if (!hits[i].faces_eye) continue;
    hits[i].direction = reflect(towards / distance, vertex.normal);
    rays.push_back({vertex.position_mm, hits[i].direction, kSelfHitDistance_mm});
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

}  // namespace catoptra::optics
