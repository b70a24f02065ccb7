// Which texels of a map an optic cannot show: counted one by one.
#include "render/src/map_coverage.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace catoptra::render {
namespace {

constexpr glm::ivec2 kTexels{320, 160};

/// A triangle of a map with its corners at (s, t), by homogeneous coordinates of unlike weights.
struct OneTriangle {
  tessellate::OpticArrays mesh;
  std::vector<glm::dvec3> coordinates;

  OneTriangle(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    mesh.vertices.resize(3);
    mesh.triangles.emplace_back();
    mesh.triangles[0].vertices = {0, 1, 2};
    coordinates = {{a, 1}, 2.0 * glm::dvec3(b, 1), 0.5 * glm::dvec3(c, 1)};
  }
  [[nodiscard]] std::vector<TexelRect> unseen(const AtlasPlace& place) const {
    return unseen_parts(mesh, coordinates, {}, 0, place);
  }
};

int rects_with(const std::vector<TexelRect>& rects, int x, int y) {
  return int(std::count_if(rects.begin(), rects.end(), [&](const TexelRect& r) {
    return x >= r.corner.x && y >= r.corner.y && x < r.corner.x + r.size.x && y < r.corner.y + r.size.y;
  }));
}

TEST(MapCoverage, LeavesWhatTheTriangleComesNearAndClosesWhatIsFar) {
  // Texels 80 to 144 across, 40 to 80 down: coordinates go up, rows down.
  const OneTriangle one({0.25, 0.75}, {0.45, 0.75}, {0.25, 0.5});
  for (const AtlasPlace& place : {AtlasPlace{{0, 0}, kTexels, 0}, AtlasPlace{{64, 32}, kTexels, 2}}) {
    const auto rects = one.unseen(place);
    for (int y = 0; y < kTexels.y; ++y)
      for (int x = 0; x < kTexels.x; ++x) {
        const int dx = std::max({80 - x, x - 144, 0}), dy = std::max({40 - y, y - 80, 0});
        const int covered =
            rects_with(rects, place.corner.x + place.guard + x, place.corner.y + place.guard + y);
        const int away = std::max(dx, dy);
        ASSERT_LE(covered, away < 16 ? 0 : 1) << x << ' ' << y;
        ASSERT_GE(covered, away > 48 ? 1 : 0) << x << ' ' << y;
      }
    const glm::ivec2 end = place.corner + place.texels + 2 * place.guard;
    for (const TexelRect& r : rects) {
      EXPECT_GE(r.corner.x, place.corner.x);
      EXPECT_LE(r.corner.x + r.size.x, end.x);
      EXPECT_LE(r.corner.y + r.size.y, end.y);
    }
  }
}

TEST(MapCoverage, OtherPatchesDoNotCount) {
  const OneTriangle one({0, 0}, {1, 0}, {0, 1});
  const std::vector<std::uint32_t> patch(3, 1);
  EXPECT_TRUE(unseen_parts(one.mesh, one.coordinates, patch, 1, {{0, 0}, kTexels, 0}).empty());
  EXPECT_EQ(rects_with(unseen_parts(one.mesh, one.coordinates, patch, 0, {{0, 0}, kTexels, 0}), 9, 9), 1);
}

TEST(MapCoverage, ClosesNothingWhereAVertexHasNoPlace) {
  OneTriangle one({0.25, 0.75}, {0.45, 0.75}, {0.25, 0.5});
  one.coordinates[1].z = -1;
  EXPECT_TRUE(one.unseen({{0, 0}, kTexels, 0}).empty());
}

}  // namespace
}  // namespace catoptra::render
