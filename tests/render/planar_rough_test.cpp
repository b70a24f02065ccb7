// Rough planar optics in mode pvrr: tilted sample by sample as the ray tracer tilts them.
#include <gtest/gtest.h>

#include "render/comparison.h"
#include "tests/render/planar_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;
using optics::OpticKind;

constexpr double kDegree = 3.14159265358979 / 180;

/// A rough mirror and posts before it: the farther off they stand, the more they blur.
Scene posts_before_a_mirror(OpticKind kind = OpticKind::mirror, bool from_behind = false) {
  Scene scene = room();
  for (int k = 0; k < 5; ++k) {
    const float x = -320 + 170 * float(k), z = 60 + 150 * float(k);
    add_box(scene.surroundings[0], {x, -900, z}, {x + 30, 200, z + 30}, k % 2 ? kYellow : kMagenta);
  }
  scene.optics.push_back(planar_optic(kind, {0, 0, 0}, {0.1, 0, from_behind ? -1.0 : 1.0}, 700, 300));
  scene.optics[0].material.roughness_rad = {2 * kDegree, 0.7 * kDegree};
  scene.optics[0].material.first_edge = {1, 0, 0};
  scene.camera = {{-150, 120, 900}, {20, 0, 0}, {0, 1, 0}, 0.7, {320, 240}};
  return scene;
}

double psnr_db(const Scene& scene, const Scene& reference) {
  const Frame exact =
      Renderer(reference).render(Mode::raytrace, scene.camera, picture_of(scene, 16, false)).frame;
  return image_error(exact,
                     Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene, 16, false)).frame)
      .psnr_db;
}

// Each sample's map lies on the picture's own grid, as that of a smooth mirror (PvrrPlane): the same promise
// as there. 47 dB and more are measured, 21 dB without tilts.
TEST(RoughPlanar, MirrorAgreesWithTheRayTracerOver16Samples) {
  for (const bool from_behind : {false, true}) {
    const Scene scene = posts_before_a_mirror(OpticKind::mirror, from_behind);
    Scene smooth = scene;
    smooth.optics[0].material.roughness_rad = {0, 0};
    EXPECT_GE(psnr_db(scene, scene), 45) << "from behind: " << from_behind;
    // The test can tell: without tilts the pictures are far apart.
    EXPECT_LT(psnr_db(smooth, scene), 30) << "from behind: " << from_behind;
  }
}

// What is reflected is tilted; what passes is not.
TEST(RoughPlanar, PaneAgreesWithTheRayTracer) {
  Scene scene = posts_before_a_mirror(OpticKind::pane);
  scene.optics[0].material.ior = 4;  // reflects half
  EXPECT_GE(psnr_db(scene, scene), 45);
}

TEST(RoughPlanar, MirrorsInMirrorsAreTiltedToo) {
  Scene scene = posts_before_a_mirror();
  scene.optics.push_back(planar_optic(OpticKind::mirror, {100, 60, 1200}, {-0.05, 0, -1}, 1200, 900));
  scene.optics[1].material.roughness_rad = {0.5 * kDegree, 1 * kDegree};
  scene.settings.depth = 2;
  EXPECT_GE(psnr_db(scene, scene), 45);
}

TEST(RoughPlanar, FirstSampleIsNotTilted) {
  const Scene scene = posts_before_a_mirror();
  Scene smooth = scene;
  smooth.optics[0].material.roughness_rad = {0, 0};
  Renderer of_rough(scene), of_smooth(smooth);
  const auto shown = [&](Renderer& renderer) {
    return renderer.render(Mode::pvrr, scene.camera, picture_of(scene, 1, false)).frame.color;
  };
  const auto first = shown(of_rough), expected = shown(of_smooth);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), expected.begin(), expected.end(),
                         [](const auto& a, const auto& b) { return a == b; }));
  // Nor is it after a picture of several samples, whose maps are kept.
  EXPECT_FALSE(of_rough.render(Mode::pvrr, scene.camera, picture_of(scene, 4, false)).frame.color ==
               expected);
  EXPECT_TRUE(shown(of_rough) == expected);
}

}  // namespace
}  // namespace catoptra::render
