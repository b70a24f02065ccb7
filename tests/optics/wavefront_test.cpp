// Wavefronts against the closed forms of one surface.
#include "optics/wavefront.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "optics/reflection.h"
#include "optics/refraction.h"
#include "tests/support/analytic_optic.h"
#include "tests/support/aspheric_surface.h"

namespace catoptra::optics {
namespace {

double along(const Wavefront& wave, const glm::dvec3& x) {
  return glm::dot(x, wave.curvature * x);
}

double greatest_entry(const glm::dmat3& m) {
  double most = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) most = std::max(most, std::abs(m[i][j]));
  return most;
}

TEST(Wavefront, SphericalWavesKeepTheirCentre) {
  const glm::dvec3 d = glm::normalize(glm::dvec3(0.3, -0.5, -1));
  const Wavefront wave = spherical_wavefront(d, 80);
  EXPECT_LT(glm::length(wave.curvature * d), 1e-17);
  EXPECT_NEAR(along(wave, glm::normalize(glm::cross(d, {1, 0, 0}))), 1.0 / 80, 1e-17);
  for (const double length : {30.0, -50.0, 400.0})
    EXPECT_LT(greatest_entry(transferred(wave, d, length).curvature -
                             spherical_wavefront(d, 80 + length).curvature),
              1e-16);
  // A converging wave comes out of its focus as a diverging one.
  const Wavefront behind = transferred(spherical_wavefront(d, -20), d, 50);
  EXPECT_LT(greatest_entry(behind.curvature - spherical_wavefront(d, 30).curvature), 1e-15);
  EXPECT_EQ(spherical_wavefront(d, INFINITY).curvature, glm::dmat3(0));
}

// Along each principal meridian the radius grows by the length; Q d stays nothing.
TEST(Wavefront, AstigmaticWavesAreTransferredByMeridians) {
  const glm::dvec3 d(0, 0, -1), x = glm::dvec3(0.6, 0.8, 0), y = glm::dvec3(-0.8, 0.6, 0);
  Wavefront wave{0.02 * glm::outerProduct(x, x) - 0.005 * glm::outerProduct(y, y)};
  wave = transferred(wave, d, 25);
  EXPECT_NEAR(along(wave, x), 1 / (1 / 0.02 + 25), 1e-17);
  EXPECT_NEAR(along(wave, y), 1 / (1 / -0.005 + 25), 1e-17);
  EXPECT_NEAR(glm::dot(x, wave.curvature * y), 0, 1e-17);
}

// -12 D fitted at 10 mm does at 14 mm what -12.61 D do (facts: a published worked example).
TEST(Wavefront, VertexCompensation) {
  const glm::dvec3 d(0, 0, -1);
  const Wavefront wave = transferred(spherical_wavefront(d, 1000.0 / 12), d, -4);
  EXPECT_NEAR(-1000 * along(wave, {1, 0, 0}), -12.61, 0.005);
}

// Coddington: n' cos^2 i' / t' - n cos^2 i / t = (n' cos i' - n cos i) / r and n' / s' - n / s = the same,
// for a sphere of radius r and light from a point; t, s positive behind the surface. Source: Kingslake.
TEST(Wavefront, CoddingtonAtASphere) {
  const double radius = 70;
  const test::ConicSurface sphere(1 / radius, 0, 40, 40);
  for (const double n_to : {1.5, 1.74})
    for (const double object_mm : {200.0, 1e9})
      for (const double x : {0.0, 8.0, 25.0}) {
        const auto surface = sphere.d2(x * 0.8, x * 0.6);
        const glm::dvec3 n = sphere.unit_normal(x * 0.8, x * 0.6);
        const glm::dvec3 d(0, 0, -1);  // in the plane of the meridian through (0.8, 0.6)
        const glm::dvec3 out = *refract(d, n, 1 / n_to);
        const Wavefront wave = refracted(spherical_wavefront(d, object_mm), d, out, 1 / n_to, surface);
        EXPECT_LT(glm::length(wave.curvature * out), 1e-16);
        const double cos_in = -glm::dot(n, d), cos_out = -glm::dot(n, out),
                     power = (n_to * cos_out - cos_in) / radius;
        const double sagittal = (power - 1 / object_mm) / n_to;
        const double tangential = (power - cos_in * cos_in / object_mm) / (n_to * cos_out * cos_out);
        const glm::dvec3 s(-0.6, 0.8, 0), t = glm::cross(out, s);
        EXPECT_NEAR(along(wave, s), -sagittal, 1e-15) << x;
        EXPECT_NEAR(along(wave, t), -tangential, 1e-15) << x;
        EXPECT_NEAR(glm::dot(s, wave.curvature * t), 0, 1e-15) << x;
      }
}

// Mirror: 1 / t + 1 / t' = 2 / (r cos i), 1 / s + 1 / s' = 2 cos i / r, concave positive.
TEST(Wavefront, CoddingtonAtAMirror) {
  const double radius = 300;
  const test::ConicSurface bowl(-1 / radius, 0, 40, 40);
  for (const double degrees : {0.0, 20.0, 65.0}) {
    const double i = glm::radians(degrees), object_mm = 450;
    const glm::dvec3 d(std::sin(i), 0, -std::cos(i)), out = reflect(d, {0, 0, 1});
    const Wavefront wave = reflected(spherical_wavefront(d, object_mm), d, out, bowl.d2(0, 0));
    const glm::dvec3 s(0, 1, 0), t = glm::cross(out, s);
    EXPECT_NEAR(along(wave, t), 1 / object_mm - 2 / (radius * std::cos(i)), 1e-16) << degrees;
    EXPECT_NEAR(along(wave, s), 1 / object_mm - 2 * std::cos(i) / radius, 1e-16) << degrees;
  }
}

// A surface's parameters and the sense of its normal are no part of the optics.
TEST(Wavefront, ParametersOfTheSurfaceDoNotMatter) {
  const test::AsphericSurface surface(
      {.c1 = 0.014, .c2 = 0.009, .k1 = -1.2, .angle_rad = 0.6, .a = 3e-7, .sx = 0.05});
  const auto s = surface.d2(7, -4);
  // u = 2 p - q + 0.3 p q + 0.1 p^2, v = -p + 3 q - 0.2 q^2 at p = q = 0, by the chain rule.
  const cad_import::SurfaceDerivatives other{s.point,
                                             2.0 * s.du - s.dv,
                                             3.0 * s.dv - s.du,
                                             4.0 * s.duu - 4.0 * s.duv + s.dvv + 0.2 * s.du,
                                             -2.0 * s.duu + 7.0 * s.duv - 3.0 * s.dvv + 0.3 * s.du,
                                             s.duu - 6.0 * s.duv + 9.0 * s.dvv - 0.4 * s.dv};
  const cad_import::SurfaceDerivatives turned{s.point, s.dv, s.du, s.dvv, s.duv, s.duu};
  const glm::dvec3 d = glm::normalize(glm::dvec3(0.2, 0.1, -1));
  const glm::dvec3 out = *refract(d, surface.unit_normal(7, -4), 1 / 1.6);
  const Wavefront before = spherical_wavefront(d, 500);
  const glm::dmat3 expected = refracted(before, d, out, 1 / 1.6, s).curvature;
  EXPECT_LT(greatest_entry(refracted(before, d, out, 1 / 1.6, other).curvature - expected), 1e-17);
  EXPECT_LT(greatest_entry(refracted(before, d, out, 1 / 1.6, turned).curvature - expected), 1e-17);
}

}  // namespace
}  // namespace catoptra::optics
