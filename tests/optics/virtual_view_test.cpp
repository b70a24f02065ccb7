#include "optics/virtual_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <iostream>
#include <memory>
#include <random>

#include "cad_import/error.h"
#include "optics/view_regions.h"
#include "tests/support/analytic_optic.h"

namespace catoptra::optics {
namespace {

// A wall at z = 5000 mm before the mirrors, which face +z; everything lies within 9 m.
const cad_import::BoundingBox kBounds{{-9000, -9000, -9000}, {9000, 9000, 9000}};

std::vector<VertexHit> hits_on_wall(const Optic& optic, const glm::dvec3& eye) {
  cad_import::TriangleMesh wall;
  wall.positions = {{-9000, -9000, 5000}, {9000, -9000, 5000}, {9000, 9000, 5000}, {-9000, 9000, 5000}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  RayScene scene;
  scene.add_surroundings(wall);
  scene.commit();
  return trace_vertices(optic, eye, scene);
}

VirtualView view_of(const Optic& optic, const glm::dvec3& eye) {
  return make_virtual_view(optic, hits_on_wall(optic, eye), kBounds);
}

void expect_right_handed(const VirtualView& view) {
  EXPECT_LT(glm::distance(glm::cross(view.right, view.up), -view.direction), 1e-12);
  for (const glm::dvec3& axis : {view.right, view.up, view.direction})
    EXPECT_NEAR(glm::length(axis), 1, 1e-12);
}

// Every ray from the optic (or from the near plane, where that is farther on) lies in the volume.
void expect_volume_holds(const VirtualView& view, const std::vector<VertexHit>& hits) {
  for (const VertexHit& hit : hits) {
    if (!hit.faces_eye) continue;
    const double length = hit.scene_hit ? hit.scene_hit.t_mm : 1e5;
    for (double part = 0; part <= 1; part += 0.05) {
      const glm::dvec3 p = hit.surface_point_mm + part * length * hit.direction;
      const double depth = glm::dot(p - view.viewpoint_mm, view.direction);
      if (depth < view.near_mm) {
        EXPECT_TRUE(view.beyond_viewpoint) << "a ray starts before the near plane";
        continue;
      }
      const glm::dvec3 h = view.project_point(p);
      EXPECT_GT(h.x / h.z, 0);
      EXPECT_LT(h.x / h.z, 1);
      EXPECT_GT(h.y / h.z, 0);
      EXPECT_LT(h.y / h.z, 1);
      EXPECT_TRUE(!hit.scene_hit || depth < view.far_mm);
    }
  }
}

// Clip space of the matrices against the map coordinates and depths of the functions.
void expect_matrices_agree(const VirtualView& view) {
  const glm::dmat4 clip_of_world = view.projection_matrix() * view.view_matrix();
  for (const double s : {0.0, 0.3, 1.0})
    for (const double t : {0.0, 0.8, 1.0})
      for (const double part : {0.0, 0.4, 1.0}) {
        const double depth = view.near_mm + part * (view.far_mm - view.near_mm);
        const Ray ray = view.map_ray(s, t);
        const glm::dvec3 start = ray.origin_mm - view.viewpoint_mm;
        const double along =
            (depth - glm::dot(start, view.direction)) / glm::dot(ray.direction, view.direction);
        const glm::dvec3 point = ray.origin_mm + along * ray.direction;
        const glm::dvec4 clip = clip_of_world * glm::dvec4(point, 1);
        EXPECT_NEAR(0.5 + 0.5 * clip.x / clip.w, s, 1e-9);
        EXPECT_NEAR(0.5 + 0.5 * clip.y / clip.w, t, 1e-9);
        const glm::dvec3 h = view.project_point(point);
        EXPECT_NEAR(h.x / h.z, s, 1e-9);
        EXPECT_NEAR(h.y / h.z, t, 1e-9);
        EXPECT_NEAR(clip.w, h.z, 1e-9 * std::max(1.0, h.z));
        const double z = clip.z / clip.w;  // reversed depth: 1 at the near plane, 0 at the far one
        const double near_w = view.projection == MapProjection::parallel ? 1 : depth / view.near_mm;
        const double expected = view.projection == MapProjection::parallel ? 1 - part : (1 - part) / near_w;
        EXPECT_NEAR(z, expected, 1e-9);
      }
}

TEST(FitViewpoint, MinimisesTheDistancesOfRandomLines) {
  std::mt19937_64 engine(5);
  std::cout << "seed 5\n";
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<glm::dvec3> points, directions;
  for (int i = 0; i < 40; ++i) {
    points.push_back(300.0 * glm::dvec3(number(engine), number(engine), number(engine)));
    directions.push_back(glm::normalize(glm::dvec3(number(engine), number(engine), 3 + number(engine))));
  }
  const ViewpointFit fit = fit_viewpoint(points, directions);
  const auto squares = [&](const glm::dvec3& o) {
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec3 away = glm::cross(points[i] - o, directions[i]);
      sum += glm::dot(away, away);
    }
    return sum;
  };
  EXPECT_FALSE(fit.parallel);
  EXPECT_NEAR(fit.residual_mm, std::sqrt(squares(fit.viewpoint_mm) / 40), 1e-9);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 step{0};
    step[axis] = 0.1;
    const double slope = squares(fit.viewpoint_mm + step) - squares(fit.viewpoint_mm - step);
    EXPECT_NEAR(slope, 0, 1e-6);  // mm^2, of sums of about 1e6
  }
}

TEST(FitViewpoint, NarrowBundleFromFarAway) {
  // Rays that spread by 1e-4 rad still have their viewpoint where it is, 1 km away, to 1e-7 of the distance.
  const glm::dvec3 source(123, -456, -1e6);
  std::vector<glm::dvec3> points, directions;
  for (int i = 0; i < 25; ++i) {
    points.emplace_back(100 * (i % 5 - 2), 100 * (i / 5 - 2), 0);
    directions.push_back(glm::normalize(points.back() - source));
  }
  const ViewpointFit fit = fit_viewpoint(points, directions);
  EXPECT_FALSE(fit.parallel);
  EXPECT_LT(glm::distance(fit.viewpoint_mm, source), 0.1);
}

TEST(FitViewpoint, ParallelLinesHaveNone) {
  const glm::dvec3 d = glm::normalize(glm::dvec3(1, 2, 3));
  const std::vector<glm::dvec3> points{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}}, directions{d, d, d};
  EXPECT_TRUE(fit_viewpoint(points, directions).parallel);
  EXPECT_TRUE(fit_viewpoint(std::span(points).first(1), std::span(directions).first(1)).parallel);
  EXPECT_THROW((void)fit_viewpoint({}, {}), Error);
}

