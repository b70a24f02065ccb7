// Where one viewpoint does not do: line foci, and what stands where rays cross. Nothing there is wrong
// without notice, and mode exact shows it.
#include <gtest/gtest.h>

#include <algorithm>

#include "render/comparison.h"
#include "render/src/pixel_error.h"
#include "tests/render/zooming_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

struct Judged {
  OpticStats stats;
  std::vector<std::string> warnings;
  std::size_t outlines = 0;
  /// Pixels off by more than an arcminute that are off by more than half a pixel, with room for rounding.
  std::size_t wrong = 0;
};

Judged judged(const Scene& scene, Mode mode) {
  Renderer renderer(scene);
  const FrameOptions options = picture_of(scene);
  const Frame reference = renderer.render(Mode::raytrace, scene.camera, options).frame;
  RenderResult result = renderer.render(mode, scene.camera, options);
  Judged judged{result.stats.optics.at(0), result.warnings,
                compare(reference, result.frame, scene).optics.at(0).outline_pixels};
  for (std::size_t i = 0; i < reference.color.size(); ++i) {
    if (reference.optic_id[i] != 0 || result.frame.optic_id[i] != 0) continue;
    const auto direction = render::shown_direction(reference, result.frame, i);
    if (direction && kArcminPerRad * angle(*direction, glm::dvec3(reference.direction[i])) <= 1.001) continue;
    const auto px = direction ? screen_error(reference, result.frame, i, *direction) : std::nullopt;
    judged.wrong += !px || *px > 0.501 ? 1 : 0;
  }
  return judged;
}

bool warns(const Judged& judged, const std::string& text) {
  return std::ranges::any_of(judged.warnings,
                             [&](const std::string& w) { return w.find(text) != std::string::npos; });
}

void expect_exact(const Scene& scene) {
  const Judged exact = judged(scene, Mode::exact);
  EXPECT_EQ(exact.wrong, 0u);
  EXPECT_EQ(exact.outlines, 0u);
  EXPECT_GT(exact.stats.retraced_pixels, 0u);
  EXPECT_TRUE(exact.warnings.empty());
}

/// The room, with a post near the mirror and a ball-like box farther off, before a mirror of two curvatures.
Scene before_two_curvatures(double k1, double k2) {
  Scene scene = room();
  scene.camera.eye_mm = {150, 60, 700};
  scene.camera.fov_rad = 0.28;
  add_box(scene.surroundings[0], {-60, -300, 250}, {-45, 300, 265}, kYellow);
  add_box(scene.surroundings[0], {-250, -150, 900}, {-150, 0, 1000}, kMagenta);
  scene.optics.push_back(
      rectangular_mirror(std::make_shared<TwoCurvatureSurface>(k1, k2, 0.3, 85, 55), 170, 110, 25, 17));
  return scene;
}

struct Curvatures {
  const char* name;
  double k1, k2;  // 1/mm, positive: convex
};
void PrintTo(const Curvatures& c, std::ostream* out) {
  *out << c.name;
}

class LineFoci : public ::testing::TestWithParam<Curvatures> {};

// From 0.72 m. What vertices meet is right in mode pvrr too, what hides what between the foci is not.
TEST_P(LineFoci, AreReportedAndRightInModeExact) {
  const Scene scene = before_two_curvatures(GetParam().k1, GetParam().k2);
  const Judged pvrr = judged(scene, Mode::pvrr);
  EXPECT_TRUE(warns(pvrr, "crossed in one direction and not in the other"));
  EXPECT_GT(pvrr.wrong, 500u) << "the scene no longer has what the warning is for";
  expect_exact(scene);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, LineFoci,
                         ::testing::Values(Curvatures{"Saddle", 1 / 800.0, -1 / 800.0},
                                           Curvatures{"Cylinder", 0, -1 / 600.0},
                                           Curvatures{"SteepSaddle", 1 / 2000.0, -1 / 500.0},
                                           Curvatures{"TwoConcave", -1 / 400.0, -1 / 900.0}),
                         [](const auto& test) { return std::string(test.param.name); });

// R 2000 concave has its focus 1 m off: seen from 0.72 m both directions spread.
TEST(ZoomingLimits, NoWarningWhereNothingConverges) {
  EXPECT_TRUE(judged(before_two_curvatures(1 / 500.0, -1 / 2000.0), Mode::pvrr).warnings.empty());
}

// Seen askew from 1.24 m, a large mirror of R 600 has its rays cross some millimetres off one another, about
// 400 mm before it. A fence there is seen by parts of it, which no perspective from one point shows.
TEST(ZoomingLimits, WhatStandsWhereRaysCrossIsReportedAndRightInModeExact) {
  Scene scene = zooming_world(1240, 110);
  scene.camera.eye_mm = {0, -300, 1200};
  scene.optics.push_back(conic_mirror(-600, 0, 170, 110, 25, 17));
  for (int i = 0; i < 11; ++i)
    add_quad(scene.surroundings[0], {-10.5f + 2.0f * float(i), 60, 402}, {1, 0, 0}, {0, 80, 2}, kYellow);
  const Judged pvrr = judged(scene, Mode::pvrr);
  EXPECT_TRUE(warns(pvrr, "close to where their rays cross"));
  EXPECT_GT(pvrr.wrong, 500u);
  expect_exact(scene);
}

// It reaches through the crossing; its end and its sides show.
TEST(ZoomingLimits, ABarAcrossTheCrossingIsRightOnBothSides) {
  Scene scene = before_concave_mirror(1500);
  add_box(scene.surroundings[0], {-3, 5, 120}, {3, 9, 900}, kYellow);
  const Judged pvrr = judged(scene, Mode::pvrr);
  EXPECT_TRUE(pvrr.warnings.empty());
  // An outline's pixels are off by the parallax of one viewpoint: 0.5 % of what the optic shows.
  EXPECT_LT(pvrr.wrong, pvrr.stats.shown_pixels > 0 ? pvrr.stats.shown_pixels / 200 : 400u);
}

}  // namespace
}  // namespace catoptra::render
