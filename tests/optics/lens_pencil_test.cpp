// The wavefront that a chief ray carries against a pencil of real rays, over random lenses.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <iostream>
#include <numbers>
#include <random>

#include "optics/lens_evaluation.h"
#include "tests/optics/pencil.h"
#include "tests/support/analytic_lens.h"
#include "tests/support/aspheric_surface.h"

namespace catoptra::optics {
namespace {

class RandomWear {
 public:
  explicit RandomWear(unsigned seed) : engine_(seed) { std::cout << "seed " << seed << '\n'; }

  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  bool chance(double share) { return number(0, 1) < share; }

  // A surface of one lens side, convex towards the object: curvatures of base, a cylinder, conics, higher
  // terms and tilt.
  test::AsphereSpec side(double curvature) {
    test::AsphereSpec s;
    s.half_width_mm = 32;
    s.c1 = curvature;
    s.c2 = chance(0.7) ? curvature + number(-0.006, 0.006) : curvature;
    s.angle_rad = number(0, std::numbers::pi);
    if (chance(0.5)) {
      s.k1 = number(-2, 0.5);
      s.k2 = number(-2, 0.5);
      s.a = number(-4e-7, 4e-7);
      s.b = number(-2e-10, 2e-10);
    }
    if (chance(0.3)) {
      s.sx = number(-0.05, 0.05);
      s.sy = number(-0.05, 0.05);
    }
    return s;
  }

  Optic lens(double& thickness_mm) {
    const double front = number(0, 0.016), back = front + number(-0.012, 0.012);
    thickness_mm = 9 + number(0, 3);  // the sides never cross within 30 degrees of gaze
    Optic lens =
        test::lens_between(std::make_shared<test::AsphericSurface>(side(front)),
                           std::make_shared<test::AsphericSurface>(side(back)), thickness_mm, 60, 21);
    lens.medium = constant_medium(number(1.45, 1.9));
    return lens;
  }

  EvaluationOptions wear() {
    EvaluationOptions o;
    o.mode = EvaluationMode::as_worn;
    o.chromatic = false;
    o.position.rotation_centre_mm = number(20, 30);
    o.position.pantoscopic_rad = number(-0.2, 0.3);
    o.position.wrap_rad = number(-0.1, 0.4);
    o.position.eye = chance(0.5) ? Eye::right : Eye::left;
    if (chance(0.5)) o.object_distance_mm = number(250, 3000);
    return o;
  }

