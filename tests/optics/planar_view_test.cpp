// Views by way of a plane against exact rays.
#include "optics/planar_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <random>

#include "optics/reflection.h"
#include "optics/refraction.h"

namespace catoptra::optics {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

const Plane kPlane{{30, -20, 0}, {0, 0, 1}};

/// The eye before the plane by `distance_mm`, so that its ray to `at` has that angle of incidence.
glm::dvec3 eye_at(const glm::dvec3& at, double angle_rad, double distance_mm) {
  return at +
         distance_mm * glm::dvec3(std::sin(angle_rad) * 0.6, std::sin(angle_rad) * 0.8, std::cos(angle_rad));
}

TEST(MirroredView, ShowsAPointWhereItsMirrorImageIs) {
  const ProjectiveView view{{100, 50, 400}, glm::dmat3(1, 0.1, 0, -0.2, 2, 0.3, 0.1, 0, -1)};
  const ProjectiveView mirror = mirrored(view, kPlane);
  const glm::dvec3 point(70, -300, 250), image(70, -300, -250);
  EXPECT_LT(glm::distance(mirror.image * (point - mirror.eye_mm), view.image * (image - view.eye_mm)),
            1e-12 * 1e3);
}

TEST(ViewThroughAPlane, KeepsEveryPointOfThePlaneWhereItIs) {
  const ProjectiveView view{{100, 50, 400}, glm::dmat3(1, 0.1, 0, -0.2, 2, 0.3, 0.1, 0, -1)};
  const ProjectiveView other = through(view, kPlane, {-80, 200, 700});
  for (const glm::dvec3& q : {glm::dvec3(0), glm::dvec3(500, 90, 0), glm::dvec3(-100, 80, 0)})
    EXPECT_LT(glm::distance(other.image * (q - other.eye_mm), view.image * (q - view.eye_mm)), 1e-10);
}

class Indices : public ::testing::TestWithParam<double> {};

// At the chosen angle the map's ray is the refracted one, wherever its eye is put on it.
TEST_P(Indices, RefractedViewIsExactAtTheChosenPoint) {
  const double eta = GetParam();
  for (const double degrees : {0.0, 10.0, 35.0, 41.0}) {
    const glm::dvec3 at(120, -40, 0), eye = eye_at(at, degrees * kDegree, 900);
    const auto exact = refract(glm::normalize(at - eye), {0, 0, 1}, eta);
    ASSERT_TRUE(exact);
    for (const RefractedEye place : {RefractedEye::rotated, RefractedEye::sagittal}) {
      const auto seen = refracted_eye(eye, at, kPlane, eta, place);
      ASSERT_TRUE(seen);
      EXPECT_LT(glm::distance(glm::normalize(at - *seen), *exact), 1e-9);
    }
    EXPECT_NEAR(glm::distance(at, *refracted_eye(eye, at, kPlane, eta, RefractedEye::rotated)), 900, 1e-9);
  }
}
INSTANTIATE_TEST_SUITE_P(Ratios, Indices, ::testing::Values(1 / 1.5, 1 / 1.33, 1.0, 1.33, 1.5));

TEST(RefractedView, SwitchesAtSnellsCriticalAngle) {
  for (const double ior : {1.33, 1.5, 2.4}) {
    const double critical = std::asin(1 / ior);
    const glm::dvec3 at(0);
    EXPECT_FALSE(totally_reflected(eye_at(at, critical - 0.01 * kDegree, 500), at, kPlane, ior));
    EXPECT_TRUE(totally_reflected(eye_at(at, critical + 0.01 * kDegree, 500), at, kPlane, ior));
    EXPECT_FALSE(refracted_eye(eye_at(at, critical + 0.01 * kDegree, 500), at, kPlane, ior));
    EXPECT_FALSE(totally_reflected(eye_at(at, 89.9 * kDegree, 500), at, kPlane, 1 / ior));
  }
}

// Snell at both faces of a plate, traced.
TEST(Plate, ShiftsTheEyeAsTwoRefractionsDo) {
  const double thickness = 12, ior = 1.5;
  for (const double degrees : {1.0, 20.0, 50.0, 80.0}) {
    const glm::dvec3 at(0), eye = eye_at(at, degrees * kDegree, 300), d = glm::normalize(at - eye);
    const glm::dvec3 inside = *refract(d, {0, 0, 1}, 1 / ior);
    const glm::dvec3 out = at - thickness / inside.z * inside;
    const glm::dvec3 moved = eye - plate_shift_mm(thickness, ior, -d.z) * glm::dvec3(0, 0, 1);
    EXPECT_LT(glm::length(glm::cross(out - moved, d)), 1e-9) << degrees;
  }
  EXPECT_NEAR(plate_shift_mm(12, 1.5, 1), 4, 1e-12);
}

/// The map by solving its eight equations (Gauss with the largest pivot).
glm::dmat3 solved(const Quad& from, const Quad& to) {
  double m[8][9];
  for (int k = 0; k < 4; ++k) {
    const auto [x, y] = std::pair(from[std::size_t(k)].x, from[std::size_t(k)].y);
    const auto [u, v] = std::pair(to[std::size_t(k)].x, to[std::size_t(k)].y);
    const double row[2][9] = {{x, y, 1, 0, 0, 0, -u * x, -u * y, u}, {0, 0, 0, x, y, 1, -v * x, -v * y, v}};
    for (int r = 0; r < 2; ++r) std::copy(row[r], row[r] + 9, m[2 * k + r]);
  }
  for (int i = 0; i < 8; ++i) {
    int pivot = i;
    for (int r = i; r < 8; ++r)
      if (std::abs(m[r][i]) > std::abs(m[pivot][i])) pivot = r;
    std::swap_ranges(m[i], m[i] + 9, m[pivot]);
    for (int r = 0; r < 8; ++r) {
      if (r == i) continue;
      const double factor = m[r][i] / m[i][i];
      for (int c = i; c < 9; ++c) m[r][c] -= factor * m[i][c];
    }
  }
  const auto h = [&](int i) { return m[i][8] / m[i][i]; };
  return {{h(0), h(3), h(6)}, {h(1), h(4), h(7)}, {h(2), h(5), 1}};
}

TEST(QuadToQuad, IsTheSolutionOfItsEquations) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-0.2, 0.2);
  for (int round = 0; round < 50; ++round) {
    Quad from{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, to{{{2, 1}, {5, 1}, {5, 3}, {2, 3}}};
    for (Quad* quad : {&from, &to})
      for (glm::dvec2& p : *quad) p += glm::dvec2(off(random), off(random));
    const auto map = quad_to_quad(from, to);
    ASSERT_TRUE(map);
    const glm::dmat3 expected = solved(from, to);
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) EXPECT_NEAR((*map)[c][r] / (*map)[2][2], expected[c][r], 1e-9);
  }
}

