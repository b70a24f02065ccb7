// Chunks of triangles: none is lost, and none that shows is left out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "render/src/raster_chunks.h"

namespace catoptra::render {
namespace {

TEST(TriangleChunks, HoldEveryTriangleOnceWithinTheirBoxes) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> place(-100, 100);
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < 3 * 1001; ++i) {
    positions.emplace_back(place(random), place(random), 0.1f * place(random));
    indices.push_back(i);
  }
  const auto chunks = chunk_triangles(positions, indices, 64);
  EXPECT_GE(chunks.size(), 16u);
  std::size_t next = 0;
  std::vector<std::uint32_t> firsts;
  for (const TriangleChunk& chunk : chunks) {
    EXPECT_EQ(chunk.first, next);
    EXPECT_LE(chunk.count, 3u * 64);
    next += chunk.count;
    for (std::size_t i = chunk.first; i < next; ++i) {
      const glm::dvec3 p(positions[indices[i]]);
      EXPECT_TRUE(glm::all(glm::lessThanEqual(chunk.box.min, p)) &&
                  glm::all(glm::lessThanEqual(p, chunk.box.max)));
      if (i % 3 == 0) firsts.push_back(indices[i]);
      EXPECT_EQ(indices[i], indices[i - i % 3] + i % 3) << "a triangle keeps its corners in their order";
    }
  }
  EXPECT_EQ(next, indices.size());
  std::sort(firsts.begin(), firsts.end());
  EXPECT_EQ(std::unique(firsts.begin(), firsts.end()), firsts.end());
  EXPECT_TRUE(chunk_triangles({}, {}, 64).empty());
}

TEST(BoxInView, SeesEveryBoxWithAVisiblePointAndKnowsItsDepth) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto some = [&](double size) { return size * glm::dvec3(unit(random), unit(random), unit(random)); };
  int seen = 0, unseen = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Camera camera{some(500), some(500), {0.1, 0.2, 1}, 0.5, {64, 48}};
    const RasterView view = camera_view(camera, camera.resolution);
    const glm::dvec3 middle = some(1000), half = glm::abs(some(100));
    const BoxInView box = box_in_view(view, {middle - half, middle + half});
    const glm::dvec3 ahead = glm::normalize(camera.target_mm - camera.eye_mm);
    bool shows = false;
    for (int k = 0; k < 20; ++k) {
      const glm::dvec3 point = middle + half * some(1);
      const glm::dvec3 pixel = view.pixel(point);
      if (!(pixel.z > kCameraNear && pixel.x > 0 && pixel.x < 64 && pixel.y > 0 && pixel.y < 48)) continue;
      shows = true;
      EXPECT_GE(glm::dot(point - camera.eye_mm, ahead), box.nearest_mm);
    }
    EXPECT_TRUE(box.seen || !shows);
    (box.seen ? seen : unseen)++;
  }
  EXPECT_GT(seen, 50);
  EXPECT_GT(unseen, 2000) << "most boxes are beside so narrow a view";
}

TEST(NearestTriangle, IsThatOfWhatTheViewSeesOfThem) {
  // A wall beside the view, from behind the eye to 1 m before it, and one from 2 m to 5 m that enters the
  // view at 4 m, where the view (45 degrees to each side) is 4 m wide.
  const RasterView view =
      camera_view({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 2 * std::atan(1.0), {64, 64}}, {64, 64});
  const std::vector<glm::vec3> positions{{4000, -1000, 0}, {4000, 1000, 0}, {4000, 1000, 500},
                                         {4000, 2000, 0},  {4000, 5000, 0}, {4000, 5000, 500}};
  const std::vector<std::uint32_t> beside{0, 1, 2}, entering{3, 4, 5}, both{0, 1, 2, 3, 4, 5};
  EXPECT_TRUE(std::isinf(nearest_triangle_mm(view, positions, beside)));
  EXPECT_NEAR(nearest_triangle_mm(view, positions, entering), 4000, 3);
  EXPECT_NEAR(nearest_triangle_mm(view, positions, both), 4000, 3);
  EXPECT_LT(nearest_triangle_mm(view, positions, both), 4000) << "rounding counts in favour of near";
}

}  // namespace
}  // namespace catoptra::render
