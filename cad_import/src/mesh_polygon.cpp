// Cuts polygons into triangles. assimp's own step aborts the process on some damaged polygons.
#include <glm/geometric.hpp>
#include <numeric>

#include "cad_import/src/mesh_parts.h"

namespace catoptra::cad_import {
namespace {

/// Above this many corners a fan is used: ear clipping takes corners^2 at least.
constexpr std::size_t kMostClipped = 2000;

/// Normal of the plane that fits best, unnormalised. Source: Newell's method, in Sutherland et al. 1974,
/// appendix.
glm::dvec3 newell_normal(std::span<const glm::dvec3> polygon) {
  glm::dvec3 normal(0);
  for (std::size_t i = 0; i < polygon.size(); ++i)
    normal += glm::cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
  return normal;
}

/// Positive where a, b, c turn to the left about `normal`.
double turn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& normal) {
  return glm::dot(glm::cross(b - a, c - a), normal);
}

/// The corner at `k` of the remaining ring is convex and no other corner lies in its triangle.
bool is_ear(std::span<const glm::dvec3> polygon, const std::vector<unsigned>& ring, std::size_t k,
            const glm::dvec3& normal) {
  const std::size_t n = ring.size();
  const glm::dvec3 &a = polygon[ring[(k + n - 1) % n]], &b = polygon[ring[k]],
                   &c = polygon[ring[(k + 1) % n]];
  if (!(turn(a, b, c, normal) > 0)) return false;
  for (std::size_t i = 2; i + 1 < n; ++i) {
    const glm::dvec3& p = polygon[ring[(k + i) % n]];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p, normal) >= 0 && turn(b, c, p, normal) >= 0 && turn(c, a, p, normal) >= 0) return false;
  }
  return true;
}

}  // namespace

// Source: Meisters 1975, Polygons have ears.
std::vector<glm::uvec3> cut_polygon(std::span<const glm::dvec3> polygon) {
  std::vector<glm::uvec3> triangles;
  std::vector<unsigned> ring(polygon.size());
  std::iota(ring.begin(), ring.end(), 0u);
  const glm::dvec3 normal = newell_normal(polygon);
  while (ring.size() > 3 && polygon.size() <= kMostClipped) {
    std::size_t ear = 0;
    while (ear < ring.size() && !is_ear(polygon, ring, ear, normal)) ++ear;
    if (ear == ring.size()) break;  // crosses itself or has no area: a fan will do
    const std::size_t n = ring.size();
    triangles.emplace_back(ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) triangles.emplace_back(ring[0], ring[i], ring[i + 1]);
  return triangles;
}

}  // namespace catoptra::cad_import