// The paper's way, quadrilateral to quadrilateral after the refracted camera's projection, and ours, by the
// plane.
TEST(QuadToQuad, OfAFaceInTwoPicturesIsTheViewThroughItsPlane) {
  const ProjectiveView view{{100, 50, 400}, glm::dmat3(1, 0, 0, 0, 1, 0, 0, 0, -1)};
  const glm::dvec3 eye = *refracted_eye(view.eye_mm, {120, -40, 0}, kPlane, 1 / 1.5);
  const ProjectiveView camera{eye, glm::dmat3(1, 0, 0.1, 0, 1, -0.2, 0, 0.05, -1)};
  const auto place = [](const ProjectiveView& v, const glm::dvec3& p) {
    const glm::dvec3 at = v.image * (p - v.eye_mm);
    return glm::dvec2(at.x / at.z, at.y / at.z);
  };
  const std::array<glm::dvec3, 4> corners{glm::dvec3(0), {200, 0, 0}, {200, 150, 0}, {0, 150, 0}};
  Quad from, to;
  for (std::size_t k = 0; k < 4; ++k) from[k] = place(camera, corners[k]), to[k] = place(view, corners[k]);
  const glm::dmat3 map = *quad_to_quad(from, to);
  const ProjectiveView seen = through(view, kPlane, eye);
  for (const glm::dvec3& p : {glm::dvec3(50, 60, -300), glm::dvec3(-400, 90, -2000)}) {
    const glm::dvec3 at = map * glm::dvec3(place(camera, p), 1);
    EXPECT_LT(glm::distance(glm::dvec2(at.x, at.y) / at.z, place(seen, p)), 1e-9);
  }
}

TEST(QuadToQuad, NulloptWhereThreeCornersAreInLine) {
  EXPECT_FALSE(square_to_quad({{{0, 0}, {1, 0}, {2, 0}, {0, 1}}}));
}

}  // namespace
}  // namespace catoptra::optics
