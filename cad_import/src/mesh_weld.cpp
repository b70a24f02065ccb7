// Turns loose triangles into an indexed mesh: bad ones out, missing normals in, equal corners shared.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <unordered_map>

#include "cad_import/src/mesh_parts.h"

namespace catoptra::cad_import {
namespace {

/// Edges that bend more than this stay sharp where a file has no normals.
constexpr double kCrease_rad = std::numbers::pi / 3;
/// Twice a triangle's area over its longest edge squared, below which it has no direction: float positions of
/// a 10 m object are known to 1e-7 of its size, so that 1e-10 never drops a triangle that can be seen.
constexpr double kCollinear = 1e-10;
/// Beyond this many triangles at one point they all share one normal: comparing each with each would take for
/// ever.
constexpr std::size_t kMostAtPoint = 512;

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::uint64_t mix(std::uint64_t hash, float value) {
  // -0 and +0 are the same place.
  const std::uint64_t bits = std::bit_cast<std::uint32_t>(value == 0 ? 0.0f : value);
  hash ^= bits + 0x9E3779B97F4A7C15ull + (hash << 6) + (hash >> 2);
  return hash * 0xFF51AFD7ED558CCDull;
}

struct PositionHash {
  std::size_t operator()(const glm::vec3& p) const { return mix(mix(mix(17, p.x), p.y), p.z); }
};

struct CornerHash {
  std::size_t operator()(const MeshCorner& c) const {
    std::uint64_t hash = PositionHash()(c.position);
    hash = mix(mix(mix(hash, c.normal.x), c.normal.y), c.normal.z);
    return mix(mix(hash, c.texture_coordinate.x), c.texture_coordinate.y);
  }
};

struct SameCorner {
  bool operator()(const MeshCorner& a, const MeshCorner& b) const {
    return a.position == b.position && a.normal == b.normal && a.texture_coordinate == b.texture_coordinate;
  }
};

/// Twice the area vector of triangle `t`.
glm::dvec3 area_vector(const TriangleSoup& soup, std::size_t t) {
  const glm::dvec3 a = soup.corners[3 * t].position, b = soup.corners[3 * t + 1].position,
                   c = soup.corners[3 * t + 2].position;
  return glm::cross(b - a, c - a);
}

enum class Fate { keep, not_finite, degenerate };

Fate fate_of(const TriangleSoup& soup, std::size_t t) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const MeshCorner& corner = soup.corners[3 * t + k];
    if (!is_finite(corner.position)) return Fate::not_finite;
    const glm::dvec3 edge =
        glm::dvec3(soup.corners[3 * t + (k + 1) % 3].position) - glm::dvec3(corner.position);
    longest = std::max(longest, glm::dot(edge, edge));
  }
  return glm::length(area_vector(soup, t)) > kCollinear * longest ? Fate::keep : Fate::degenerate;
}

/// Moves the usable triangles to the front and cuts off the rest.
void drop_bad_triangles(TriangleSoup& soup, std::vector<std::string>& warnings) {
  std::size_t kept = 0, not_finite = 0, degenerate = 0;
  for (std::size_t t = 0; t < soup.material.size(); ++t) {
    const Fate fate = fate_of(soup, t);
    not_finite += fate == Fate::not_finite;
    degenerate += fate == Fate::degenerate;
    if (fate != Fate::keep) continue;
    for (std::size_t k = 0; k < 3; ++k) soup.corners[3 * kept + k] = soup.corners[3 * t + k];
    soup.material[kept++] = soup.material[t];
  }
  soup.corners.resize(3 * kept);
  soup.material.resize(kept);
  if (not_finite > 0)
    warnings.push_back(std::to_string(not_finite) +
                       " triangle(s) with infinite or undefined corners were left out");
  if (degenerate > 0)
    warnings.push_back(std::to_string(degenerate) + " triangle(s) without area were left out");
}

