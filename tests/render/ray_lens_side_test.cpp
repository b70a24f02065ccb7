// Sixteen beams at a side of a lens, against exact hits one by one and against finite differences.
#include "render/src/ray_tracer_lens_side.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "optics/refraction.h"
#include "tests/support/bspline_lens.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = LaneVectors::kLanes;
constexpr double kEta = 1 / 1.586;

struct Bench {
  optics::Optic lens = test::bspline_lens({.poles = 10, .per_side = 17});
  optics::LensSideView front = optics::side_of(lens, optics::LensSide::front);
  optics::RayScene mesh;
  LensSidePatches patches{front};
  CameraRays camera = camera_rays({{5, -8, 60}, {0, 0, 0}, {0, 1, 0}, 0.6}, 160, 120);

  Bench() {
    mesh.add_optic(lens.mesh);
    mesh.commit();
  }
};

struct Traced {
  double stretch[kLanes];
  BeamLanes beams;
  MetLanes met{};
  RefractedBeams out;
  bool solved[kLanes];
  LensSidePatches::MeshHits hits{};
};

/// Pixels in two rows over the middle of the picture, moved by (right, down) pixels.
Traced trace(const Bench& bench, double right, double down) {
  Traced t;
  double column[kLanes], row[kLanes], eta[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    column[i] = 30 + 12 * (i % 8) + right;
    row[i] = 40 + 35 * (i / 8) + down;
    eta[i] = kEta;
  }
  aim_beams(bench.camera, column, row, t.stretch, t.beams);
  for (int i = 0; i < kLanes; ++i) {
    const optics::Hit hit = bench.mesh.intersect({t.beams.point.at(i), t.beams.direction.at(i)});
    t.hits.active[i] = bool(hit);
    t.hits.distance[i] = hit.t_mm;
    t.hits.triangle[i] = hit.triangle;
    t.hits.u[i] = float(hit.barycentric.x);
    t.hits.v[i] = float(hit.barycentric.y);
  }
  bench.patches.meet(t.beams, t.hits, t.met, t.solved);
  refract_beams(t.beams, t.met, eta, t.out);
  return t;
}

TEST(LensSidePatches, MeetAndRefractAsTheExactSurface) {
  const Bench bench;
  const Traced t = trace(bench, 0, 0);
  for (int i = 0; i < kLanes; ++i) {
    ASSERT_TRUE(t.solved[i]) << i;
    const optics::Ray ray{t.beams.point.at(i), t.beams.direction.at(i)};
    const auto exact =
        optics::exact_hit(bench.front.faces, *bench.front.mesh, ray, bench.mesh.intersect(ray));
    ASSERT_TRUE(exact) << i;
    // Tolerances are those to which patches stand for the surface; see kHeightTolerance, kSlopeTolerance.
    EXPECT_LT(glm::distance(t.met.point.at(i), exact->position_mm), 5e-8);
    EXPECT_LT(glm::distance(t.met.normal.at(i), exact->normal), 5e-9);
    const auto refracted = optics::refract(ray.direction, exact->normal, kEta);
    ASSERT_TRUE(refracted) << i;
    EXPECT_LT(glm::distance(t.out.beams.direction.at(i), *refracted), 5e-9);
    const double cosine = -glm::dot(ray.direction, exact->normal);
    EXPECT_NEAR(t.out.transmittance[i], 1 - optics::fresnel_dielectric(cosine, 1, 1.586).unpolarised, 1e-8);
    EXPECT_TRUE(t.out.possible[i]);
  }
}

// Half the difference of pixels moved to both sides; its own error is of third order.
TEST(LensSidePatches, ChangesAreFiniteDifferences) {
  const Bench bench;
  constexpr double kStep = 0.02;
  const Traced t = trace(bench, 0, 0);
  const Traced right = trace(bench, kStep, 0), left = trace(bench, -kStep, 0);
  const Traced below = trace(bench, 0, kStep), above = trace(bench, 0, -kStep);
  const auto expect_change = [](const glm::dvec3& change, const glm::dvec3& after, const glm::dvec3& before) {
    EXPECT_LT(glm::distance(change, (after - before) / (2 * kStep)), 1e-3 * glm::length(change));
  };
  for (int i = 0; i < kLanes; ++i) {
    SCOPED_TRACE(i);
    expect_change(t.out.beams.point_right.at(i), right.met.point.at(i), left.met.point.at(i));
    expect_change(t.out.beams.point_down.at(i), below.met.point.at(i), above.met.point.at(i));
    expect_change(t.out.beams.direction_right.at(i), right.out.beams.direction.at(i),
                  left.out.beams.direction.at(i));
    expect_change(t.out.beams.direction_down.at(i), below.out.beams.direction.at(i),
                  above.out.beams.direction.at(i));
  }
}

// Where the lane's own surface evaluation stands in, it says the same as the patch.
TEST(LensSidePatches, VerticesSayTheSame) {
  const Bench bench;
  const Traced t = trace(bench, 0, 0);
  MetLanes by_vertex{};
  for (int i = 0; i < kLanes; ++i) {
    const optics::Ray ray{t.beams.point.at(i), t.beams.direction.at(i)};
    const auto hit = optics::exact_hit(bench.front.faces, *bench.front.mesh, ray, bench.mesh.intersect(ray));
    ASSERT_TRUE(hit);
    const auto k = bench.front.faces[0].surface->principal_curvatures(hit->uv.x, hit->uv.y);
    meet_vertex({hit->position_mm, hit->normal, k.k1, k.k2, k.direction1, 0, hit->uv}, t.beams, i, by_vertex);
    EXPECT_LT(glm::distance(by_vertex.point_right.at(i), t.met.point_right.at(i)), 1e-7);
    // The patch's second derivatives are those of its leading terms.
    const double scale = 1e-3 * glm::length(by_vertex.normal_down.at(i));
    EXPECT_LT(glm::distance(by_vertex.normal_right.at(i), t.met.normal_right.at(i)), scale);
    EXPECT_LT(glm::distance(by_vertex.normal_down.at(i), t.met.normal_down.at(i)), scale);
  }
}

// Near the outline the patches do not answer.
TEST(LensSidePatches, LeaveTheOutlineToTheExactTest) {
  const Bench bench;
  const Traced t = trace(bench, 0, 0);
  LensSidePatches::MeshHits hits = t.hits;
  const auto& triangles = bench.lens.mesh.triangles;
  std::size_t outer = 0;  // the triangle of the outermost corner
  for (std::size_t k = 0; k < triangles.size(); ++k)
    if (triangles[k].uv[0].x < triangles[outer].uv[0].x) outer = k;
  for (int i = 0; i < kLanes; ++i) {
    hits.triangle[i] = std::uint32_t(outer);
    hits.u[i] = hits.v[i] = 0.001f;
  }
  MetLanes met{};
  bool solved[kLanes];
  bench.patches.meet(t.beams, hits, met, solved);
  EXPECT_TRUE(std::none_of(solved, solved + kLanes, [](bool s) { return s; }));
}

}  // namespace
}  // namespace catoptra::render