 private:
  std::mt19937_64 engine_;
};

// A vector turned by `angle` about the unit axis (Rodrigues).
glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& axis, double angle) {
  return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
         axis * (glm::dot(axis, v) * (1 - std::cos(angle)));
}

// x, y and z turned by the rotation of z into `d` about the axis across both.
std::array<glm::dvec3, 2> across(const std::array<glm::dvec3, 3>& axes, const glm::dvec3& d) {
  const glm::dvec3 axis = glm::cross(axes[2], d);
  if (glm::length(axis) < 1e-12) return {axes[0], axes[1]};
  const double angle = std::atan2(glm::length(axis), glm::dot(axes[2], d));
  return {turned(axes[0], glm::normalize(axis), angle), turned(axes[1], glm::normalize(axis), angle)};
}

// The wearer's axes in the lens's frame: the lens is turned before the eye, so the eye is turned back before
// the lens.
std::array<glm::dvec3, 3> axes_of(const WearingPosition& p) {
  const double wrap = p.eye == Eye::right ? -p.wrap_rad : p.wrap_rad;
  std::array<glm::dvec3, 3> axes{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};
  for (auto& a : axes) a = turned(turned(a, {0, 1, 0}, -wrap), {1, 0, 0}, -p.pantoscopic_rad);
  return axes;
}

// The greatest difference of two powers, D. The pencil is good to 1e-7 D (its last extrapolation changes less
// than that).
double difference(const PowerMatrix& found, const glm::dmat2& vergence, double added_d, double n) {
  double worst = std::abs(found.xx - (1000 * n * vergence[0][0] + added_d));
  worst = std::max(worst, std::abs(found.yy - (1000 * n * vergence[1][1] + added_d)));
  worst = std::max(worst, std::abs(found.xy - 1000 * n * vergence[0][1]));
  return std::max(worst, std::abs(found.xy - 1000 * n * vergence[1][0]));
}

TEST(LensEvaluatorProperty, PowersAsWornAreThoseOfAPencil) {
  RandomWear random(20261124);
  double worst_d = 0;
  int tried = 0;
  for (int passed = 0; passed < 1000; ++tried) {
    double thickness = 0;
    const Optic lens = random.lens(thickness);
    const glm::dvec3 vertex(0, 0, -thickness);
    const EvaluationOptions options = random.wear();
    const glm::dvec2 gaze{random.number(-0.5, 0.5), random.number(-0.4, 0.4)};
    const auto result = LensEvaluator(lens, {.back_vertex_mm = vertex}).at_gaze(std::span(&gaze, 1), options);
    if (result.points[0].end != LensPathEnd::passed) continue;
    ++passed;

    const auto axes = axes_of(options.position);
    const double rc = options.position.rotation_centre_mm;
    const glm::dvec3 d = glm::normalize(std::tan(gaze.x) * axes[0] + std::tan(gaze.y) * axes[1] + axes[2]);
    const glm::dvec3 centre = vertex - rc * axes[2];
    const auto [x, y] = across(axes, d);
    const LensIndices n = lens_indices(lens, options.wavelength_nm);
    const test::Line sight{centre + rc * d, d};
    const glm::dmat2 vergence =
        test::pencil_vergence(lens, sight, centre + rc * d, x, y, options.object_distance_mm, n);
    const double error =
        difference(result.points[0].power, vergence, 1000 / options.object_distance_mm, n.around);
    worst_d = std::max(worst_d, error);
    ASSERT_LT(error, 1e-6) << "lens " << tried;
    const glm::dvec3 object = test::chief_ray(lens, sight, n).direction;
    EXPECT_NEAR(result.points[0].prism.x, 100 * glm::dot(object, x) / glm::dot(object, d), 1e-8);
    EXPECT_NEAR(result.points[0].prism.y, 100 * glm::dot(object, y) / glm::dot(object, d), 1e-8);
  }
  EXPECT_LT(tried, 1100);
  std::cout << "greatest difference " << worst_d << " D\n";
}

TEST(LensEvaluatorProperty, FocimeterPowersAreThoseOfAPencil) {
  RandomWear random(41);
  double worst_d = 0;
  int tried = 0;
  for (int passed = 0; passed < 300; ++tried) {
    double thickness = 0;
    const Optic lens = random.lens(thickness);
    const glm::dvec3 vertex(0, 0, -thickness);
    const glm::dvec2 point{random.number(-15, 15), random.number(-15, 15)};
    EvaluationOptions options;
    options.chromatic = false;
    const auto result =
        LensEvaluator(lens, {.back_vertex_mm = vertex}).at_points(std::span(&point, 1), options);
    if (result.points[0].end != LensPathEnd::passed) continue;
    ++passed;
    EXPECT_NEAR(glm::distance(result.points[0].point_mm, point), 0, 1e-9);
    const auto& surface = *lens.back.faces[0].surface;
    const glm::dvec3 d = -surface.unit_normal(point.x, point.y), at = surface.point(point.x, point.y);
    const auto [x, y] = across({glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}, d);
    const LensIndices n = lens_indices(lens, options.wavelength_nm);
    const double error = difference(
        result.points[0].power, test::pencil_vergence(lens, {at, d}, at, x, y, kInfinity, n), 0, n.around);
    worst_d = std::max(worst_d, error);
    ASSERT_LT(error, 1e-6) << "lens " << tried;
  }
  EXPECT_LT(tried, 330);
  std::cout << "greatest difference " << worst_d << " D\n";
}

}  // namespace
}  // namespace catoptra::optics
