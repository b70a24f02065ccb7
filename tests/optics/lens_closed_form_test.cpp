// Paths through lenses against closed forms and published designs.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <memory>

#include "optics/lens_path.h"
#include "optics/refraction.h"
#include "tests/support/analytic_lens.h"

namespace catoptra::optics {
namespace {

/// A spectacle lens for distance. Powers in dioptre, lengths in mm.
struct Design {
  const char* name;
  double front_d, back_d, thickness_mm;
  double back_vertex_power_d;
  double object_angle_deg[3];  ///< from the axis, for gaze angles of 15, 30 and 40 degrees
};

// n = 1.5, rotation centre of the eye 27 mm behind the back vertex. Object angles to 1e-5 degree, traced
// elsewhere in double precision.
constexpr Design kDesigns[] = {{"G1", 6, -10, 2, -3.9516, {16.50120, 33.20467, 44.55037}},
                               {"G2", 10, -5.5, 6, 4.9167, {12.45187, 24.69377, 32.65836}}};
constexpr double kRotationCentre_mm = 27, kIndex = 1.5;
constexpr LensIndices kGlass{kIndex, 1};

Optic lens_of(const Design& d) {
  return test::spherical_lens(1000 * (kIndex - 1) / d.front_d, -1000 * (kIndex - 1) / d.back_d,
                              d.thickness_mm, 60, 41);
}

TEST(LensDesign, ObjectAnglesOfARotatingEye) {
  for (const Design& design : kDesigns) {
    const Optic lens = lens_of(design);
    const LensTracer tracer(lens);
    const glm::dvec3 centre(0, 0, -design.thickness_mm - kRotationCentre_mm);
    for (int k = 0; k < 3; ++k) {
      const double gaze = glm::radians(k == 0 ? 15.0 : k == 1 ? 30.0 : 40.0);
      for (const double meridian : {0.0, 0.7, 2.5, 4.0}) {
        const glm::dvec3 d{std::sin(gaze) * std::cos(meridian), std::sin(gaze) * std::sin(meridian),
                           std::cos(gaze)};
        const LensPath path = tracer.trace({centre, d}, LensSide::back, kGlass);
        ASSERT_EQ(path.end, LensPathEnd::passed) << design.name;
        const double angle = std::atan2(std::hypot(path.outside.x, path.outside.y), path.outside.z);
        EXPECT_NEAR(glm::degrees(angle), design.object_angle_deg[k], 1e-5) << design.name;  // deg
      }
    }
  }
}

// Light from afar near the axis meets behind the back vertex at 1 / F'v.
TEST(LensDesign, BackVertexPower) {
  for (const Design& design : kDesigns) {
    const Optic lens = lens_of(design);
    const LensPath path = LensTracer(lens).trace({{0.01, 0, 100}, {0, 0, -1}}, LensSide::front, kGlass);
    ASSERT_EQ(path.end, LensPathEnd::passed);
    const double beyond_exit = path.exit.position_mm.x * path.outside.z / path.outside.x;  // signed, mm
    const double focus_z = path.exit.position_mm.z - beyond_exit;
    EXPECT_NEAR(-1000 / (focus_z + design.thickness_mm), design.back_vertex_power_d, 1e-4) << design.name;
  }
}

// A plane through (0, 0, -thickness), turned by `angle` about y, facing -z: with a plane front, a prism.
class TiltedBack : public cad_import::ExactSurface {
 public:
  TiltedBack(double angle_rad, double thickness_mm) : slope_(std::tan(angle_rad)), z_(-thickness_mm) {}
  cad_import::SurfaceKind kind() const override { return cad_import::SurfaceKind::plane; }
  cad_import::ParameterDomain domain() const override { return {-20, 20, -20, 20, 0, 0}; }
  double orientation() const override { return -1; }
  glm::dvec3 point(double u, double v) const override { return {u, v, z_ + slope_ * u}; }
  cad_import::SurfaceFrame d1(double u, double v) const override {
    return {point(u, v), {1, 0, slope_}, {0, 1, 0}};
  }
  cad_import::SurfaceDerivatives d2(double u, double v) const override {
    return {point(u, v), {1, 0, slope_}, {0, 1, 0}, {}, {}, {}};
  }

