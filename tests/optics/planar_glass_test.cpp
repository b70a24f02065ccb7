// Plates, fog and the plane of a face.
#include "optics/planar_glass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "optics/refraction.h"
#include "tests/support/analytic_optic.h"

namespace catoptra::optics {
namespace {

TEST(PlateReflectance, IsTheSumOfTheInternalReflections) {
  for (const double r : {0.0, 0.04, 0.3, 0.99}) {
    double sum = r, inside = (1 - r) * (1 - r) * r;  // reflected at once; in, back at the second border, out
    for (int k = 0; k < 20000; ++k, inside *= r * r) sum += inside;
    EXPECT_NEAR(plate_reflectance(r), sum, 1e-12) << r;
  }
  EXPECT_EQ(plate_reflectance(1), 1);
}

// Through both borders by Snell's law, and back along the outgoing ray to the first border's plane.
TEST(PlateShift, IsThatOfSnellAtTwoBorders) {
  constexpr double kThickness = 8;
  for (const double ior : {1.0, 1.33, 1.5, 2.4})
    for (int degrees = 0; degrees < 90; degrees += 7) {
      const double a = degrees * 3.14159265358979 / 180;
      const glm::dvec3 n(0, 0, 1), d(0.6 * std::sin(a), 0.8 * std::sin(a), -std::cos(a));
      const glm::dvec3 inside = *refract(d, n, 1 / ior);
      const glm::dvec3 leaves = kThickness / -inside.z * inside;
      const glm::dvec3 wanted = leaves - leaves.z / d.z * d;
      EXPECT_LT(glm::length(plate_shift(d, n, ior, kThickness) - wanted), 1e-12 / std::cos(a)) << degrees;
      EXPECT_EQ(plate_shift(d, n, ior, kThickness), plate_shift(d, -n, ior, kThickness));
      // Across the ray: t sin a (1 - cos a / (n cos b)).
      const double cos_b = std::sqrt(1 - std::pow(std::sin(a) / ior, 2));
      EXPECT_NEAR(glm::length(glm::cross(wanted, d)),
                  kThickness * std::sin(a) * (1 - std::cos(a) / (ior * cos_b)), 1e-12);
    }
}

TEST(FogShare, FallsByTheSameFactorOverEveryMetre) {
  EXPECT_EQ(fog_share(0, std::numeric_limits<double>::infinity()), 0);
  EXPECT_EQ(fog_share(0.3, std::numeric_limits<double>::infinity()), 1);
  EXPECT_NEAR(fog_share(0.3, 1000), 0.3, 1e-15);
  EXPECT_NEAR(fog_share(0.3, 2500), 1 - std::pow(0.7, 2.5), 1e-15);
  EXPECT_EQ(fog_share(1, 1e-9), 1);
}

TEST(PlanarFace, HasCentreNormalAndFirstEdge) {
  Optic optic = test::conic_mirror(0, 0, 200, 100, 3, 4);
  for (auto& vertex : optic.mesh.vertices) vertex.position_mm += glm::dvec3(1e4, 5, -3);
  optic.material.first_edge = {0, 1, 0};
  const PlanarFace face = planar_face(optic);
  EXPECT_LT(glm::length(face.centre_mm - glm::dvec3(1e4, 5, -3)), 1e-9);
  EXPECT_EQ(face.normal, glm::dvec3(0, 0, 1));
  EXPECT_EQ(face.along, glm::dvec3(0, 1, 0));
  EXPECT_EQ(face.across, glm::dvec3(-1, 0, 0));
  const glm::dvec3 tilted = tilted_normal(face, {0.1, 0});
  EXPECT_NEAR(std::atan2(tilted.y, tilted.z), 0.1, 1e-15);
}

}  // namespace
}  // namespace catoptra::optics
