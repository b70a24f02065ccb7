// Quadrics: curvatures, principal directions and normals against closed forms, poles included.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "cad_import/src/turned_surface.h"

namespace catoptra::cad_import {
namespace {

constexpr double kPi = std::numbers::pi;
const ParameterDomain kSphereDomain{0, 2 * kPi, -kPi / 2, kPi / 2, 2 * kPi, 0};

TurnedSurface turned(SurfaceKind kind, double radius, double minor_radius = 0, double half_angle_rad = 0) {
  return {{kind, radius, minor_radius, half_angle_rad}, {}, kSphereDomain, 1};
}

TEST(Quadric, PlaneIsFlatAndItsNormalIsXCrossY) {
  const PlaneSurface plane({{1, 2, 3}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, {-5, 5, -5, 5, 0, 0}, 1);
  EXPECT_EQ(plane.unit_normal(2, 1), glm::dvec3(1, 0, 0));
  EXPECT_EQ(plane.principal_curvatures(2, 1).k1, 0);
  EXPECT_EQ(plane.principal_curvatures(2, 1).k2, 0);
}

TEST(Quadric, SphereHasOneOverRAndPositiveAsSeenFromOutside) {
  const auto sphere = turned(SurfaceKind::sphere, 1200);
  for (const double v : {-1.2, -0.3, 0.0, 0.9})
    for (const double u : {0.0, 1.0, 4.0}) {
      const PrincipalCurvatures k = sphere.principal_curvatures(u, v);
      EXPECT_NEAR(k.k1 * 1200, 1, 1e-12);
      EXPECT_NEAR(k.k2 * 1200, 1, 1e-12);
      EXPECT_LT(glm::length(sphere.unit_normal(u, v) - sphere.point(u, v) / 1200.0), 1e-14);
    }
}

TEST(Quadric, TurnedRoundASphereIsConcave) {
  const TurnedSurface bowl({SurfaceKind::sphere, 300, 0, 0}, {}, kSphereDomain, -1);
  EXPECT_NEAR(bowl.principal_curvatures(1, 0.3).k1 * 300, -1, 1e-12);
  EXPECT_LT(glm::length(bowl.unit_normal(1, 0.3) + bowl.point(1, 0.3) / 300.0), 1e-14);
}

TEST(Quadric, PoleOfASphereHasANormalAndCurvatures) {
  const auto sphere = turned(SurfaceKind::sphere, 50);
  for (const double u : {0.0, 2.0, 5.0}) {
    EXPECT_LT(glm::length(sphere.unit_normal(u, kPi / 2) - glm::dvec3(0, 0, 1)), 1e-12);
    EXPECT_LT(glm::length(sphere.unit_normal(u, -kPi / 2) - glm::dvec3(0, 0, -1)), 1e-12);
    EXPECT_NEAR(sphere.principal_curvatures(u, kPi / 2).k1 * 50, 1, 1e-10);
  }
}

TEST(Quadric, CylinderBendsAcrossItsAxisOnly) {
  const PrincipalCurvatures k = turned(SurfaceKind::cylinder, 80).principal_curvatures(0.7, 12);
  EXPECT_NEAR(k.k1 * 80, 1, 1e-12);
  EXPECT_NEAR(k.k2, 0, 1e-15);
  EXPECT_NEAR(std::abs(k.direction2.z), 1, 1e-14);
}

// Cone of half angle a: 0 along the ruling and cos(a) / (distance from the axis) across it.
TEST(Quadric, ConeHasTheCurvatureOfMeusnier) {
  const double a = 0.4, v = 3;
  const PrincipalCurvatures k = turned(SurfaceKind::cone, 20, 0, a).principal_curvatures(0.3, v);
  EXPECT_NEAR(k.k1, std::cos(a) / (20 + v * std::sin(a)), 1e-14);
  EXPECT_NEAR(k.k2, 0, 1e-15);
}

// Torus: 1/r along the tube and cos(v) / (R + r cos v) around the axis. Source: do Carmo, 3-3, example 1.
TEST(Quadric, TorusHasBothSignsOfCurvature) {
  const double big = 30, small = 8;
  const auto torus = turned(SurfaceKind::torus, big, small);
  for (const double v : {0.0, 0.8, 2.0, kPi}) {
    const PrincipalCurvatures k = torus.principal_curvatures(1.1, v);
    EXPECT_NEAR(k.k1, 1 / small, 1e-14);
    EXPECT_NEAR(k.k2, std::cos(v) / (big + small * std::cos(v)), 1e-14);
    const glm::dvec3 cross = glm::cross(torus.unit_normal(1.1, v), k.direction1);
    EXPECT_LT(glm::length(cross - k.direction2), 1e-14);
  }
}

}  // namespace
}  // namespace catoptra::cad_import