TEST(VirtualView, OfAPlaneMirrorIsTheMirroredEye) {
  const Optic mirror = test::conic_mirror(0, 0, 170, 110, 7, 7);
  const VirtualView view = view_of(mirror, {300, -120, 730});
  EXPECT_LT(glm::distance(view.viewpoint_mm, glm::dvec3(300, -120, -730)), 1e-9);  // mm
  EXPECT_LT(view.residual_mm, 1e-9);
  EXPECT_FALSE(view.beyond_viewpoint);
  expect_right_handed(view);
}

// The mirror equation 1/a + 1/b = 2/R, near the axis: spherical aberration of a 4 mm wide mirror is below
// 0.01 mm.
TEST(VirtualView, NearTheAxisOfASphereObeysTheMirrorEquation) {
  const auto check = [](double radius_concave, double eye) {
    const Optic mirror = test::conic_mirror(-radius_concave, 0, 4, 4, 5, 5);
    const VirtualView view = view_of(mirror, {0, 0, eye});
    const double image = 1 / (2 / radius_concave - 1 / eye);  // > 0: before the mirror
    EXPECT_NEAR(view.viewpoint_mm.z, image, 2e-5 * std::abs(image) + 0.01);
    EXPECT_NEAR(std::hypot(view.viewpoint_mm.x, view.viewpoint_mm.y), 0, 1e-6);
    EXPECT_EQ(view.beyond_viewpoint, image > 0);
    EXPECT_NEAR(view.direction.z, 1, 1e-9);
  };
  check(-1200, 800);  // convex: behind the mirror
  check(-300, 500);
  check(1200, 400);  // concave, eye inside the focal length: behind the mirror, as for convex
  check(1200, 800);  // concave, eye beyond the focal length: rays converge before the mirror
  check(1200, 1200);
}

