#include "render/src/shadow_overlaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

namespace catoptra::render {
namespace {

// Cells with so few triangles are not looked at more closely, nor are those halved so often.
constexpr std::size_t kFew = 64;
constexpr int kDeepest = 12;

/// Corners as the light sees them: (x, y, w), at x / w and y / w in the plane at w = 1 (behind it for w < 0).
using Seen = std::array<glm::vec3, 3>;

struct Cell {
  float x0, x1, y0, y1;
};

/// Whether the triangle lies wholly beyond one side of the cell. Wrong only in favour of touching it.
bool misses(const Seen& t, const Cell& cell) {
  const auto all = [&](const auto& beyond) { return beyond(t[0]) && beyond(t[1]) && beyond(t[2]); };
  return all([&](const glm::vec3& p) { return p.x < cell.x0 * p.z; }) ||
         all([&](const glm::vec3& p) { return p.x > cell.x1 * p.z; }) ||
         all([&](const glm::vec3& p) { return p.y < cell.y0 * p.z; }) ||
         all([&](const glm::vec3& p) { return p.y > cell.y1 * p.z; }) ||
         all([&](const glm::vec3& p) { return p.z <= 0; });
}

std::size_t most_in(const std::vector<Seen>& triangles, const std::vector<std::uint32_t>& list,
                    const Cell& cell, int depth) {
  if (list.size() <= kFew || depth == kDeepest) return list.size();
  const float x = 0.5f * (cell.x0 + cell.x1), y = 0.5f * (cell.y0 + cell.y1);
  const std::array<Cell, 4> quarters{{{cell.x0, x, cell.y0, y},
                                      {x, cell.x1, cell.y0, y},
                                      {cell.x0, x, y, cell.y1},
                                      {x, cell.x1, y, cell.y1}}};
  std::array<std::vector<std::uint32_t>, 4> inside;
  std::size_t all = 0;
  for (std::size_t q = 0; q < 4; ++q) {
    for (const std::uint32_t i : list)
      if (!misses(triangles[i], quarters[q])) inside[q].push_back(i);
    all += inside[q].size();
  }
  // Triangles as large as the cell lie one behind the other however closely one looks.
  if (all >= 2 * list.size()) return list.size();
  std::size_t most = 0;
  for (std::size_t q = 0; q < 4; ++q)
    most = std::max(most, most_in(triangles, inside[q], quarters[q], depth + 1));
  return most;
}

std::size_t most_in_cell(const std::vector<Seen>& triangles, const Cell& cell) {
  std::vector<std::uint32_t> list;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (!misses(triangles[i], cell)) list.push_back(std::uint32_t(i));
  return most_in(triangles, list, cell, 0);
}

template <typename Look>
std::vector<Seen> seen_by(const ShadowCasters& casters, std::span<const std::uint32_t> list,
                          const Look& look) {
  std::vector<Seen> seen;
  seen.reserve(list.size());
  for (const std::uint32_t i : list) {
    const auto& corners = casters.triangles[i].corners;
    seen.push_back({look(glm::dvec3(casters.positions[corners[0]])),
                    look(glm::dvec3(casters.positions[corners[1]])),
                    look(glm::dvec3(casters.positions[corners[2]]))});
  }
  return seen;
}

std::size_t along_direction(const ShadowCasters& casters, std::span<const std::uint32_t> list,
                            const glm::dvec3& direction) {
  const glm::dvec3 other =
      std::abs(direction.z) < 0.7 * glm::length(direction) ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(direction, other)),
                   up = glm::normalize(glm::cross(right, direction));
  const auto seen = seen_by(
      casters, list, [&](const glm::dvec3& p) { return glm::vec3(glm::dot(p, right), glm::dot(p, up), 1); });
  Cell cell{seen[0][0].x, seen[0][0].x, seen[0][0].y, seen[0][0].y};
  for (const Seen& t : seen)
    for (const glm::vec3& p : t)
      cell = {std::min(cell.x0, p.x), std::max(cell.x1, p.x), std::min(cell.y0, p.y), std::max(cell.y1, p.y)};
  return most_in_cell(seen, cell);
}

}  // namespace

std::size_t most_overlaps(const ShadowCasters& casters, std::span<const std::uint32_t> list,
                          const glm::dvec4& light) {
  if (list.size() <= kFew) return list.size();
  if (light.w == 0) return along_direction(casters, list, glm::dvec3(light));
  // Six pyramids about the point.
  std::size_t most = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sense : {1.0, -1.0}) {
      const auto seen = seen_by(casters, list, [&](const glm::dvec3& p) {
        const glm::dvec3 from = p - glm::dvec3(light);
        return glm::vec3(from[(axis + 1) % 3], from[(axis + 2) % 3], sense * from[axis]);
      });
      most = std::max(most, most_in_cell(seen, {-1, 1, -1, 1}));
    }
  return most;
}

}  // namespace catoptra::render
