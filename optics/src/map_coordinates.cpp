#include "optics/map_coordinates.h"

#include <glm/vec2.hpp>
#include <string>

#include "cad_import/error.h"
#include "optics/src/map_denominators.h"

namespace catoptra::optics {
namespace {

std::vector<double> denominators(const MapProblem& problem, MapInterpolation interpolation) {
  switch (interpolation) {
    case MapInterpolation::fitted:
      return fitted_denominators(problem);
    case MapInterpolation::homography:
      return homography_denominators(problem);
    case MapInterpolation::affine:
      break;
  }
  return std::vector<double>(problem.facing.size(), 1.0);
}

std::vector<glm::dvec3> coordinates_of_mesh(const Optic& optic, const tessellate::OpticArrays& mesh,
                                            std::span<const VertexHit> hits, const VirtualView& view,
                                            MapInterpolation interpolation) {
  if (hits.size() != mesh.vertices.size())
    throw Error("", optic.name,
                std::to_string(hits.size()) + " traced rays for " + std::to_string(mesh.vertices.size()) +
                    " vertices");
  std::vector<glm::dvec3> coordinates(hits.size(), glm::dvec3(0.5, 0.5, 1));
  std::vector<std::size_t> facing;
  for (std::size_t i = 0; i < hits.size(); ++i)
    if (hits[i].faces_eye) facing.push_back(i);
  if (facing.empty()) return coordinates;

  const auto q = denominators({mesh, hits, view, facing}, interpolation);
  double mean = 0;
  for (const double value : q) mean += value / static_cast<double>(q.size());
  for (std::size_t k = 0; k < facing.size(); ++k) {
    const glm::dvec3 h = shown_at_vertex(hits[facing[k]], view);
    coordinates[facing[k]] = glm::dvec3(h.x / h.z, h.y / h.z, 1) * (q[k] / mean);
  }
  return coordinates;
}

}  // namespace

std::vector<glm::dvec3> map_coordinates(const Optic& optic, std::span<const VertexHit> hits,
                                        const VirtualView& view, MapInterpolation interpolation) {
  return coordinates_of_mesh(optic, optic.mesh, hits, view, interpolation);
}

std::vector<glm::dvec3> map_coordinates(const Optic& lens, LensSide entered, std::span<const VertexHit> hits,
                                        const VirtualView& view, MapInterpolation interpolation) {
  return coordinates_of_mesh(lens, *side_of(lens, entered).mesh, hits, view, interpolation);
}

std::vector<glm::dvec3> map_coordinates(const Optic& optic, const tessellate::OpticArrays& mesh,
                                        std::span<const VertexHit> hits, const VirtualView& view,
                                        MapInterpolation interpolation) {
  return coordinates_of_mesh(optic, mesh, hits, view, interpolation);
}

std::vector<glm::dvec3> map_coordinates_like(std::span<const glm::dvec3> reference,
                                             std::span<const VertexHit> hits, const VirtualView& view) {
  if (hits.size() != reference.size())
    throw Error("", "map coordinates",
                std::to_string(hits.size()) + " traced rays for " + std::to_string(reference.size()) +
                    " reference coordinates");
  std::vector<glm::dvec3> coordinates(reference.begin(), reference.end());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i].faces_eye) continue;
    const glm::dvec3 h = shown_at_vertex(hits[i], view);
    coordinates[i] = glm::dvec3(h.x / h.z, h.y / h.z, 1) * reference[i].z;
  }
  return coordinates;
}

}  // namespace catoptra::optics
