#include "optics/reflection.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "tests/support/analytic_optic.h"

namespace catoptra::optics {
namespace {

TEST(Reflect, MirrorsTheNormalComponent) {
  const glm::dvec3 d = glm::normalize(glm::dvec3(1, 2, -3)), n(0, 0, 1);
  const glm::dvec3 r = reflect(d, n);
  EXPECT_NEAR(r.x, d.x, 1e-15);
  EXPECT_NEAR(r.y, d.y, 1e-15);
  EXPECT_NEAR(r.z, -d.z, 1e-15);
}

// Values derived independently by finite differences of traced rays, to 1e-6: eye distance, radius,
// incidence.
TEST(MirrorMagnification, ConvexMirrorGoldens) {
  const auto check = [](double a, double r, double b_deg, double mt, double ms) {
    const auto m = mirror_magnification(a, r, glm::radians(b_deg));
    EXPECT_NEAR(m.tangential, mt, 1e-6);
    EXPECT_NEAR(m.sagittal, ms, 1e-6);
  };
  check(840, 1260, 35, 0.380561, 0.477965);
  check(750, 1200, 30, 0.409270, 0.480185);
  check(1450, 1400, 60, 0.194444, 0.491228);
}

TEST(PrincipalCurvatures, OfASphereAreOneOverItsRadius) {
  const test::ConicSurface sphere(1 / 1200.0, 0, 85, 55);
  const auto k = sphere.principal_curvatures(40, -20);
  EXPECT_NEAR(k.k1, 1 / 1200.0, 1e-15);
  EXPECT_NEAR(k.k2, 1 / 1200.0, 1e-15);
}

}  // namespace
}  // namespace catoptra::optics
