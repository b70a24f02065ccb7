#include "optics/refraction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <random>

namespace catoptra::optics {
namespace {

TEST(Refract, KeepsSnellsLaw) {
  for (const double angle_deg : {0.0, 10.0, 35.0, 60.0, 89.0}) {
    const double i = glm::radians(angle_deg);
    const auto out = refract({std::sin(i), 0, -std::cos(i)}, {0, 0, 1}, 1 / 1.5);
    ASSERT_TRUE(out);
    EXPECT_NEAR(out->x, std::sin(i) / 1.5, 1e-15);
    EXPECT_NEAR(glm::length(*out), 1, 1e-15);
  }
}

TEST(Refract, NulloptBeyondCriticalAngle) {
  const double critical = *critical_angle(1.5, 1);
  EXPECT_NEAR(critical, std::asin(1 / 1.5), 1e-15);
  const auto at = [](double i) { return refract({std::sin(i), 0, -std::cos(i)}, {0, 0, 1}, 1.5); };
  EXPECT_TRUE(at(critical - 1e-9));
  EXPECT_FALSE(at(critical + 1e-9));
  EXPECT_FALSE(critical_angle(1, 1.5));
}

TEST(Refract, IsReversible) {
  const unsigned seed = 20261122;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1), index(1, 2);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(uniform(random), uniform(random), uniform(random)) +
                                        glm::dvec3(0, 0, 1e-3));
    glm::dvec3 d = glm::normalize(glm::dvec3(uniform(random), uniform(random), uniform(random)));
    if (glm::dot(d, n) > 0) d = -d;
    const double eta = index(random) / index(random);
    const auto forward = refract(d, n, eta);
    if (!forward) continue;
    const auto back = refract(-*forward, -n, 1 / eta);
    ASSERT_TRUE(back);
    EXPECT_LT(glm::length(*back + d), 1e-7);  // grazing rays lose half the digits in the square root
  }
}

// ((n - 1) / (n + 1))^2. Source: Hecht 2017, 4.6.3.
TEST(FresnelDielectric, NormalIncidence) {
  EXPECT_NEAR(fresnel_dielectric(1, 1, 1.5).unpolarised, 0.04, 1e-15);
  EXPECT_NEAR(fresnel_dielectric(1, 1.5, 1).unpolarised, 0.04, 1e-15);
}

TEST(FresnelDielectric, NothingOfPIsReflectedAtBrewstersAngle) {
  const double brewster = std::atan(1.5);
  EXPECT_NEAR(fresnel_dielectric(std::cos(brewster), 1, 1.5).p, 0, 1e-30);
  EXPECT_GT(fresnel_dielectric(std::cos(brewster), 1, 1.5).s, 0.1);
}

TEST(FresnelDielectric, TotalBeyondTheCriticalAngle) {
  const double critical = *critical_angle(1.5, 1);
  EXPECT_EQ(fresnel_dielectric(std::cos(critical + 1e-6), 1.5, 1).unpolarised, 1);
  EXPECT_LT(fresnel_dielectric(std::cos(critical - 1e-3), 1.5, 1).unpolarised, 1);
}

// R = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2) in air; aluminium at 550 nm (Rakic 1995): 0.915.
TEST(FresnelConductor, NormalIncidence) {
  const double n = 1.015, k = 6.627;
  const double expected = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
  EXPECT_NEAR(fresnel_conductor(1, 1, n, k).unpolarised, expected, 1e-14);
  EXPECT_NEAR(expected, 0.915, 1e-3);
}

// A metal that absorbs nothing is a dielectric: two formulas that must agree.
TEST(FresnelConductor, WithoutAbsorptionIsADielectric) {
  for (double cos_i = 0.02; cos_i <= 1; cos_i += 0.07) {
    const auto metal = fresnel_conductor(cos_i, 1, 1.6, 0), glass = fresnel_dielectric(cos_i, 1, 1.6);
    EXPECT_NEAR(metal.s, glass.s, 1e-14);
    EXPECT_NEAR(metal.p, glass.p, 1e-14);
    EXPECT_NEAR(metal.unpolarised, glass.unpolarised, 1e-14);
  }
}

}  // namespace
}  // namespace catoptra::optics
