// Backs with cylinder: the torus against its implicit equation, its forms against one another, and what is
// refused.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "cad_import/lens_blank.h"
#include "tests/cad_import/lens_rays.h"

namespace catoptra::cad_import {
namespace {

constexpr double kIndex = 1.5, kFrontCurve_d = 6, kThickness_mm = 5, kReach_mm = 26;

LensBlank toric_lens(double sphere, double cylinder, double axis) {
  LensBlank blank;
  blank.index = kIndex;
  blank.sphere_d = sphere;
  blank.cylinder_d = cylinder;
  blank.axis_deg = axis;
  blank.front_curve_d = kFrontCurve_d;
  blank.center_thickness_mm = kThickness_mm;
  blank.diameter_mm = 2 * kReach_mm;
  return blank;
}

/// A torus in its closed form, for a back vertex at (0, 0, -thickness) without prism.
struct Torus {
  double circle_mm, ring_mm;  ///< radii of both principal sections, positive where the centre is behind
  double circle_deg;          ///< direction in which the circle lies

  /// By the thick lens formula: power behind the front F1 / (1 - t / n F1), back surface power the rest,
  /// radius (1 - n) / F2 with the centre behind where F2 < 0. The meridian along the cylinder's axis has the
  /// sphere's power. The steeper section is the circle.
  explicit Torus(const LensBlank& blank) {
    const double front = kFrontCurve_d / (1 - kThickness_mm / 1000 / kIndex * kFrontCurve_d);
    const auto radius = [&](double power_d) { return 1000 * (1 - kIndex) / (power_d - front); };
    const double along = radius(blank.sphere_d), across = radius(blank.sphere_d + blank.cylinder_d);
    const bool circle_along = std::abs(along) < std::abs(across);
    circle_mm = circle_along ? along : across;
    ring_mm = circle_along ? across : along;
    circle_deg = blank.axis_deg + (circle_along ? 0 : 90);
  }

