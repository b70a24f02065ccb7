#include "optics/exact_hit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <memory>

#include "optics/ray_scene.h"
#include "optics/reflection.h"
#include "tests/support/analytic_optic.h"

namespace catoptra::optics {
namespace {

// A mirror in a ray scene, asked for exact hits as the ray tracer asks: mesh first, then Newton.
class TracedMirror {
 public:
  explicit TracedMirror(Optic optic) : optic_(std::move(optic)) {
    scene_.add_optic(optic_.mesh);
    scene_.commit();
  }
  std::optional<ExactHit> hit(const Ray& ray) const { return exact_hit(optic_, ray, scene_.intersect(ray)); }
  const Optic& optic() const { return optic_; }

 private:
  Optic optic_;
  RayScene scene_;
};

double distance_of_line(const glm::dvec3& point, const glm::dvec3& on_line, const glm::dvec3& direction) {
  return glm::length(glm::cross(point - on_line, direction));
}

TEST(ExactHit, PlaneIsMetWhereTheClosedFormSays) {
  const TracedMirror mirror(test::conic_mirror(0, 0, 170, 110, 2, 2));
  const glm::dvec3 eye(200, -100, 750);
  for (double x = -84; x <= 84; x += 12) {
    const glm::dvec3 target(x, 0.5 * x, 0);
    const Ray ray{eye, glm::normalize(target - eye)};
    const auto hit = mirror.hit(ray);
    ASSERT_TRUE(hit);
    EXPECT_LT(glm::distance(hit->position_mm, target), 1e-9);  // mm
    const glm::dvec3 image(eye.x, eye.y, -eye.z);              // reflected rays come from the mirrored eye
    EXPECT_LT(distance_of_line(image, hit->position_mm, reflect(ray.direction, hit->normal)), 1e-9);
  }
}

TEST(ExactHit, SphereIsMetWhereTheQuadraticSays) {
  for (const double radius : {1200.0, 300.0, -1200.0, -300.0}) {
    const TracedMirror mirror(test::conic_mirror(radius, 0, 170, 110, 7, 7));
    const glm::dvec3 eye(350, 120, 720), centre(0, 0, -radius);
    int hits = 0;
    for (double x = -80; x <= 80; x += 9.7)
      for (double y = -50; y <= 50; y += 9.7) {
        const Ray ray{eye,
                      glm::normalize(glm::dvec3(x, y, mirror.optic().faces[0].surface->point(x, y).z) - eye)};
        const auto hit = mirror.hit(ray);
        ASSERT_TRUE(hit) << "R " << radius << " at " << x << ", " << y;
        const double b = glm::dot(ray.direction, eye - centre);
        const double root = std::sqrt(b * b - glm::dot(eye - centre, eye - centre) + radius * radius);
        const double t = radius > 0 ? -b - root : -b + root;
        EXPECT_NEAR(hit->t_mm, t, 1e-9);
        EXPECT_LT(glm::distance(hit->normal, (hit->position_mm - centre) / radius), 1e-12);
        EXPECT_LE(hit->iterations, 5);
        ++hits;
      }
    EXPECT_GT(hits, 100);
  }
}

TEST(ExactHit, ParaboloidSendsAxialRaysThroughItsFocus) {
  const double radius = 600;  // at the apex; the focus is at half of it
  const TracedMirror mirror(test::conic_mirror(-radius, -1, 400, 400, 17, 17));
  const glm::dvec3 focus(0, 0, radius / 2);
  double worst = 0;
  for (double x = -199; x <= 199; x += 13.3)
    for (double y = -199; y <= 199; y += 13.3) {
      const Ray ray{{x, y, 1000}, {0, 0, -1}};
      const auto hit = mirror.hit(ray);
      ASSERT_TRUE(hit);
      worst = std::max(worst, distance_of_line(focus, hit->position_mm, reflect(ray.direction, hit->normal)));
    }
  EXPECT_LT(worst, 1e-6);  // mm: the limit asked for; about 1e-13 is reached
}

TEST(ExactHit, ParaboloidMakesRaysFromItsFocusParallel) {
  const TracedMirror mirror(test::conic_mirror(-600, -1, 300, 300, 9, 9));
  for (double x = -140; x <= 140; x += 11.1) {
    const glm::dvec3 focus(0, 0, 300);
    const Ray ray{focus, glm::normalize(mirror.optic().faces[0].surface->point(x, 0.7 * x) - focus)};
    const auto hit = mirror.hit(ray);
    ASSERT_TRUE(hit);
    EXPECT_LT(glm::distance(reflect(ray.direction, hit->normal), glm::dvec3(0, 0, 1)), 1e-12);
  }
}

// Neighbouring eye rays traced through the exact surface; the closed form is in facts about convex mirrors.
TEST(ExactHit, NeighbouringRaysGiveTheMagnificationsOfAConvexMirror) {
  const auto check = [](double eye_mm, double radius_mm, double incidence_deg) {
    const TracedMirror mirror(test::conic_mirror(radius_mm, 0, 40, 40, 9, 9));
    const double b = glm::radians(incidence_deg);
    const glm::dvec3 eye = eye_mm * glm::dvec3(std::sin(b), 0, std::cos(b));
    const glm::dvec3 towards = -glm::normalize(eye), in_plane(std::cos(b), 0, -std::sin(b)), across(0, 1, 0);
    const double step = 1e-4;  // rad; the central difference is then good to 1e-8
    const auto outgoing = [&](const glm::dvec3& d) {
      const Ray ray{eye, glm::normalize(d)};
      return reflect(ray.direction, mirror.hit(ray).value().normal);
    };
    const auto magnification = [&](const glm::dvec3& axis) {
      const glm::dvec3 plus = outgoing(towards + step * axis), minus = outgoing(towards - step * axis);
      return 2 * std::atan(step) / std::atan2(glm::length(glm::cross(plus, minus)), glm::dot(plus, minus));
    };
    const MirrorMagnification expected = mirror_magnification(eye_mm, radius_mm, b);
    EXPECT_NEAR(magnification(in_plane), expected.tangential, 1e-6);
    EXPECT_NEAR(magnification(across), expected.sagittal, 1e-6);
  };
  check(840, 1260, 35);
  check(750, 1200, 30);
  check(1450, 1400, 60);
}

TEST(ExactHit, NulloptBesideTheFaceAndBehindTheRay) {
  const TracedMirror mirror(test::conic_mirror(1200, 0, 100, 100, 5, 5));
  EXPECT_FALSE(mirror.hit({{0, 70, 500}, {0, 0, -1}}));
  const auto& surface = *mirror.optic().faces[0].surface;
  EXPECT_FALSE(newton_hit(surface, {{0, 70, 500}, {0, 0, -1}}, {0, 0}));         // leaves the domain
  EXPECT_FALSE(newton_hit(surface, {{0, 0, 500}, {0, 0, 1}}, {0, 0}));           // behind the origin
  EXPECT_FALSE(newton_hit(surface, {{0, 0, 500}, {0, 0, -1}, 0, 400}, {0, 0}));  // beyond t_max
  EXPECT_FALSE(newton_hit(surface, {{0, 0, 50}, {1, 0, 0}}, {10, 10}));          // never meets
  EXPECT_FALSE(exact_hit(mirror.optic(), {{0, 0, 500}, {0, 0, -1}}, Hit{}));     // no mesh hit
}

// Two faces of one sphere that meet at x = 1: the mesh triangles of the first reach beyond the border.
class SideTrim : public cad_import::FaceTrim {
 public:
  SideTrim(double border, bool left) : border_(border), left_(left) {}
  bool contains(double u, double) const override { return left_ ? u <= border_ : u >= border_; }

 private:
  double border_;
  bool left_;
};

TEST(ExactHit, CrossesToTheNeighbouringFace) {
  Optic optic = test::conic_mirror(1200, 0, 100, 100, 5, 5);
  optic.faces.push_back(optic.faces[0]);
  optic.faces[0].trim = std::make_shared<SideTrim>(1, true);
  optic.faces[1].trim = std::make_shared<SideTrim>(1, false);
  for (auto& triangle : optic.mesh.triangles) {
    const double x = (triangle.uv[0].x + triangle.uv[1].x + triangle.uv[2].x) / 3;
    triangle.face = x < 25 ? 0 : 1;
  }
  const TracedMirror mirror(optic);
  const auto left = mirror.hit({{0.5, 3, 500}, {0, 0, -1}}), right = mirror.hit({{1.5, 3, 500}, {0, 0, -1}});
  ASSERT_TRUE(left && right);
  EXPECT_EQ(left->face, 0);
  EXPECT_EQ(right->face, 1);
  EXPECT_NEAR(right->position_mm.x, 1.5, 1e-9);
}

}  // namespace
}  // namespace catoptra::optics