// R 600, the eye at 1.5 m: rays cross 375 mm before the mirror.
TEST(VirtualView, ZoomingRegionHasTheMapCoordinatesOfTheReversedOne) {
  const Optic mirror = test::conic_mirror(-600, 0, 80, 80, 9, 9);
  const auto hits = hits_on_wall(mirror, {20, 0, 1500});
  const VirtualView view = make_virtual_view(mirror, hits, kBounds);
  ASSERT_TRUE(view.zooms());
  EXPECT_GT(view.zooming_far_mm, 375);
  EXPECT_LT(view.zooming_near_mm, 100);
  const glm::dmat4 clip = view.zooming_projection_matrix() * view.zooming_view_matrix();
  for (const double part : {0.0, 0.3, 1.0})
    for (const double s : {0.1, 0.8}) {
      const double t = 0.7, back = view.zooming_near_mm + part * (view.zooming_far_mm - view.zooming_near_mm);
      const glm::dvec3 ray = view.map_ray(s, t).direction;
      const glm::dvec3 point = view.viewpoint_mm - back / glm::dot(ray, view.direction) * ray;
      const glm::dvec3 h = view.project_point(point);
      EXPECT_NEAR(h.x / h.z, s, 1e-9);
      const glm::dvec4 c = clip * glm::dvec4(point, 1);
      EXPECT_NEAR(0.5 + 0.5 * c.x / c.w, s, 1e-9);
      EXPECT_NEAR(0.5 + 0.5 * c.y / c.w, t, 1e-9);
      EXPECT_NEAR(c.w, back, 1e-9);
      if (part == 0 || part == 1) {
        EXPECT_NEAR(c.z / c.w, 1 - part, 1e-9);
      }
    }
  for (const VertexHit& hit : hits)
    for (const double part : {0.0, 0.5, 1.0}) {
      const double along = glm::dot(hit.direction, view.direction),
                   depth = glm::dot(hit.surface_point_mm - view.viewpoint_mm, view.direction);
      const glm::dvec3 p =
          hit.surface_point_mm + part * (-view.zooming_near_mm - depth) / along * hit.direction;
      const glm::dvec4 c = clip * glm::dvec4(p, 1);
      EXPECT_LE(std::max(std::abs(c.x), std::abs(c.y)), c.w * (1 + 1e-9));
    }
}

TEST(VirtualView, RegionsOfWhatVerticesMeet) {
  const auto at = [](const Optic& mirror, const glm::dvec3& eye, double distance) {
    auto hits = reflect_vertices(mirror, eye);
    for (VertexHit& hit : hits) {
      hit.scene_hit.object = 0;
      hit.scene_hit.t_mm = distance;
      hit.hit_point_mm = hit.surface_point_mm + distance * hit.direction;
    }
    return view_regions(hits, make_virtual_view(mirror, hits, kBounds));
  };
  const Optic sphere = test::conic_mirror(-600, 0, 80, 80, 9, 9);
  EXPECT_EQ(at(sphere, {0, 0, 1500}, 200).zooming, 81u);
  EXPECT_EQ(at(sphere, {0, 0, 1500}, 2000).zooming, 0u);
  EXPECT_EQ(at(sphere, {0, 0, 1500}, 2000).crossed_once, 0u);
  EXPECT_EQ(at(sphere, {0, 0, 1500}, 375.3).close, 81u);
  // 40 degrees off, f / cos and f cos: line foci at 258 and 526 mm (Coddington, 1 / s' = 2 / (R cos) - 1 /
  // s).
  const glm::dvec3 aside = 1500.0 * glm::dvec3(std::sin(0.7), 0, std::cos(0.7));
  EXPECT_EQ(at(sphere, aside, 200).crossed_once, 0u);
  EXPECT_EQ(at(sphere, aside, 380).crossed_once, 81u);
  EXPECT_EQ(at(sphere, aside, 800).crossed_once, 0u);
  const Optic saddle = test::rectangular_mirror(
      std::make_shared<test::TwoCurvatureSurface>(1 / 400.0, -1 / 400.0, 0, 60, 60), 120, 120, 5, 5);
  EXPECT_EQ(at(saddle, {0, 0, 800}, 100).crossed_once, 0u);
  EXPECT_EQ(at(saddle, {0, 0, 800}, 3000).crossed_once, 25u);
}

TEST(VirtualView, EyeAtTheFocusOfAParaboloidFallsBackToParallel) {
  const Optic mirror = test::conic_mirror(-600, -1, 200, 120, 9, 9);
  const glm::dvec3 focus(0, 0, 300);
  const auto hits = hits_on_wall(mirror, focus);
  const VirtualView view = make_virtual_view(mirror, hits, kBounds);
  EXPECT_EQ(view.projection, MapProjection::parallel);
  EXPECT_EQ(view.fov_rad, glm::dvec2(0));
  EXPECT_LT(glm::distance(view.direction, glm::dvec3(0, 0, 1)), 1e-9);
  EXPECT_NEAR(view.right_side - view.left, 204, 0.1);  // 200 mm and a border of 1 % on each side
  expect_right_handed(view);
  expect_volume_holds(view, hits);
  expect_matrices_agree(view);
}