  /// Distance of a point from the torus: the tube of radius |circle| around the circle of radius ring -
  /// circle in the plane of the turn, (D - (R - r))^2 + u^2 = r^2 with D the distance from the axis of
  /// revolution.
  [[nodiscard]] double distance_mm(const glm::dvec3& p) const {
    const double angle = circle_deg * std::numbers::pi / 180;
    const double u = p.x * std::cos(angle) + p.y * std::sin(angle);
    const double v = p.y * std::cos(angle) - p.x * std::sin(angle);
    const double from_axis = std::copysign(std::hypot(v, p.z + kThickness_mm + ring_mm), ring_mm);
    return std::abs(std::hypot(from_axis - (ring_mm - circle_mm), u) - std::abs(circle_mm));
  }
};

/// Tyres of both orders, a saddle (circle and ring bend to opposite sides) and one nearly a cylinder.
std::vector<LensBlank> toric_lenses() {
  return {toric_lens(-2, -3, 30), toric_lens(-6, 2.5, 115), toric_lens(-5, -3, 0), toric_lens(7, -4, 140),
          toric_lens(6.05, -5, 75)};
}

template <typename Visit>
void over_aperture(Visit visit) {
  for (int i = -20; i <= 20; ++i)
    for (int k = -20; k <= 20; ++k)
      if (const double x = 1.29 * i, y = 1.29 * k; std::hypot(x, y) < kReach_mm) visit(x, y);
}

TEST(ToricBack, LiesOnTheTorusOfItsClosedForm) {
  for (const LensBlank& blank : toric_lenses()) {
    const LensShape shape(blank);
    EXPECT_EQ(shape.report().back, LensBackForm::toric);
    const Torus torus(blank);
    const CadModel model = lens_model(shape);
    const Face& back = test::face_called(model, "back");
    double ideal = 0, spline = 0;
    over_aperture([&](double x, double y) {
      ideal = std::max(ideal, torus.distance_mm({x, y, shape.back_z_mm(x, y)}));
      spline = std::max(spline, torus.distance_mm(back.surface->point(x, y)));
    });
    EXPECT_LT(ideal, 1e-11) << blank.sphere_d << " / " << blank.cylinder_d;
    EXPECT_LT(spline, 1e-7) << blank.sphere_d << " / " << blank.cylinder_d;  // lens_model's promise
  }
}

/// Every cross section of a torus through its axis is the same circle, so that one principal curvature is the
/// same everywhere: also where a prism has tilted the surface.
TEST(ToricBack, OnePrincipalCurvatureIsTheSameEverywhere) {
  constexpr double kCurvature = 3e-6;  // 1/mm: what the spline's second derivatives allow
  LensBlank blank = toric_lens(-4, -3, 30);
  blank.prism_d = 4;
  blank.prism_base_deg = 200;
  for (const LensBackForm form : {LensBackForm::toric, LensBackForm::biconic}) {
    blank.back = form;
    const LensShape shape(blank);
    const CadModel model = lens_model(shape);
    const Face& back = test::face_called(model, "back");
    const double circle = 1 / std::min(shape.report().back_radius1_mm, shape.report().back_radius2_mm);
    double worst = 0;
    over_aperture([&](double x, double y) {
      const PrincipalCurvatures k = back.surface->principal_curvatures(x, y);
      worst = std::max(worst, std::abs(std::max(std::abs(k.k1), std::abs(k.k2)) - circle));
    });
    if (form == LensBackForm::toric)
      EXPECT_LT(worst, kCurvature);
    else
      EXPECT_GT(worst, 30 * kCurvature) << "a biconic is no torus";
  }
}

TEST(ToricBack, BothFormsAgreeAtTheVertexAndAlongTheMeridians) {
  LensBlank blank = toric_lens(-2, -4, 0);
  const LensShape toric(blank);
  blank.back = LensBackForm::biconic;
  const LensShape biconic(blank);
  EXPECT_EQ(biconic.report().back, LensBackForm::biconic);
  EXPECT_NEAR(toric.report().back_radius1_mm, biconic.report().back_radius1_mm, 1e-9);
  EXPECT_NEAR(toric.report().back_radius2_mm, biconic.report().back_radius2_mm, 1e-9);
  for (double r = 0; r < kReach_mm; r += 2) {
    EXPECT_NEAR(toric.back_z_mm(r, 0), biconic.back_z_mm(r, 0), 1e-11) << r;
    EXPECT_NEAR(toric.back_z_mm(0, r), biconic.back_z_mm(0, r), 1e-11) << r;
  }
  // Both to fourth order, s the steeper curvature and c the flatter, t^2 = (x y)^2:
  // torus s c^2 t^2 / 4, biconic (c s^2 + s c^2) t^2 / 8; they differ by c s (s - c) t^2 / 8.
  const double s = 1 / std::min(toric.report().back_radius1_mm, toric.report().back_radius2_mm);
  const double c = 1 / std::max(toric.report().back_radius1_mm, toric.report().back_radius2_mm);
  const auto difference = [&](double xy) { return toric.back_z_mm(xy, xy) - biconic.back_z_mm(xy, xy); };
  EXPECT_NEAR(std::abs(difference(3)), c * s * (s - c) * 81 / 8, 0.02 * c * s * (s - c) * 81 / 8);
  EXPECT_GT(std::abs(difference(18)), 1e-3);
}

TEST(ToricBack, EqualCurvaturesAreASphere) {
  const LensBlank blank = toric_lens(-4, 0, 0);
  const LensShape shape(blank);
  const double radius = shape.report().back_radius1_mm;
  over_aperture([&](double x, double y) {
    const glm::dvec3 centre(0, 0, -kThickness_mm - radius);
    EXPECT_NEAR(glm::distance({x, y, shape.back_z_mm(x, y)}, centre), radius, 1e-11);
  });
}

TEST(BiconicBack, PowersOnTheAxisAreAsOrdered) {
  for (const double conic : {0.0, -0.7})
    for (LensBlank blank : toric_lenses()) {
      blank.back = LensBackForm::biconic;
      blank.back_conic = conic;
      const test::MeasuredPower measured =
          test::measure(test::MeasuredLens(lens_model(LensShape(blank)), kIndex));
      const double trace = measured.power_d[0][0] + measured.power_d[1][1];
      EXPECT_NEAR(trace, 2 * blank.sphere_d + blank.cylinder_d, 0.01);
      const double cross =
          std::hypot(measured.power_d[0][0] - measured.power_d[1][1], 2 * measured.power_d[0][1]);
      EXPECT_NEAR(cross, std::abs(blank.cylinder_d), 0.01);
    }
}

std::string refusal(const LensBlank& blank) {
  try {
    const LensShape shape(blank);
    return "no error";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(ToricBack, RefusesWhatNoTorusCanBe) {
  LensBlank conic = toric_lens(-2, -3, 30);
  conic.back = LensBackForm::toric;
  conic.back_conic = -0.5;
  EXPECT_NE(refusal(conic).find("back conic: -0.5 needs a biconic back"), std::string::npos)
      << refusal(conic);
  conic.back.reset();
  EXPECT_EQ(LensShape(conic).report().back, LensBackForm::biconic) << "left out, the conic needs it";
  // Steep: a radius below 1.05 half diameters, 500 / (6.1 + 13.3) = 25.8 mm against 26 mm.
  EXPECT_NE(refusal(toric_lens(-4, -9.3, 30)).find("back curve: its radius of 2"), std::string::npos)
      << refusal(toric_lens(-4, -9.3, 30));
}

}  // namespace
}  // namespace catoptra::cad_import
