// Radii, spherometers and magnification against closed forms and published goldens.
#include "optics/mirror_evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <random>

#include "cad_import/error.h"
#include "optics/reflection.h"
#include "tests/support/analytic_optic.h"

namespace catoptra::optics {
namespace {

const glm::dvec3 kUp(0, 1, 0);

/// An eye at `distance` from the origin, under `incidence_rad` to +z.
glm::dvec3 eye_at(double distance, double incidence_rad, double turn_rad = 0) {
  return distance * glm::dvec3(std::sin(incidence_rad) * std::cos(turn_rad),
                               std::sin(incidence_rad) * std::sin(turn_rad), std::cos(incidence_rad));
}

struct Golden {
  double distance, radius, incidence_deg, tangential, sagittal;
};
// Source: derived, and confirmed by finite-difference reflection to 1e-9.
constexpr Golden kGoldens[] = {{840, 1260, 35, 0.380561, 0.477965},
                               {750, 1200, 30, 0.409270, 0.480185},
                               {1450, 1400, 60, 0.194444, 0.491228}};

TEST(MirrorView, MagnificationGoldens) {
  for (const Golden& g : kGoldens)
    for (const double turn : {0.0, 1.1}) {
      const MirrorGlass glass(test::conic_mirror(g.radius, 0, 170, 110, 9, 9), kUp);
      const auto view =
          mirror_view(*glass.at({0, 0}), eye_at(g.distance, glm::radians(g.incidence_deg), turn));
      ASSERT_TRUE(view);
      EXPECT_NEAR(view->tangential, g.tangential, 1e-6);
      EXPECT_NEAR(view->sagittal, g.sagittal, 1e-6);
      EXPECT_NEAR(view->anisotropy, g.sagittal / g.tangential, 1e-5);
      EXPECT_NEAR(glm::degrees(view->incidence_rad), g.incidence_deg, 1e-9);
    }
}

TEST(MirrorView, FiniteObjectAndAstigmatismFollowCoddington) {
  const MirrorGlass glass(test::conic_mirror(1200, 0, 170, 110, 9, 9), kUp);
  const double a = 800, b = glm::radians(40.0), d = 3000, r = 1200;
  const auto view = mirror_view(*glass.at({0, 0}), eye_at(a, b), d);
  EXPECT_NEAR(view->tangential, (a + d) / (a + d + 2 * a * d / (r * std::cos(b))), 1e-12);
  EXPECT_NEAR(view->sagittal, (a + d) / (a + d + 2 * a * d * std::cos(b) / r), 1e-12);
  // Far object: virtual focal lengths 459.63 and 783.24 mm, 0.1623 D at the eye.
  EXPECT_NEAR(mirror_view(*glass.at({0, 0}), eye_at(a, b))->astigmatism_d,
              1000 / (a + r / 2 * std::cos(b)) - 1000 / (a + r / 2 / std::cos(b)), 1e-10);
  EXPECT_NEAR(mirror_view(*glass.at({0, 0}), eye_at(a, b))->astigmatism_d, 0.1623, 5e-5);
}

/// Judge without second derivatives of the surface: neighbouring eye rays, reflected where they meet the
/// exact surface. Returns the singular values of (object angle) / (image angle), inverted.
std::pair<double, double> magnification_by_neighbours(const MirrorGlass& glass, const GlassPoint& point,
                                                      const glm::dvec3& eye) {
  const glm::dvec3 d = glm::normalize(point.surface.point - eye);
  const glm::dvec3 e1 = glm::normalize(glm::cross(d, glm::dvec3(0.3, 0.8, 0.5))), e2 = glm::cross(d, e1);
  const double h = 1e-5;
  const auto out = [&](const glm::dvec3& way) {
    const auto hit = glass.meet(eye, glm::normalize(way), point);
    return reflect(glm::normalize(way), hit->normal);
  };
  const glm::dvec3 c1 = (out(d + h * e1) - out(d - h * e1)) / (2 * h);
  const glm::dvec3 c2 = (out(d + h * e2) - out(d - h * e2)) / (2 * h);
  const double aa = glm::dot(c1, c1), bb = glm::dot(c2, c2), ab = glm::dot(c1, c2);
  const double mean = (aa + bb) / 2, root = std::hypot((aa - bb) / 2, ab);
  return {1 / std::sqrt(mean + root), 1 / std::sqrt(mean - root)};
}

TEST(MirrorView, TensorEqualsNeighbouringRaysOnAnySurface) {
  std::mt19937 random(20261124);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const double k1 = 1 / (400 + 800 * std::abs(unit(random))), k2 = k1 * unit(random);
    const MirrorGlass glass(
        test::rectangular_mirror(
            std::make_shared<test::TwoCurvatureSurface>(k1, k2, 3 * unit(random), 60, 60), 120, 120, 9, 9),
        kUp);
    const auto point = glass.at({40 * unit(random), 40 * unit(random)});
    ASSERT_TRUE(point);
    const glm::dvec3 eye = point->surface.point + eye_at(300, std::abs(unit(random)), 3 * unit(random));
    const auto view = mirror_view(*point, eye);
    ASSERT_TRUE(view);
    const auto [least, greatest] = magnification_by_neighbours(glass, *point, eye);
    EXPECT_NEAR(view->least / least, 1, 1e-6) << "seed 20261124, case " << i;
    EXPECT_NEAR(view->greatest / greatest, 1, 1e-6) << "seed 20261124, case " << i;
  }
}

TEST(MirrorView, PlaneMagnifiesByOneAndABackHasNoView) {
  const MirrorGlass glass(test::conic_mirror(0, 0, 170, 110, 9, 9), kUp);
  const auto view = mirror_view(*glass.at({30, 10}), eye_at(900, 0.7));
  EXPECT_NEAR(view->tangential, 1, 1e-12);
  EXPECT_NEAR(view->sagittal, 1, 1e-12);
  EXPECT_NEAR(view->astigmatism_d, 0, 1e-12);
  EXPECT_FALSE(mirror_view(*glass.at({0, 0}), {0, 0, -500}));
}

TEST(RadiusMap, ParaboloidAndEllipsoidHaveTheirPrincipalRadii) {
  // Conic of revolution with conic constant k: at distance s from the axis (R^2 - k s^2)^(3/2) / R^2 in the
  // meridian and (R^2 - k s^2)^(1/2) across it (Malacara, Optical Shop Testing, appendix).
  for (const double k : {-1.0, -0.4, 0.7}) {
    const double radius = 500;
    const MirrorGlass glass(test::conic_mirror(radius, k, 160, 120, 17, 13), kUp);
    for (const glm::dvec2 xy : {glm::dvec2(0, 0), glm::dvec2(60, 20), glm::dvec2(-70, -50)}) {
      const auto point = glass.at(xy);
      ASSERT_TRUE(point);
      const double s2 = glm::dot(xy, xy), across = std::sqrt(radius * radius - k * s2);
      const double meridian = across * across * across / (radius * radius);
      EXPECT_NEAR(radius_of_mm(point->curvatures.k1), std::min(meridian, across), 1e-9 * radius);
      EXPECT_NEAR(radius_of_mm(point->curvatures.k2), std::max(meridian, across), 1e-9 * radius);
    }
    const RadiusMap map = map_radii(glass);
    const double corner = std::sqrt(radius * radius - k * (80 * 80 + 60 * 60));
    const double extreme = corner * corner * corner / (radius * radius);
    EXPECT_NEAR(k < 0 ? map.max_mm : map.min_mm, extreme, 1e-9 * radius);
    EXPECT_NEAR(k < 0 ? map.min_mm : map.max_mm, radius, 1);  // the pole lies between points of the map
  }
}

TEST(Spherometer, SphereReadsItsRadiusByBothProcedures) {
  for (const double radius : {1200.0, 300.0, -800.0})
    for (const double base : {38.0, 20.0}) {
      const MirrorGlass glass(test::conic_mirror(radius, 0, 170, 110, 21, 15), kUp);
      const RadiusReadings three = readings_r46(glass, base), ten = readings_fmvss(glass, base);
      EXPECT_EQ(three.readings.size(), 3u);
      EXPECT_EQ(ten.readings.size(), 10u);
      EXPECT_FALSE(three.along_upright) << "the level arc is the longer one";
      for (const RadiusReadings* readings : {&three, &ten}) {
        EXPECT_NEAR(readings->mean_mm / radius, 1, 1e-3);  // what the rules need
        EXPECT_NEAR(readings->mean_mm / radius, 1, 1e-9);  // what three points on a circle give
        EXPECT_LT(readings->worst_deviation, 1e-9);
        EXPECT_LT(readings->worst_difference, 1e-9);
        EXPECT_EQ(readings->base_mm, base);
      }
    }
}

TEST(Spherometer, CylinderReadsPlaneAlongItsAxisAndItsRadiusAcross) {
  const MirrorGlass glass(
      test::rectangular_mirror(std::make_shared<test::TwoCurvatureSurface>(1.0 / 600, 0, 0, 90, 60), 180, 120,
                               13, 9),
      kUp);
  const auto center = *glass.at({0, 0});
  EXPECT_FALSE(std::isfinite(*spherometer_radius_mm(glass, center, {0, 1, 0}, 38)));
  // A parabola z = -x^2 / 1200: c = 19, h = 19^2 / 1200.
  const double h = 19.0 * 19 / 1200;
  EXPECT_NEAR(*spherometer_radius_mm(glass, center, {1, 0, 0}, 38), (19 * 19 + h * h) / (2 * h), 1e-6);
}

TEST(Spherometer, PlaneHasNoRadiusAndAFootOffTheGlassNoReading) {
  const MirrorGlass plane(test::conic_mirror(0, 0, 170, 110, 9, 9), kUp);
  EXPECT_FALSE(std::isfinite(readings_r46(plane, 38).mean_mm));
  EXPECT_EQ(readings_r46(plane, 38).worst_deviation, 0);
  EXPECT_FALSE(spherometer_radius_mm(plane, *plane.at({80, 0}), {1, 0, 0}, 38));
  const MirrorGlass small(test::conic_mirror(400, 0, 40, 30, 9, 9), kUp);
  EXPECT_EQ(readings_r46(small, 38).base_mm, 19) << "halved until the feet fit";
  const MirrorGlass tiny(test::conic_mirror(400, 0, 2, 1.5, 5, 5), kUp);
  EXPECT_THROW((void)readings_r46(tiny, 38), Error);
}

TEST(MirrorGlass, FrameIsUprightOnATurnedGlassAndFlipTurnsItsSigns) {
  Optic mirror = test::conic_mirror(1200, 0, 170, 110, 9, 9);
  const MirrorGlass glass(mirror, {0.2, 1, 0.3});
  EXPECT_NEAR(glm::dot(glass.frame().across, glm::dvec3(0.2, 1, 0.3)), 0, 1e-12);
  EXPECT_GT(glass.frame().upward.y, 0.9);
  EXPECT_NEAR(glm::distance(glass.frame().center_mm, glm::dvec3(0)), 0, 1e-6);
  mirror.flip = true;
  const MirrorGlass other(mirror, kUp);
  EXPECT_NEAR(radius_of_mm(other.at({10, 10})->curvatures.k1), -1200, 1e-6);
  EXPECT_FALSE(glass.at({88, 0}));
  EXPECT_TRUE(glass.at({80, 0}));  // `up` rolls the frame by 11 degrees: the edge is at 86.7
}

TEST(MirrorOutline, RectanglesAndSegments) {
  const std::vector<std::vector<glm::dvec2>> square{{{-50, -30}, {50, -30}, {50, 30}, {-50, 30}}};
  EXPECT_NEAR(widest_rectangle_mm(square, 40), 100, 1e-6);
  EXPECT_EQ(widest_rectangle_mm(square, 61), 0);
  EXPECT_NEAR(longest_upright_mm(square), 60, 1e-6);
  EXPECT_NEAR(distance_inside_mm(square, {45, 0}), 5, 1e-12);
  EXPECT_NEAR(distance_inside_mm(square, {53, 34}), -5, 1e-12);
  std::vector<glm::dvec2> circle;
  for (int i = 0; i < 720; ++i) {
    const double angle = glm::radians(i / 2.0);
    circle.push_back(39.0 * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  const std::vector<std::vector<glm::dvec2>> disc{circle};
  EXPECT_NEAR(widest_rectangle_mm(disc, 40), 2 * std::sqrt(39.0 * 39 - 20 * 20), 0.1);
  EXPECT_NEAR(longest_upright_mm(disc), 78, 0.1);
}

}  // namespace
}  // namespace catoptra::optics
