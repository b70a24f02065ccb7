#include "render/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "cad_import/error.h"
#include "tests/render/ray_scenes.h"

namespace catoptra {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr double kArcmin = std::numbers::pi / 180 / 60;

/// A mirror before a wall 3 m behind the eye; the wall ends, so that some rays show the sky.
test::TracedScene& traced(double radius_mm) {
  static std::map<double, std::unique_ptr<test::TracedScene>> scenes;
  auto& entry = scenes[radius_mm];
  if (!entry) {
    render::Scene scene;
    scene.surroundings.push_back(test::empty_mesh());
    test::add_quad(scene.surroundings[0], {-400, -2000, 3000}, {0, 4000, 0}, {5000, 0, 0});
    scene.environment.ambient = 1;
    scene.optics.push_back(test::conic_mirror(radius_mm, 0, 170, 110, 7, 7));
    scene.camera = {{100, 50, 700}, {0, 0, 0}, {0, 1, 0}, 0.2, {kWidth, kHeight}};
    entry = std::make_unique<test::TracedScene>(std::move(scene));
  }
  return *entry;
}

TEST(Comparison, TheReferenceAgainstItselfIsExact) {
  const auto& t = traced(1200);
  const render::Frame frame = t.render(kWidth, kHeight);
  const render::Comparison c = render::compare(frame, frame, t.scene);
  ASSERT_EQ(c.optics.size(), 1u);
  EXPECT_GT(c.optics[0].pixels, 1000u);
  EXPECT_EQ(c.optics[0].outline_pixels, 0u);
  EXPECT_LT(c.optics[0].arcmin.max, 0.01) << "positions in single precision";
  EXPECT_LT(c.optics[0].screen_px.max, 0.01);
  EXPECT_TRUE(std::isinf(c.image.psnr_db));
  EXPECT_EQ(c.image.flip_mean, 0);
}

// In concave glasses the rim stands some um before the outermost pixels' surface points: both pictures show
// the same place there, and what rounding of its coordinates makes of the direction is no error of either.
TEST(Comparison, WhatTouchesTheOpticInBothPicturesIsCountedApart) {
  const auto& t = traced(1200);
  render::Frame reference = t.render(kWidth, kHeight);
  render::Frame frame = reference;
  const std::size_t pixels = render::compare(reference, frame, t.scene).optics[0].pixels;
  std::size_t first = 0;
  while (reference.optic_id[first] < 0) ++first;
  const auto touch = [&](render::Frame& f, float turned) {
    f.position[first] = glm::vec4(reference.surface[first] + 2e-6f * reference.direction[first], 1);
    f.position[first].x += turned;
  };
  touch(frame, 1e-6f);
  EXPECT_EQ(render::compare(reference, frame, t.scene).optics[0].touching_pixels, 0u)
      << "in one picture only";
  EXPECT_GT(render::compare(reference, frame, t.scene).optics[0].arcmin.max, 1000);
  touch(reference, 0);
  const render::OpticError error = render::compare(reference, frame, t.scene).optics[0];
  EXPECT_EQ(error.touching_pixels, 1u);
  EXPECT_EQ(error.pixels + error.touching_pixels, pixels);
  EXPECT_LT(error.arcmin.max, 0.01);
  EXPECT_EQ(render::error_map_arcmin(reference, frame)[first], -1);
}

TEST(Comparison, ATurnedDirectionIsItsAngle) {
  const auto& t = traced(1200);
  const render::Frame reference = t.render(kWidth, kHeight);
  render::Frame turned = reference;
  const double angle = 7 * kArcmin;
  std::size_t optic_pixels = 0;
  for (std::size_t i = 0; i < turned.color.size(); ++i) {
    if (turned.optic_id[i] < 0) continue;
    ++optic_pixels;
    const glm::dvec3 d(reference.direction[i]), e = glm::normalize(glm::cross(d, glm::dvec3(0.3, 1, 0.2)));
    const glm::dvec3 shown = std::cos(angle) * d + std::sin(angle) * e;
    // Half of the pixels show a near point, half of them infinity.
    turned.position[i] = i % 2 ? glm::vec4(glm::vec3(glm::dvec3(reference.surface[i]) + 500.0 * shown), 1)
                               : glm::vec4(glm::vec3(shown), 0);
  }
  const render::OpticError error = render::compare(reference, turned, t.scene).optics[0];
  EXPECT_EQ(error.pixels, optic_pixels);
  EXPECT_NEAR(error.arcmin.median, 7, 0.002);
  EXPECT_NEAR(error.arcmin.max, 7, 0.01);
  const auto map = render::error_map_arcmin(reference, turned);
  for (std::size_t i = 0; i < map.size(); ++i) EXPECT_NEAR(map[i], reference.optic_id[i] < 0 ? -1 : 7, 0.01);
}

class ShiftedPicture : public testing::TestWithParam<double> {};

// A picture that shows everywhere what the exact one shows two pixels to the right and one down is 2.24 px
// off.
TEST_P(ShiftedPicture, ScreenErrorIsTheShift) {
  const auto& t = traced(GetParam());
  const render::Frame reference = t.render(kWidth, kHeight);
  render::Frame shifted = reference;
  for (int row = 0; row + 1 < kHeight; ++row)
    for (int column = 0; column + 2 < kWidth; ++column) {
      const auto i = std::size_t(row * kWidth + column), from = i + kWidth + 2;
      shifted.position[i] = reference.position[from];
      shifted.optic_id[i] = reference.optic_id[from] == reference.optic_id[i] ? reference.optic_id[i] : -1;
    }
  for (int column = 0; column < kWidth; ++column)
    shifted.optic_id[std::size_t((kHeight - 1) * kWidth + column)] = -1;
  for (int row = 0; row < kHeight; ++row)
    for (int column = kWidth - 2; column < kWidth; ++column)
      shifted.optic_id[std::size_t(row * kWidth + column)] = -1;
  const render::OpticError error = render::compare(reference, shifted, t.scene).optics[0];
  EXPECT_GT(error.outline_pixels, 0u);
  // The derivative is taken at one end of the shift; it changes by some 0.1 % a pixel.
  EXPECT_NEAR(error.screen_px.median, std::sqrt(5.0), 0.01);
  EXPECT_NEAR(error.screen_px.p99, std::sqrt(5.0), 0.1);
}

INSTANTIATE_TEST_SUITE_P(PlaneConvexConcave, ShiftedPicture, testing::Values(0, 1200, 300, -3000));

TEST(Comparison, QuantilesAreNearestRank) {
  const auto& t = traced(1200);
  const render::Frame reference = t.render(kWidth, kHeight);
  render::Frame one_off = reference;
  std::size_t pixels = 0, last = 0;
  for (std::size_t i = 0; i < reference.color.size(); ++i)
    if (reference.optic_id[i] == 0) last = i, ++pixels;
  const glm::dvec3 d(reference.direction[last]), e = glm::normalize(glm::cross(d, glm::dvec3(0, 1, 0)));
  one_off.position[last] = glm::vec4(glm::vec3(d + 0.01 * e), 0);
  const render::ErrorQuantiles q = render::compare(reference, one_off, t.scene).optics[0].arcmin;
  EXPECT_NEAR(q.max, std::atan(0.01) / kArcmin, 0.01);
  EXPECT_LT(q.p999, 0.01) << "1 of " << pixels << " pixels";
}

TEST(Comparison, PsnrIsTheFormulas) {
  render::Frame a, b;
  a.width = b.width = a.height = b.height = 16;
  a.color.assign(256, glm::vec4(0, 0, 0, 1));
  b.color.assign(256, glm::vec4(0.1f, 0.1f, 0.1f, 1));
  const render::ImageError error = render::image_error(a, b);
  EXPECT_NEAR(error.psnr_linear_db, 20, 1e-4) << "an error of 0.1 everywhere";
  EXPECT_NEAR(error.psnr_db, -20 * std::log10(render::linear_to_srgb(0.1f)), 1e-4);
  EXPECT_GT(error.flip_mean, 0.1);
}

TEST(Comparison, PicturesThatDoNotFitAreErrors) {
  const auto& t = traced(1200);
  const render::Frame reference = t.render(kWidth, kHeight), small = t.render(kWidth / 2, kHeight);
  render::Frame bare = reference;
  bare.position.clear();
  EXPECT_THROW((void)render::compare(reference, small, t.scene), Error);
  EXPECT_THROW((void)render::compare(reference, bare, t.scene), Error);
  EXPECT_THROW((void)render::compare(bare, reference, t.scene), Error);
  EXPECT_THROW((void)render::error_map_arcmin(reference, bare), Error);
}

}  // namespace
}  // namespace catoptra
