// The modes against each other through lenses: what interpolation between vertices costs.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/render/lens_pvrr_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

Frame rendered(const Scene& scene, Mode mode) {
  return Renderer(scene).render(mode, scene.camera, picture_of(scene)).frame;
}

Scene lens_before_wall() {
  Scene scene = wall_behind_lens(70, 0.6, 3000);
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i)
      add_quad(scene.surroundings[0], {1200.f - 200.f * float(i), -1200.f + 200.f * float(j), 2999},
               {-190, 0, 0}, {0, 190, 0}, (i + j) % 2 ? kRed : kBlue);
  scene.optics.push_back(lens_of(400, 95.2, 2, 60, 25));
  return scene;
}

TEST(RayLensModes, VertexRaysShowWhatExactRaysShow) {
  const Scene scene = lens_before_wall();
  const Frame exact = rendered(scene, Mode::raytrace), pvrr = rendered(scene, Mode::pvrr);
  std::vector<double> errors;
  for (int row = 0; row + 1 < exact.height; ++row)
    for (int column = 0; column + 1 < exact.width; ++column) {
      const auto i = std::size_t(row * exact.width + column), below = i + std::size_t(exact.width);
      if (exact.optic_id[i] != 0 || pvrr.optic_id[i] != 0 || exact.optic_id[i + 1] != 0 ||
          exact.optic_id[below] != 0)
        continue;
      const auto at = [](const Frame& f, std::size_t k) { return glm::dvec2(f.position[k]); };
      const glm::dmat2 by_pixel{at(exact, i + 1) - at(exact, i), at(exact, below) - at(exact, i)};
      errors.push_back(glm::length(glm::inverse(by_pixel) * (at(pvrr, i) - at(exact, i))));
    }
  ASSERT_GT(errors.size(), 20000u);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 1.0);
  EXPECT_LT(errors[errors.size() * 99 / 100], 2.0);
}

TEST(RayLensModes, BrightnessAndColourAgree) {
  const Scene scene = lens_before_wall();
  const Frame exact = rendered(scene, Mode::raytrace), pvrr = rendered(scene, Mode::pvrr);
  std::size_t seen = 0, differ = 0;
  for (std::size_t i = 0; i < exact.color.size(); ++i) {
    if (exact.optic_id[i] != 0) continue;
    ++seen;
    differ += glm::length(exact.color[i] - pvrr.color[i]) > 0.02f ? 1 : 0;
  }
  // The panels' borders are two texels wide at most.
  EXPECT_LT(double(differ), 0.15 * double(seen));
}

TEST(RayLensModes, HybridTracesWhatTheReferenceDoes) {
  const Scene scene = lens_before_wall();
  const Frame exact = rendered(scene, Mode::raytrace), hybrid = rendered(scene, Mode::hybrid);
  for (std::size_t i = 0; i < exact.color.size(); ++i) {
    if (exact.optic_id[i] != 0) continue;
    ASSERT_EQ(hybrid.optic_id[i], 0);
    ASSERT_EQ(hybrid.color[i], exact.color[i]);
    ASSERT_EQ(hybrid.position[i], exact.position[i]);
  }
}

}  // namespace
}  // namespace catoptra::render
