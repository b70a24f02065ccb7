// Sphere, cylinder and axis.
#include "optics/lens_power.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/trigonometric.hpp>
#include <numbers>

namespace catoptra::optics {
namespace {

SphereCylinder ordered(double sphere, double cylinder, double axis_deg) {
  return {sphere, cylinder, glm::radians(axis_deg)};
}

void expect_near(const SphereCylinder& found, const SphereCylinder& expected) {
  EXPECT_NEAR(found.sphere_d, expected.sphere_d, 1e-12);
  EXPECT_NEAR(found.cylinder_d, expected.cylinder_d, 1e-12);
  EXPECT_NEAR(found.axis_rad, expected.axis_rad, 1e-12);
}

TEST(LensPower, CylindersAreTransposed) {
  expect_near(transposed(ordered(6, -3, 140), CylinderForm::plus), ordered(3, 3, 50));
  expect_near(transposed(ordered(3, 3, 50), CylinderForm::minus), ordered(6, -3, 140));
  expect_near(transposed(ordered(-1, 0.5, 90), CylinderForm::minus), ordered(-0.5, -0.5, 180));
  expect_near(transposed(ordered(-1, 0.5, 90), CylinderForm::plus), ordered(-1, 0.5, 90));
}

TEST(LensPower, MatricesGiveBackWhatTheyAreOf) {
  for (int axis = 1; axis <= 180; ++axis) {
    const SphereCylinder minus = ordered(2.25, -1.75, axis), plus = ordered(0.5, 1.75, axis);
    expect_near(sphere_cylinder(power_matrix(minus), CylinderForm::minus), minus);
    expect_near(sphere_cylinder(power_matrix(plus), CylinderForm::plus), plus);
    expect_near(sphere_cylinder(power_matrix(minus), CylinderForm::plus),
                transposed(minus, CylinderForm::plus));
  }
  // 0 is written as 180, and no cylinder has the axis 180.
  expect_near(sphere_cylinder(power_matrix(ordered(1, -2, 0)), CylinderForm::minus), ordered(1, -2, 180));
  EXPECT_EQ(sphere_cylinder({1, 1e-12, -1}, CylinderForm::minus).axis_rad, std::numbers::pi);
  const SphereCylinder sphere = sphere_cylinder({2, 1e-10, 2 + 1e-10}, CylinderForm::minus);
  EXPECT_EQ(sphere.cylinder_d, 0);
  EXPECT_EQ(sphere.axis_rad, std::numbers::pi);
}

// S + C sin^2 (angle - axis).
TEST(LensPower, PowerAlongMeridians) {
  const SphereCylinder power = ordered(-2, 3.5, 25);
  for (int angle = 0; angle < 360; angle += 5) {
    const double s = std::sin(glm::radians(angle - 25.0));
    EXPECT_NEAR(power_matrix(power).along(glm::radians(double(angle))), -2 + 3.5 * s * s, 1e-14);
  }
}

// Equal cylinders crossed at right angles make a sphere; equal and opposite ones at 45 degrees a Stokes lens:
// no mean power, and a cylinder of sqrt(2) times theirs.
TEST(LensPower, ThinLensesAdd) {
  const auto sum = [](const SphereCylinder& a, const SphereCylinder& b) {
    const PowerMatrix m = power_matrix(a), n = power_matrix(b);
    return sphere_cylinder({m.xx + n.xx, m.xy + n.xy, m.yy + n.yy}, CylinderForm::plus);
  };
  expect_near(sum(ordered(0, 2, 30), ordered(0, 2, 120)), ordered(2, 0, 180));
  const SphereCylinder stokes = sum(ordered(0, 2, 60), ordered(0, -2, 15));
  EXPECT_NEAR(stokes.cylinder_d, 2 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(stokes.sphere_d, -std::sqrt(2.0), 1e-12);
}

TEST(LensPower, PowerVectors) {
  const PowerVector v = power_vector(ordered(1, -2, 30));
  EXPECT_NEAR(v.m, 0, 1e-15);
  EXPECT_NEAR(v.j0, 0.5, 1e-15);
  EXPECT_NEAR(v.j45, std::sqrt(0.75), 1e-15);
  const PowerVector same = power_vector(transposed(ordered(1, -2, 30), CylinderForm::plus));
  EXPECT_NEAR(same.m, v.m, 1e-15);
  EXPECT_NEAR(same.j0, v.j0, 1e-15);
  EXPECT_NEAR(same.j45, v.j45, 1e-15);
}

}  // namespace
}  // namespace catoptra::optics
