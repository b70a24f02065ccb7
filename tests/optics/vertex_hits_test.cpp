#include "optics/vertex_hits.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "cad_import/error.h"
#include "tests/support/analytic_optic.h"

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

}  // namespace
}  // namespace catoptra::optics
