#include "tessellate/src/deviation.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::tessellate {

double chord_share(const cad_import::ExactSurface& surface, const glm::dvec2& uv, const glm::dvec3& flat,
                   const StepLimits& limits) {
  const auto s = surface.d1(uv.x, uv.y);
  const glm::dvec3 normal = glm::cross(s.du, s.dv);
  const double length = glm::length(normal);
  const glm::dvec3 offset = s.point - flat;
  // Only the distance from the surface counts, not where along it the parameters' middle lies.
  const double distance = length > 0 ? std::abs(glm::dot(offset, normal)) / length : glm::length(offset);
  return distance / limits.chord_mm;
}

double worst_chord_share(std::span<const DraftTriangle> triangles, std::span<const DraftVertex> vertices,
                         const cad_import::ExactSurface& surface, const StepLimits& limits) {
  if (limits.chord_mm == kUnlimited) return 0;
  double worst = 0;
  for (const auto& t : triangles) {
    std::array<glm::dvec3, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = vertices[static_cast<std::size_t>(t.vertices[k])].position_mm;
    worst = std::max(
        worst, chord_share(surface, (t.uv[0] + t.uv[1] + t.uv[2]) / 3.0, (p[0] + p[1] + p[2]) / 3.0, limits));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      // Inner edges come twice, once in each direction: once is enough. Border edges are cut along their own
      // curve.
      if (t.vertices[k] > t.vertices[next]) continue;
      worst =
          std::max(worst, chord_share(surface, 0.5 * (t.uv[k] + t.uv[next]), 0.5 * (p[k] + p[next]), limits));
    }
  }
  return worst;
}

}  // namespace catoptra::tessellate
