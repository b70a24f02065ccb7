// What the comparison says of paths over several optics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/comparison.h"
#include "tests/render/ray_chain_scenes.h"

namespace catoptra {
namespace {

using namespace test;

constexpr int kWidth = 160, kHeight = 120;

/// A sphere mirror seen in a plane one, and what it shows of a wall.
render::Scene two_mirrors(int depth) {
  render::Scene scene = dark_scene(depth);
  scene.environment.ambient = 1;
  scene.optics.push_back(plane_mirror({0, 0, 0}, {0, 0, 1}, 600));
  scene.optics.push_back(facing(conic_mirror(500, 0, 400, 300, 25, 25), {-200, 0, 700}, {0.6, 0, -0.8}));
  scene.surroundings.push_back(empty_mesh());
  add_quad(scene.surroundings[0], {3000, -4000, -4000}, {0, 8000, 0}, {0, 0, 8000});
  scene.camera = {{250, 30, 600}, {20, 0, 0}, {0, 1, 0}, 0.6, {kWidth, kHeight}};
  return scene;
}

TEST(ChainComparison, PixelsOverOtherOpticsAreWrongAndCounted) {
  const TracedScene deep(two_mirrors(3)), shallow(two_mirrors(1));
  const render::Frame reference = deep.render(kWidth, kHeight), bodies = shallow.render(kWidth, kHeight);
  const auto chains =
      std::size_t(std::ranges::count_if(reference.bounces, [](std::uint8_t bounces) { return bounces > 1; }));
  ASSERT_GT(chains, 1000u);
  const render::OpticError same = render::compare(reference, reference, deep.scene).optics[0];
  EXPECT_EQ(same.other_path_pixels, 0u);
  EXPECT_LT(same.arcmin.max, 0.05) << "floats";
  const render::OpticError other = render::compare(reference, bodies, deep.scene).optics[0];
  EXPECT_EQ(other.other_path_pixels, chains);
  EXPECT_EQ(other.pixels + chains, same.pixels);
  EXPECT_LT(other.arcmin.max, 0.05);
  // A picture of a mode that does not number its paths has one optic along each.
  render::Frame plain = bodies;
  plain.path.clear();
  plain.bounces.clear();
  EXPECT_EQ(render::compare(reference, plain, deep.scene).optics[0].other_path_pixels, chains);
  const auto map = render::error_map_arcmin(reference, plain);
  EXPECT_EQ(std::size_t(std::ranges::count(map, render::kOtherPath_arcmin)), chains);
}

// A picture that shows everywhere what the exact one shows two pixels to the right and one down is 2.24 px
// off, behind two mirrors as well.
TEST(ChainComparison, ScreenErrorIsTheShift) {
  const TracedScene traced(two_mirrors(2));
  const render::Frame reference = traced.render(kWidth, kHeight);
  render::Frame shifted = reference;
  for (auto& id : shifted.optic_id) id = -1;
  for (int row = 0; row + 1 < kHeight; ++row)
    for (int column = 0; column + 2 < kWidth; ++column) {
      const auto i = std::size_t(row * kWidth + column), from = i + kWidth + 2;
      if (reference.bounces[i] != 2 || reference.path[from] != reference.path[i]) continue;
      shifted.position[i] = reference.position[from];
      shifted.optic_id[i] = reference.optic_id[i];
    }
  const render::OpticError error = render::compare(reference, shifted, traced.scene).optics[0];
  EXPECT_GT(error.pixels, 1000u);
  // The derivative is taken at one end of the shift and changes by some 0.5 % a pixel.
  EXPECT_NEAR(error.screen_px.median, std::sqrt(5.0), 0.05);
  EXPECT_NEAR(error.screen_px.p99, std::sqrt(5.0), 0.3);
}

// What is shown is moved by a known angle about the last surface point.
TEST(ChainComparison, AngleIsMeasuredAtTheLastSurfacePoint) {
  const TracedScene traced(two_mirrors(2));
  const render::Frame reference = traced.render(kWidth, kHeight);
  render::Frame turned = reference;
  for (std::size_t i = 0; i < turned.color.size(); ++i) {
    if (reference.bounces[i] != 2) {
      turned.optic_id[i] = -1;
      continue;
    }
    const glm::dvec3 surface(reference.surface[i]), way = glm::dvec3(reference.position[i]) - surface,
                                                    d(reference.direction[i]),
                                                    e = glm::normalize(glm::cross(d, glm::dvec3(0, 1, 0)));
    const double length = reference.position[i].w == 0 ? 1 : glm::length(way);
    const glm::dvec3 seen = std::cos(0.002) * d + std::sin(0.002) * e;
    turned.position[i] = glm::vec4(glm::vec3(reference.position[i].w == 0 ? seen : surface + length * seen),
                                   reference.position[i].w);
  }
  const render::ErrorQuantiles q = render::compare(reference, turned, traced.scene).optics[0].arcmin;
  const double wanted = 0.002 * 60 * 180 / std::acos(-1.0);
  EXPECT_NEAR(q.median, wanted, 0.02);
  EXPECT_NEAR(q.max, wanted, 0.05) << "arcmin: what floats hold of points at 3 m";
}

}  // namespace
}  // namespace catoptra
