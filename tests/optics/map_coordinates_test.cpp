#include "optics/map_coordinates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <iostream>
#include <memory>
#include <random>

#include "cad_import/error.h"
#include "tests/support/analytic_optic.h"

namespace catoptra::optics {
namespace {

const cad_import::BoundingBox kBounds{{-9000, -9000, -9000}, {9000, 9000, 9000}};
constexpr MapInterpolation kAll[] = {MapInterpolation::affine, MapInterpolation::homography,
                                     MapInterpolation::fitted};

// Boards at random places before the mirror, so that neighbouring vertices see very different depths, and
// sky.
cad_import::TriangleMesh boards(unsigned seed) {
  std::cout << "seed " << seed << '\n';
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<float> number(-1, 1);
  cad_import::TriangleMesh mesh;
  for (unsigned i = 0; i < 60; ++i) {
    const glm::vec3 centre(2500 * number(engine), 2500 * number(engine), 3500 + 1500 * number(engine));
    for (int k = 0; k < 3; ++k)
      mesh.positions.push_back(centre + 600.0f * glm::vec3(number(engine), number(engine), number(engine)));
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return mesh;
}

std::vector<VertexHit> hits_on(const cad_import::TriangleMesh& mesh, const Optic& optic,
                               const glm::dvec3& eye) {
  RayScene scene;
  scene.add_surroundings(mesh);
  scene.commit();
  return trace_vertices(optic, eye, scene);
}

double angle_arcmin(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 * 60 / 3.14159265358979323846;
}

// The paper's claim: whatever lies between, a vertex shows exactly what its own ray hits.
TEST(MapCoordinates, EveryVertexShowsItsExactHit) {
  for (const double radius : {0.0, 1200.0, 300.0, -3000.0, -600.0})
    for (const MapInterpolation interpolation : kAll) {
      const Optic mirror = test::conic_mirror(radius, 0, 170, 110, 13, 9);
      const glm::dvec3 eye(350, 140, 700);
      const auto hits = hits_on(boards(17), mirror, eye);
      const VirtualView view = make_virtual_view(mirror, hits, kBounds);
      const auto coordinates = map_coordinates(mirror, hits, view, interpolation);
      int on_boards = 0, in_sky = 0;
      for (std::size_t i = 0; i < hits.size(); ++i) {
        ASSERT_GT(coordinates[i].z, 0);
        const Ray ray =
            view.map_ray(coordinates[i].x / coordinates[i].z, coordinates[i].y / coordinates[i].z);
        if (!hits[i].scene_hit) {
          EXPECT_LT(angle_arcmin(ray.direction, hits[i].direction), 1e-6);
          ++in_sky;
        } else if (glm::dot(hits[i].hit_point_mm - view.viewpoint_mm, view.direction) > view.near_mm) {
          EXPECT_LT(glm::length(glm::cross(hits[i].hit_point_mm - ray.origin_mm, ray.direction)),
                    1e-8);  // mm
          ++on_boards;
        }
      }
      EXPECT_GT(on_boards, 5) << radius;
      EXPECT_GT(in_sky, 5) << radius;
    }
}

TEST(MapCoordinates, FourVerticesOfAPlaneAreEnough) {
  const Optic mirror = test::conic_mirror(0, 0, 170, 110, 2, 2);
  const glm::dvec3 eye(350, 140, 700), image(350, 140, -700);
  const auto hits = hits_on(boards(23), mirror, eye);
  const VirtualView view = make_virtual_view(mirror, hits, kBounds);
  for (const MapInterpolation interpolation : {MapInterpolation::homography, MapInterpolation::fitted}) {
    const auto c = map_coordinates(mirror, hits, view, interpolation);
    for (const auto& triangle : mirror.mesh.triangles)
      for (double u = 0.1; u < 1; u += 0.2)
        for (double v = 0.1; u + v < 1; v += 0.2) {
          const auto& [a, b, d] = triangle.vertices;
          const glm::dvec3 h = (1 - u - v) * c[a] + u * c[b] + v * c[d];
          const auto& vertices = mirror.mesh.vertices;
          const glm::dvec3 point = (1 - u - v) * vertices[a].position_mm + u * vertices[b].position_mm +
                                   v * vertices[d].position_mm;
          EXPECT_LT(angle_arcmin(view.map_ray(h.x / h.z, h.y / h.z).direction, point - image), 1e-6);
        }
  }
}

TEST(MapCoordinates, ParallelProjectionShowsHitsAndSky) {
  const Optic mirror = test::conic_mirror(-600, -1, 200, 120, 9, 9);
  const glm::dvec3 focus(0, 0, 300);
  cad_import::TriangleMesh half_wall;  // x < 0 only
  half_wall.positions = {{-9000, -9000, 4000}, {0, -9000, 4000}, {0, 9000, 4000}, {-9000, 9000, 4000}};
  half_wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto hits = hits_on(half_wall, mirror, focus);
  const VirtualView view = make_virtual_view(mirror, hits, kBounds);
  ASSERT_EQ(view.projection, MapProjection::parallel);
  for (const MapInterpolation interpolation : kAll) {
    const auto c = map_coordinates(mirror, hits, view, interpolation);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const Ray ray = view.map_ray(c[i].x / c[i].z, c[i].y / c[i].z);
      EXPECT_LT(glm::length(glm::cross(hits[i].surface_point_mm - ray.origin_mm, ray.direction)),
                1e-6);  // mm
    }
  }
}

TEST(MapCoordinates, HiddenSideGetsTheMiddleAndWildShapesStayPositive) {
  Optic saddle = test::rectangular_mirror(
      std::make_shared<test::TwoCurvatureSurface>(1 / 60.0, -1 / 80.0, 0.4, 50, 50), 100, 100, 15, 15);
  const glm::dvec3 eye(400, 0, 120);
  const auto hits = hits_on(boards(29), saddle, eye);
  const VirtualView view = make_virtual_view(saddle, hits, kBounds);
  for (const MapInterpolation interpolation : kAll) {
    const auto c = map_coordinates(saddle, hits, view, interpolation);
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      EXPECT_TRUE(std::isfinite(c[i].x) && std::isfinite(c[i].y) && c[i].z > 0);
      if (hits[i].faces_eye) continue;
      EXPECT_EQ(c[i], glm::dvec3(0.5, 0.5, 1));
      ++hidden;
    }
    EXPECT_GT(hidden, 0u);
  }
}

// Regression: a plane seen head-on asks for no change of q at all, and the fit chased the rounding of a
// turned mirror until it overflowed.
TEST(MapCoordinates, TurnedPlaneSeenHeadOnHasEqualDenominators) {
  for (int step = 1; step < 40; ++step)
    for (const int side : {2, 7}) {
      Optic mirror = test::conic_mirror(0, 0, 170, 110, side, side);
      const double angle = 0.077 * step;
      const auto turn = [&](const glm::dvec3& v) {
        return glm::dvec3(v.x, std::cos(angle) * v.y - std::sin(angle) * v.z,
                          std::sin(angle) * v.y + std::cos(angle) * v.z);
      };
      for (auto& vertex : mirror.mesh.vertices) {
        vertex.position_mm = turn(vertex.position_mm);
        vertex.normal = turn(vertex.normal);
        vertex.direction1 = turn(vertex.direction1);
      }
      const auto hits = hits_on({}, mirror, turn({0, 0, 800}));
      const auto coordinates = map_coordinates(mirror, hits, make_virtual_view(mirror, hits, kBounds));
      // Head-on all denominators are equal, up to the ratios of 1e-8 that the fit leaves alone.
      for (const glm::dvec3& c : coordinates) ASSERT_NEAR(c.z, 1, 1e-6) << "turned by " << angle << " rad";
    }
}

TEST(MapCoordinates, RefusesHitsOfAnotherOptic) {
  const Optic mirror = test::conic_mirror(1200, 0, 170, 110, 3, 3);
  EXPECT_THROW((void)map_coordinates(mirror, {}, VirtualView{}), Error);
}

}  // namespace
}  // namespace catoptra::optics
