#include "render/src/raster_chunks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

namespace catoptra::render {
namespace {

// Share of its distance by which a box counts as larger: a thousand times the rounding of a float.
constexpr double kRounding = 1e-4;

using Triangle = std::array<std::uint32_t, 3>;

struct Splitter {
  std::span<const glm::vec3> positions;
  std::size_t largest;
  std::vector<Triangle> triangles;
  std::vector<TriangleChunk> chunks;

  [[nodiscard]] glm::vec3 thrice_middle(const Triangle& t) const {
    return positions[t[0]] + positions[t[1]] + positions[t[2]];
  }

  void add(std::size_t begin, std::size_t end) {
    TriangleChunk chunk{3 * begin, 3 * (end - begin), {}};
    for (std::size_t i = begin; i < end; ++i)
      for (const std::uint32_t vertex : triangles[i]) {
        chunk.box.min = glm::min(chunk.box.min, glm::dvec3(positions[vertex]));
        chunk.box.max = glm::max(chunk.box.max, glm::dvec3(positions[vertex]));
      }
    chunks.push_back(chunk);
  }

  void split(std::size_t begin, std::size_t end) {
    if (end - begin <= largest) {
      if (end > begin) add(begin, end);
      return;
    }
    glm::vec3 low = thrice_middle(triangles[begin]), high = low;
    for (std::size_t i = begin; i < end; ++i) {
      low = glm::min(low, thrice_middle(triangles[i]));
      high = glm::max(high, thrice_middle(triangles[i]));
    }
    const glm::vec3 side = high - low;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    // Stable, so that every implementation of the library gives the same order.
    const auto at = [&](std::size_t i) { return triangles.begin() + static_cast<std::ptrdiff_t>(i); };
    std::stable_sort(at(begin), at(end), [&](const Triangle& a, const Triangle& b) {
      return thrice_middle(a)[axis] < thrice_middle(b)[axis];
    });
    const std::size_t middle = begin + (end - begin) / 2;
    split(begin, middle);
    split(middle, end);
  }
};

}  // namespace

std::vector<TriangleChunk> chunk_triangles(std::span<const glm::vec3> positions,
                                           std::span<std::uint32_t> indices, std::size_t largest) {
  Splitter splitter{positions, std::max<std::size_t>(1, largest), {}, {}};
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    splitter.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  splitter.split(0, splitter.triangles.size());
  for (std::size_t t = 0; t < splitter.triangles.size(); ++t)
    std::copy(splitter.triangles[t].begin(), splitter.triangles[t].end(),
              indices.begin() + std::ptrdiff_t(3 * t));
  return std::move(splitter.chunks);
}

BoxInView box_in_view(const RasterView& view, const cad_import::BoundingBox& box) {
  const glm::dvec3 middle = 0.5 * (box.min + box.max) - view.origin_mm, half = 0.5 * (box.max - box.min);
  const double room = kRounding * (glm::length(middle) + glm::length(half));
  // A linear function over the box is largest at the corner to which its gradient points.
  const auto most = [&](const glm::dvec4& row) {
    const glm::dvec3 gradient(row);
    return glm::dot(gradient, middle) + row.w + glm::dot(glm::abs(gradient), half) +
           room * glm::length(gradient);
  };
  const glm::dmat4 rows = glm::transpose(view.clip_from_relative());
  BoxInView seen;
  seen.seen = most(rows[3] + rows[0]) >= 0 && most(rows[3] - rows[0]) >= 0 && most(rows[3] + rows[1]) >= 0 &&
              most(rows[3] - rows[1]) >= 0 && most(rows[3] - rows[2]) >= 0 && most(rows[2]) >= 0;
  const glm::dvec3 back = glm::transpose(view.rotation)[2];
  seen.nearest_mm = -most(glm::dvec4(back, 0));
  return seen;
}

}  // namespace catoptra::render