 private:
  double slope_, z_;
};

Optic prism_of(double apex_rad) {
  Optic prism = test::spherical_lens(0, 0, 20, 40, 2);
  auto back = test::rectangular_mirror(std::make_shared<TiltedBack>(apex_rad, 20), 40, 40, 2, 2);
  for (auto& triangle : back.mesh.triangles) {
    std::swap(triangle.vertices[1], triangle.vertices[2]);
    std::swap(triangle.uv[1], triangle.uv[2]);
  }
  prism.back = {std::move(back.faces), std::move(back.mesh)};
  return prism;
}

// The ray whose angle of incidence on the front is `incidence`, positive where it comes from the base.
Ray prism_ray(double incidence) {
  const glm::dvec3 d{std::sin(incidence), 0, -std::cos(incidence)};
  return {-40.0 * d, d};
}

// Deviation i + asin(sin A sqrt(n^2 - sin^2 i) - cos A sin i) - A. Source: Hecht 2017, 5.5.1.
TEST(LensPath, PrismDeviation) {
  const double apex = glm::radians(25.0);
  const Optic prism = prism_of(apex);
  const LensTracer tracer(prism);
  for (const double n : {1.5, 1.7})
    for (const double degrees : {-8.0, 0.0, 10.0, 25.0, 50.0}) {
      const double i = glm::radians(degrees);
      const LensPath path = tracer.trace(prism_ray(i), LensSide::front, {n, 1});
      ASSERT_EQ(path.end, LensPathEnd::passed) << degrees;
      const double deviation = i +
                               std::asin(std::sin(apex) * std::sqrt(n * n - std::sin(i) * std::sin(i)) -
                                         std::cos(apex) * std::sin(i)) -
                               apex;
      const glm::dvec3 in = prism_ray(i).direction;
      const double found = std::atan2(glm::length(glm::cross(in, path.outside)), glm::dot(in, path.outside));
      EXPECT_NEAR(found, std::abs(deviation), 1e-13) << degrees;  // rad
    }
}

// The incidence at which a prism stops letting light through, by bisection: inside it is then the critical
// angle asin(1 / n).
TEST(LensPath, TotalReflectionStartsAtTheCriticalAngle) {
  const double apex = glm::radians(30.0);
  const Optic prism = prism_of(apex);
  const LensTracer tracer(prism);
  for (const double n : {1.5, 1.586, 1.74}) {
    double passes = glm::radians(50.0), stops = glm::radians(-30.0);
    while (passes - stops > 1e-9) {
      const double middle = 0.5 * (passes + stops);
      const LensPath path = tracer.trace(prism_ray(middle), LensSide::front, {n, 1});
      ASSERT_TRUE(path.end == LensPathEnd::passed || path.end == LensPathEnd::total_reflection);
      (path.end == LensPathEnd::passed ? passes : stops) = middle;
    }
    const double at_exit = apex - std::asin(std::sin(passes) / n);
    EXPECT_NEAR(glm::degrees(at_exit), glm::degrees(*critical_angle(n, 1)), 1e-6);  // deg
    EXPECT_NEAR(at_exit, std::asin(1 / n), glm::radians(0.01));
  }
}

// In a medium of its own index a lens does nothing; in a denser one a converging lens diverges.
TEST(LensPath, TheMediumAroundCounts) {
  const Optic lens = test::spherical_lens(60, -60, 8, 40, 21);
  const LensTracer tracer(lens);
  const Ray ray{{5, 3, 50}, glm::normalize(glm::dvec3(0.02, 0, -1))};
  const LensPath same = tracer.trace(ray, LensSide::front, {1.33, 1.33});
  EXPECT_LT(glm::distance(same.outside, ray.direction), 1e-14);
  EXPECT_NEAR(same.transmittance, 1, 1e-14);
  const LensPath bubble = tracer.trace({{5, 0, 50}, {0, 0, -1}}, LensSide::front, {1, 1.33});
  EXPECT_GT(bubble.outside.x, 0);
  EXPECT_LT(tracer.trace({{5, 0, 50}, {0, 0, -1}}, LensSide::front, {1.33, 1}).outside.x, 0);
}

// Straight through the middle, each surface reflects ((n - 1) / (n + 1))^2: 4 % at n = 1.5.
TEST(LensPath, TransmittanceOfTwoSurfaces) {
  const Optic lens = test::spherical_lens(80, 120, 4, 40, 11);
  const LensPath path = LensTracer(lens).trace({{0, 0, 50}, {0, 0, -1}}, LensSide::front, kGlass);
  EXPECT_NEAR(path.transmittance, 0.96 * 0.96, 1e-12);
}

}  // namespace
}  // namespace catoptra::optics