TEST(VirtualView, VolumeHoldsAllRaysAndMatricesAgree) {
  for (const double radius : {0.0, 1200.0, 600.0, -3000.0, -1200.0, -500.0})
    for (const glm::dvec3& eye :
         {glm::dvec3(0, 0, 800), glm::dvec3(350, 140, 700), glm::dvec3(-900, 0, 500)}) {
      SCOPED_TRACE(testing::Message() << "R " << radius << ", eye " << eye.x);
      const Optic mirror = test::conic_mirror(radius, 0, 170, 110, 9, 9);
      const auto hits = hits_on_wall(mirror, eye);
      const VirtualView view = make_virtual_view(mirror, hits, kBounds);
      EXPECT_FALSE(view.fov_clamped);
      EXPECT_GT(view.far_mm, view.near_mm);
      expect_right_handed(view);
      expect_volume_holds(view, hits);
      expect_matrices_agree(view);
    }
}

TEST(VirtualView, NearPlaneLiesJustBeforeTheOptic) {
  const Optic mirror = test::conic_mirror(1200, 0, 170, 110, 9, 9);
  const VirtualView view = view_of(mirror, {350, 140, 700});
  double nearest = kInfinity;
  for (const auto& vertex : mirror.mesh.vertices)
    nearest = std::min(nearest, glm::dot(vertex.position_mm - view.viewpoint_mm, view.direction));
  EXPECT_LT(view.near_mm, nearest);
  EXPECT_GT(view.near_mm, 0.98 * nearest);
}

TEST(VirtualView, UpFollowsTheLeastCurvatureOfCylindersAndSaddles) {
  for (const double k2 : {0.0, -1 / 900.0})
    for (const double degrees : {0.0, 25.0, 70.0, -40.0}) {
      const double angle = glm::radians(degrees);
      const Optic mirror = test::rectangular_mirror(
          std::make_shared<test::TwoCurvatureSurface>(1 / 400.0, k2, angle, 60, 60), 120, 120, 9, 9);
      const VirtualView view = view_of(mirror, {0, 0, 3000});
      const glm::dvec3 least(-std::sin(angle), std::cos(angle), 0);
      EXPECT_GT(std::abs(glm::dot(view.up, least)), std::cos(glm::radians(0.5)))
          << degrees << " deg, k2 " << k2;
      EXPECT_GT(view.fov_rad.x, view.fov_rad.y);
    }
}

TEST(VirtualView, WidestVolumeIsClampedAndSaysSo) {
  const Optic ball = test::conic_mirror(60, 0, 80, 80, 21, 21);
  const VirtualView view = view_of(ball, {0, 0, 500});
  EXPECT_TRUE(view.fov_clamped);
  EXPECT_LT(view.fov_rad.x, glm::radians(152.0));  // 150 degrees and the border
  EXPECT_GT(view.fov_rad.x, glm::radians(140.0));
}

TEST(VirtualView, NeedsAVertexThatFacesTheEye) {
  const Optic mirror = test::conic_mirror(1200, 0, 170, 110, 3, 3);
  const auto hits = hits_on_wall(mirror, {0, 0, -800});
  EXPECT_THROW((void)make_virtual_view(mirror, hits, kBounds), Error);
  EXPECT_THROW((void)make_virtual_view(mirror, {}, kBounds), Error);
}

TEST(VirtualView, WithoutSurroundingsStillHasAVolume) {
  const Optic mirror = test::conic_mirror(1200, 0, 170, 110, 3, 3);
  const VirtualView view = make_virtual_view(mirror, hits_on_wall(mirror, {0, 0, 800}), {});
  EXPECT_GT(view.far_mm, view.near_mm);
  expect_matrices_agree(view);
}

TEST(VirtualView, DirectionsProjectToWhereTheyComeFrom) {
  const Optic mirror = test::conic_mirror(1200, 0, 170, 110, 5, 5);
  const VirtualView view = view_of(mirror, {350, 140, 700});
  const Ray ray = view.map_ray(0.2, 0.9);
  const glm::dvec3 h = view.project_direction(ray.direction);
  EXPECT_NEAR(h.x / h.z, 0.2, 1e-12);
  EXPECT_NEAR(h.y / h.z, 0.9, 1e-12);
  EXPECT_NEAR(glm::dot(ray.t_min_mm * ray.direction, view.direction), view.near_mm, 1e-9);
}

}  // namespace
}  // namespace catoptra::optics