/// Unit normal of a triangle with its weight at one corner: the angle there, so that the result does not
/// depend on how a flat polygon was cut. Source: Thuermer and Wuethrich 1998, Computing vertex normals from
/// polygonal facets.
struct WeightedNormal {
  glm::dvec3 normal{0};
  double angle_rad = 0;
};

WeightedNormal weighted_normal(const TriangleSoup& soup, std::size_t corner) {
  const std::size_t t = corner / 3, k = corner % 3;
  const glm::dvec3 here = soup.corners[corner].position;
  const glm::dvec3 next = glm::dvec3(soup.corners[3 * t + (k + 1) % 3].position) - here;
  const glm::dvec3 last = glm::dvec3(soup.corners[3 * t + (k + 2) % 3].position) - here;
  const double angle = std::atan2(glm::length(glm::cross(next, last)), glm::dot(next, last));
  return {glm::normalize(area_vector(soup, t)), angle};
}

/// Gives normals to the corners `missing`, which all lie at one point.
void smooth_at_point(TriangleSoup& soup, const std::vector<std::uint32_t>& missing) {
  std::vector<WeightedNormal> around;
  around.reserve(missing.size());
  for (const std::uint32_t corner : missing) around.push_back(weighted_normal(soup, corner));
  const bool all_smooth = missing.size() > kMostAtPoint;
  const double least_cosine = all_smooth ? -2 : std::cos(kCrease_rad);
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    if (i == 0 || !all_smooth) {
      sum = glm::dvec3(0);
      for (const WeightedNormal& other : around)
        if (glm::dot(around[i].normal, other.normal) >= least_cosine) sum += other.angle_rad * other.normal;
    }
    const double length = glm::length(sum);
    soup.corners[missing[i]].normal = length > 1e-12 ? sum / length : around[i].normal;
  }
}

void make_missing_normals(TriangleSoup& soup) {
  std::unordered_map<glm::vec3, std::vector<std::uint32_t>, PositionHash> missing;
  for (std::size_t c = 0; c < soup.corners.size(); ++c) {
    glm::vec3& normal = soup.corners[c].normal;
    const float length = glm::length(normal);
    if (std::isfinite(length) && length > 1e-6f)
      normal /= length;
    else
      missing[soup.corners[c].position].push_back(static_cast<std::uint32_t>(c));
  }
  for (const auto& [position, corners] : missing) smooth_at_point(soup, corners);
}

}  // namespace

void weld(TriangleSoup soup, TriangleMesh& mesh) {
  drop_bad_triangles(soup, mesh.warnings);
  make_missing_normals(soup);

  std::unordered_map<MeshCorner, std::uint32_t, CornerHash, SameCorner> vertices;
  vertices.reserve(soup.corners.size() / 2);
  const auto vertex_of = [&](MeshCorner corner) {
    const glm::vec2& st = corner.texture_coordinate;
    if (!std::isfinite(st.x) || !std::isfinite(st.y)) corner.texture_coordinate = {0, 0};
    const auto [found, is_new] = vertices.emplace(corner, static_cast<std::uint32_t>(mesh.positions.size()));
    if (is_new) {
      mesh.positions.push_back(corner.position);
      mesh.normals.push_back(corner.normal);
      mesh.texture_coordinates.push_back(corner.texture_coordinate);
      mesh.bounds.min = glm::min(mesh.bounds.min, glm::dvec3(corner.position));
      mesh.bounds.max = glm::max(mesh.bounds.max, glm::dvec3(corner.position));
    }
    return found->second;
  };
  mesh.triangles.reserve(soup.material.size());
  for (std::size_t t = 0; t < soup.material.size(); ++t) {
    const std::uint32_t a = vertex_of(soup.corners[3 * t]);
    const std::uint32_t b = vertex_of(soup.corners[3 * t + 1]);
    mesh.triangles.emplace_back(a, b, vertex_of(soup.corners[3 * t + 2]));
  }
  mesh.triangle_material = std::move(soup.material);
}

}  // namespace catoptra::cad_import
