// LDR-FLIP against what its paper says of it, and against values worked out by hand for flat pictures.
#include "render/src/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace catoptra {
namespace {

constexpr int kSize = 64;

std::vector<glm::vec4> flat(const glm::vec3& color) {
  return std::vector<glm::vec4>(kSize * kSize, glm::vec4(color, 1));
}

std::vector<glm::vec4> noise(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<glm::vec4> pixels = flat({0, 0, 0});
  for (glm::vec4& p : pixels) p = {uniform(random), uniform(random), uniform(random), 1};
  return pixels;
}

float largest(const std::vector<float>& map) {
  return *std::max_element(map.begin(), map.end());
}
float smallest(const std::vector<float>& map) {
  return *std::min_element(map.begin(), map.end());
}

std::vector<float> flip(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
  return render::flip_map(a, b, kSize, kSize);
}

TEST(Flip, SamePicturesDoNotDiffer) {
  EXPECT_EQ(largest(flip(noise(1), noise(1))), 0);
}

TEST(Flip, IsSymmetric) {
  EXPECT_EQ(flip(noise(1), noise(2)), flip(noise(2), noise(1)));
}

TEST(Flip, StaysBetweenZeroAndOne) {
  const auto map = flip(noise(3), noise(4));
  EXPECT_GE(smallest(map), 0);
  EXPECT_LE(largest(map), 1);
}

// Flat pictures have no features, so FLIP is the redistributed colour distance. By hand for black and white:
// the distance is 100 (lightness alone), 100^0.7 = 25.119. The largest one, between Hunt-adjusted green
// (87.735, -75.61, 72.98) and blue (32.30, 25.58, -34.84), is 55.43 + 147.93 = 203.36, to the power
// 0.7: 41.28; so 0.95 + 0.05 (25.119 - 16.51) / (41.28 - 16.51) = 0.9674.
TEST(Flip, BlackAndWhite) {
  const auto map = flip(flat({0, 0, 0}), flat({1, 1, 1}));
  EXPECT_NEAR(smallest(map), 0.9674, 5e-4);
  EXPECT_NEAR(largest(map), 0.9674, 5e-4);
}

TEST(Flip, GreenAndBlueDifferMost) {
  const auto map = flip(flat({0, 1, 0}), flat({0, 0, 1}));
  EXPECT_NEAR(smallest(map), 1, 1e-5);
  EXPECT_NEAR(largest(map), 1, 1e-5);
}

// Grey of linear 0.18 against 0.2: L* = 49.50 and 51.84, distance 2.342, ^0.7 = 1.814, x 0.95 / 16.51 =
// 0.1044.
TEST(Flip, SmallDifferencesCountLinearly) {
  EXPECT_NEAR(largest(flip(flat(glm::vec3(0.18f)), flat(glm::vec3(0.2f)))), 0.1044, 5e-4);
}

// Paper, section 4.2: the same colour difference weighs more where an edge or a point appears.
TEST(Flip, APointIsWorseThanItsBlurredColorAlone) {
  auto dotted = flat(glm::vec3(0.5f));
  dotted[kSize / 2 * kSize + kSize / 2] = glm::vec4(1);
  const auto map = flip(flat(glm::vec3(0.5f)), dotted);
  EXPECT_GT(map[kSize / 2 * kSize + kSize / 2], map[kSize / 2 * kSize + kSize / 2 + 4]);
  EXPECT_NEAR(map[0], 0, 1e-3) << "far from it nothing differs";
}

// Paper, section 4.1: what the eye cannot resolve does not count. A pixel checker against its mean, seen from
// far away.
TEST(Flip, FineCheckerVanishesFromAfar) {
  auto checker = flat({0, 0, 0});
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if ((x + y) % 2) checker[std::size_t(y * kSize + x)] = glm::vec4(1);
  const auto grey = flat(glm::vec3(0.5f));
  const float near = render::flip_map(grey, checker, kSize, kSize, 20)[kSize / 2 * kSize + kSize / 2];
  const float far = render::flip_map(grey, checker, kSize, kSize, 200)[kSize / 2 * kSize + kSize / 2];
  EXPECT_LT(far, 0.01f);
  EXPECT_GT(near, 5 * far);
}

}  // namespace
}  // namespace catoptra
