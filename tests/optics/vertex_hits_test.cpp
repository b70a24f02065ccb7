#include "optics/vertex_hits.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "cad_import/error.h"
#include "tests/support/analytic_lens.h"

namespace catoptra::optics {
namespace {

cad_import::TriangleMesh wall_at(double z) {
  cad_import::TriangleMesh wall;
  wall.positions = {{-9000, -9000, z}, {9000, -9000, z}, {9000, 9000, z}, {-9000, 9000, z}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  return wall;
}

TEST(VertexHits, PlanarMirrorMeetsTheWallOnTheLineFromTheMirroredEye) {
  RayScene scene;
  scene.add_surroundings(wall_at(5000));
  scene.commit();
  const Optic mirror = test::conic_mirror(0, 0, 170, 110, 7, 7);
  const glm::dvec3 eye(300, 100, 700), image(300, 100, -700);
  const auto hits = trace_vertices(mirror, eye, scene);
  ASSERT_EQ(hits.size(), 49u);
  for (const VertexHit& hit : hits) {
    ASSERT_TRUE(hit.faces_eye && hit.scene_hit);
    const glm::dvec3 expected = image + (hit.surface_point_mm - image) * (5700.0 / 700.0);
    EXPECT_LT(glm::distance(hit.hit_point_mm, expected), 1e-9);  // mm
    EXPECT_NEAR(glm::distance(hit.surface_point_mm, hit.hit_point_mm), hit.scene_hit.t_mm, 1e-9);
  }
}

TEST(VertexHits, WhatIsBehindTheMirrorIsNotSeenAndTheSkyIsNoHit) {
  RayScene scene;
  scene.add_surroundings(wall_at(-5));
  const Optic mirror = test::conic_mirror(1200, 0, 170, 110, 7, 7);
  scene.add_optic(mirror.mesh);  // nor does the optic see itself
  scene.commit();
  for (const VertexHit& hit : trace_vertices(mirror, {100, 0, 600}, scene)) {
    EXPECT_TRUE(hit.faces_eye);
    EXPECT_FALSE(hit.scene_hit);
    EXPECT_GT(hit.direction.z, 0);
  }
}

TEST(VertexHits, OnlyTheReflectingSideFacesTheEye) {
  RayScene scene;
  scene.commit();
  Optic mirror = test::conic_mirror(-1200, 0, 100, 100, 3, 3);
  const auto facing = [&](const glm::dvec3& eye) { return trace_vertices(mirror, eye, scene)[4].faces_eye; };
  EXPECT_TRUE(facing({0, 0, 500}));
  EXPECT_FALSE(facing({0, 0, -500}));
  mirror.flip = true;
  EXPECT_FALSE(facing({0, 0, 500}));
  EXPECT_TRUE(facing({0, 0, -500}));
  EXPECT_LT(trace_vertices(mirror, {0, 0, -500}, scene)[4].direction.z, 0);
}

TEST(VertexHits, RefusesALens) {
  RayScene scene;
  scene.commit();
  Optic lens = test::conic_mirror(100, 0, 50, 50, 3, 3);
  lens.kind = OpticKind::lens;
  EXPECT_THROW((void)trace_vertices(lens, {0, 0, 500}, scene), Error);
}

// What moves the eye's ray at a vertex moves the outgoing ray as the differential says: against a central
// difference, whose own error at 1e-3 mm steps is below 1e-8 of the change.
TEST(VertexHits, DifferentialsOfALensAreThoseOfItsTracedPaths) {
  const Optic lens = test::spherical_lens(62.5, 122, 5, 50, 7);
  const LensTracer tracer(lens);
  const glm::dvec3 eye(12, -7, -90);
  const auto hits = refract_vertices(lens, tracer, LensSide::back, kLineD_nm, eye);
  int passed = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i].faces_eye) continue;
    ++passed;
    const glm::dvec3 vertex = lens.back.mesh.vertices[i].position_mm;
    constexpr double kStep_mm = 1e-3;
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 step{0};
      step[axis] = kStep_mm;
      const auto path = [&](const glm::dvec3& point) {
        return tracer.trace({eye, glm::normalize(point - eye)}, LensSide::back,
                            lens_indices(lens, kLineD_nm));
      };
      const LensPath after = path(vertex + step), before = path(vertex - step);
      if (after.end != LensPathEnd::passed || before.end != LensPathEnd::passed) continue;
      const glm::dvec3 turned = (after.outside - before.outside) / (2 * kStep_mm);
      const glm::dvec3 moved = (after.exit.position_mm - before.exit.position_mm) / (2 * kStep_mm);
      EXPECT_LT(glm::distance(hits[i].differential.direction[axis], turned), 1e-8) << i;  // 1/mm
      EXPECT_LT(glm::distance(hits[i].differential.point[axis], moved), 1e-6) << i;
    }
  }
  EXPECT_GT(passed, 20);
}

TEST(VertexHits, RaysOfALensAreKeptWhileTheSceneChanges) {
  const Optic lens = test::spherical_lens(62.5, 122, 5, 50, 9);
  const LensTracer tracer(lens);
  const glm::dvec3 eye(0, 0, -70);
  RayScene empty, scene;
  empty.commit();
  scene.add_surroundings(wall_at(1000));
  scene.commit();
  const auto rays = refract_vertices(lens, tracer, LensSide::back, kLineD_nm, eye);
  const auto once = find_scene_hits(rays, scene);
  const auto anew = trace_vertices(lens, tracer, LensSide::back, kLineD_nm, eye, scene);
  ASSERT_EQ(once.size(), lens.back.mesh.vertices.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].hit_point_mm, anew[i].hit_point_mm);
    EXPECT_EQ(once[i].faces_eye, once[i].end == LensPathEnd::passed);
    if (!once[i].faces_eye) continue;
    ASSERT_TRUE(once[i].scene_hit);
    EXPECT_NEAR(once[i].hit_point_mm.z, 1000, 1e-9);
    EXPECT_GT(once[i].transmittance, 0.9);
  }
  EXPECT_FALSE(find_scene_hits(once, empty)[40].scene_hit);
}

TEST(VertexHits, ALensSeenFromTheOtherSideShowsNothing) {
  const Optic lens = test::spherical_lens(62.5, 122, 5, 50, 5);
  const LensTracer tracer(lens);
  for (const VertexHit& hit : refract_vertices(lens, tracer, LensSide::front, kLineD_nm, {0, 0, -400})) {
    EXPECT_FALSE(hit.faces_eye);
    EXPECT_EQ(hit.end, LensPathEnd::missed);
  }
}

}  // namespace
}  // namespace catoptra::optics
