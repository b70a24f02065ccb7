#include "optics/lens_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "tests/support/analytic_lens.h"

namespace catoptra::optics {
namespace {

constexpr LensIndices kGlass{1.5, 1};

// A ray along the axis towards -z at height h meets the focus of a thick lens: 1/f = (n-1)(1/R1 - 1/R2 +
// (n-1) t/(n R1 R2)). Source: Hecht 2017, 6.1. Near the axis the error is third order: at h = 0.01 mm below
// 1e-6 mm.
TEST(LensPath, ParaxialFocusIsTheLensmakers) {
  const Optic lens = test::spherical_lens(80, -120, 6, 50, 21);
  const LensTracer tracer(lens);
  const double h = 0.01;
  const LensPath path = tracer.trace({{h, 0, 100}, {0, 0, -1}}, LensSide::front, kGlass);
  ASSERT_EQ(path.end, LensPathEnd::passed);
  const double f = 1 / (0.5 * (1 / 80.0 + 1 / 120.0 - 0.5 * 6 / (1.5 * 80 * 120)));
  EXPECT_NEAR(h / std::tan(std::atan2(-path.outside.x, -path.outside.z)), f, 1e-5);
}

TEST(LensPath, PlaneParallelPlateOnlyShiftsTheRay) {
  const Optic plate = test::spherical_lens(0, 0, 5, 60, 2);
  const LensTracer tracer(plate);
  const double i = glm::radians(40.0);
  const glm::dvec3 d{std::sin(i), 0, -std::cos(i)};
  const LensPath path = tracer.trace({{-10, 0, 20}, d}, LensSide::front, kGlass);
  ASSERT_EQ(path.end, LensPathEnd::passed);
  EXPECT_LT(glm::length(path.outside - d), 1e-15);
  // t sin(i) (1 - cos i / (n cos i')). Source: Hecht 2017, problem 4.40.
  const double cos_t = std::sqrt(1 - std::pow(std::sin(i) / 1.5, 2));
  const double shift = 5 * std::sin(i) * (1 - std::cos(i) / (1.5 * cos_t));
  const glm::dvec3 across = path.exit.position_mm - glm::dvec3(-10, 0, 20);
  EXPECT_NEAR(glm::length(across - glm::dot(across, d) * d), shift, 1e-12);
}

TEST(LensPath, IsReversible) {
  const Optic lens = test::spherical_lens(70, 150, 4, 50, 21);
  const LensTracer tracer(lens);
  const LensPath there =
      tracer.trace({{8, -5, 60}, glm::normalize(glm::dvec3(0.1, 0.05, -1))}, LensSide::front, kGlass);
  ASSERT_EQ(there.end, LensPathEnd::passed);
  const Ray home{there.exit.position_mm + 30.0 * there.outside, -there.outside};
  const LensPath back = tracer.trace(home, LensSide::back, kGlass);
  ASSERT_EQ(back.end, LensPathEnd::passed);
  EXPECT_LT(glm::length(back.exit.position_mm - there.entry.position_mm), 1e-9);
  EXPECT_LT(glm::length(back.outside - glm::normalize(glm::dvec3(-0.1, -0.05, 1))), 1e-12);
}

TEST(LensPath, SaysWhyARayDoesNotPass) {
  const Optic plate = test::spherical_lens(0, 0, 30, 20, 2);
  const LensTracer tracer(plate);
  EXPECT_EQ(tracer.trace({{50, 0, 20}, {0, 0, -1}}, LensSide::front, kGlass).end, LensPathEnd::missed);
  const glm::dvec3 steep = glm::normalize(glm::dvec3(2, 0, -1));
  EXPECT_EQ(tracer.trace({glm::dvec3(5, 0, 0) - 10.0 * steep, steep}, LensSide::front, kGlass).end,
            LensPathEnd::rim);
  const Optic prism = test::spherical_lens(0, -15, 10, 24, 41);  // steep back near its edge
  const LensPath edge = LensTracer(prism).trace({{11.5, 0, 20}, {0, 0, -1}}, LensSide::front, kGlass);
  EXPECT_EQ(edge.end, LensPathEnd::total_reflection);
}

TEST(SideTowards, DependsOnWhereTheEyeIs) {
  const Optic lens = test::spherical_lens(80, 60, 3, 50, 9);
  EXPECT_EQ(side_towards(lens, {0, 0, 300}), LensSide::front);
  EXPECT_EQ(side_towards(lens, {0, 0, -27}), LensSide::back);
}

}  // namespace
}  // namespace catoptra::optics
