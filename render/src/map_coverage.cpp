#include "render/src/map_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

namespace catoptra::render {
namespace {

constexpr int kTile = 16;

/// Square tiles over a map.
struct Tiles {
  glm::ivec2 count;
  std::vector<std::uint8_t> seen;

  explicit Tiles(glm::ivec2 texels)
      : count((texels + kTile - 1) / kTile), seen(std::size_t(count.x) * std::size_t(count.y), 0) {}

  [[nodiscard]] bool is_seen(int x, int y) const {
    return seen[std::size_t(y) * std::size_t(count.x) + std::size_t(x)] != 0;
  }

  /// Those that a box of texels overlaps, and those beside them.
  void see(glm::dvec2 low, glm::dvec2 high) {
    const auto tile = [](double texel, int limit) {
      return int(std::clamp(std::floor(texel / kTile), 0.0, double(limit - 1)));
    };
    const int left = std::max(0, tile(low.x, count.x) - 1), top = std::max(0, tile(low.y, count.y) - 1),
              right = std::min(count.x - 1, tile(high.x, count.x) + 1),
              bottom = std::min(count.y - 1, tile(high.y, count.y) + 1);
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x) seen[std::size_t(y) * std::size_t(count.x) + std::size_t(x)] = 1;
  }
};

/// The tiles that are not seen, in rectangles as wide as a row has them side by side and as high as rows are
/// alike; clipped to the map.
std::vector<TexelRect> unseen_rects(const Tiles& tiles, glm::ivec2 texels) {
  std::vector<TexelRect> rects;
  std::vector<std::size_t> open;  // those that reach down to the last row
  for (int y = 0; y < tiles.count.y; ++y) {
    std::vector<std::size_t> now;
    const int top = y * kTile, bottom = std::min(texels.y, top + kTile);
    for (int x = 0; x < tiles.count.x;) {
      int end = x;
      while (end < tiles.count.x && !tiles.is_seen(end, y)) ++end;
      if (end == x) {
        ++x;
        continue;
      }
      const int left = x * kTile, wide = std::min(texels.x, end * kTile) - left;
      const auto above = std::find_if(open.begin(), open.end(), [&](std::size_t i) {
        return rects[i].corner.x == left && rects[i].size.x == wide;
      });
      if (above != open.end()) {
        rects[*above].size.y = bottom - rects[*above].corner.y;
        now.push_back(*above);
      } else {
        now.push_back(rects.size());
        rects.push_back({{left, top}, {wide, bottom - top}});
      }
      x = end;
    }
    open = std::move(now);
  }
  return rects;
}

}  // namespace

std::vector<TexelRect> unseen_parts(const tessellate::OpticArrays& mesh,
                                    std::span<const glm::dvec3> coordinates,
                                    std::span<const std::uint32_t> patch, std::uint32_t wanted,
                                    const AtlasPlace& place) {
  const glm::ivec2 texels = place.texels + 2 * place.guard;
  Tiles tiles(texels);
  for (const auto& triangle : mesh.triangles) {
    if (!patch.empty() && patch[triangle.vertices[0]] != wanted) continue;
    std::array<glm::dvec2, 3> at;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3& c = coordinates[triangle.vertices[k]];
      // Coordinates go up, rows down.
      at[k] = glm::dvec2(c.x / c.z, 1 - c.y / c.z) * glm::dvec2(place.texels) + double(place.guard);
      if (!(c.z > 0) || !std::isfinite(at[k].x + at[k].y)) return {};
    }
    tiles.see(glm::min(at[0], glm::min(at[1], at[2])), glm::max(at[0], glm::max(at[1], at[2])));
  }
  std::vector<TexelRect> rects = unseen_rects(tiles, texels);
  for (TexelRect& rect : rects) rect.corner += place.corner;
  return rects;
}

}  // namespace catoptra::render
