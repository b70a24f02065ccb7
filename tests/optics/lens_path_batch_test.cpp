#include "optics/lens_path_batch.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <iostream>
#include <random>

#include "cad_import/error.h"
#include "tests/support/bspline_lens.h"

namespace catoptra::optics {
namespace {

// Rays from points near `eye` to points of a square in z = 0.
std::vector<Ray> random_rays(const glm::dvec3& eye, double width_mm, std::size_t count, unsigned seed) {
  std::cout << "seed " << seed << '\n';
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 from = eye + 20.0 * glm::dvec3(number(engine), number(engine), number(engine));
    const glm::dvec3 to = 0.5 * width_mm * glm::dvec3(number(engine), number(engine), 0);
    rays.push_back({from, glm::normalize(to - from)});
  }
  return rays;
}

std::vector<SimdLevel> levels_here() {
  std::vector<SimdLevel> levels{SimdLevel::scalar};
  for (const SimdLevel level : {SimdLevel::avx2, SimdLevel::avx512})
    if (level <= best_simd_level()) levels.push_back(level);
  return levels;
}

glm::dvec3 exit_of(const LensRayBatch& b, std::size_t i) {
  return {b.exit_x[i], b.exit_y[i], b.exit_z[i]};
}

glm::dvec3 outside_of(const LensRayBatch& b, std::size_t i) {
  return {b.outside_x[i], b.outside_y[i], b.outside_z[i]};
}

// The independent source is the single-ray tracer, whose start is a mesh hit and whose surfaces go through
// ExactSurface. Its own tolerance is 1e-10 mm.
void expect_equals_single_rays(const Optic& lens, LensSide entered, const std::vector<Ray>& rays) {
  const LensIndices indices = lens_indices(lens, kLineD_nm);
  const LensBatchTracer batch(lens, entered, indices);
  const LensTracer single(lens);
  const LensRayBatch scalar = batch.trace(LensRayBatch(rays), SimdLevel::scalar);
  for (const SimdLevel level : levels_here()) {
    SCOPED_TRACE(simd_level_name(level));
    const LensRayBatch result = batch.trace(LensRayBatch(rays), level);
    std::size_t passed = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const LensPath path = single.trace(rays[i], entered, indices);
      ASSERT_EQ(result.end[i], path.end) << i;
      if (path.end != LensPathEnd::passed) continue;
      ++passed;
      EXPECT_LT(glm::distance(exit_of(result, i), path.exit.position_mm), 1e-9) << i;
      EXPECT_LT(glm::distance(outside_of(result, i), path.outside), 1e-11) << i;
      EXPECT_NEAR(result.transmittance[i], path.transmittance, 1e-10);
      // 1e-12, as promised
      EXPECT_LT(glm::distance(exit_of(result, i), exit_of(scalar, i)), 1e-12) << i;
      EXPECT_LT(glm::distance(outside_of(result, i), outside_of(scalar, i)), 1e-12) << i;
    }
    EXPECT_GT(passed, rays.size() / 4);
  }
}

TEST(LensBatchTracer, EqualsSingleRaysFromBothSides) {
  const Optic lens = test::bspline_lens({});
  expect_equals_single_rays(lens, LensSide::front, random_rays({5, 10, 300}, 60, 5000, 11));
  expect_equals_single_rays(lens, LensSide::back, random_rays({-4, 3, -60}, 50, 5000, 12));
}

TEST(LensBatchTracer, AnyDegreeWeightsAndNumberOfPoles) {
  for (const int degree : {1, 2, 3, 4, 5})
    for (const bool rational : {false, true}) {
      SCOPED_TRACE(testing::Message() << "degree " << degree << (rational ? ", rational" : ""));
      test::BSplineLensSpec spec;
      spec.degree = degree;
      spec.rational = rational;
      spec.poles = degree + 1 + 3 * degree;
      if (degree == 1) spec.poles = 2;  // one bilinear patch a side: a plate
      expect_equals_single_rays(test::bspline_lens(spec), LensSide::front,
                                random_rays({0, 0, 400}, 60, 500, 13));
    }
}

TEST(LensBatchTracer, TrimmedAway) {
  test::BSplineLensSpec spec;
  spec.trim_radius_mm = 25;
  const Optic lens = test::bspline_lens(spec);
  const auto rays = random_rays({0, 0, 60}, 80, 5000, 14);
  const LensIndices indices = lens_indices(lens, kLineD_nm);
  expect_equals_single_rays(lens, LensSide::front, rays);
  const LensRayBatch result = LensBatchTracer(lens, LensSide::front, indices).trace(LensRayBatch(rays));
  std::size_t missed = 0, rim = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    missed += result.end[i] == LensPathEnd::missed;
    rim += result.end[i] == LensPathEnd::rim;
    if (result.end[i] == LensPathEnd::passed) {
      EXPECT_LE(std::hypot(result.exit_x[i], result.exit_y[i]), 25);
    }
  }
  EXPECT_GT(missed, 1000u);
  EXPECT_GT(rim, 10u);
}

// A number of rays that fills no whole vector, and rays that no lens can be met by.
TEST(LensBatchTracer, OddCountsAndHopelessRays) {
  const Optic lens = test::bspline_lens({});
  const LensBatchTracer tracer(lens, LensSide::front, {1.586, 1});
  EXPECT_EQ(tracer.trace(LensRayBatch(std::size_t(0))).size(), 0u);
  auto rays = random_rays({0, 0, 300}, 50, 13, 15);
  rays.push_back({{0, 0, 300}, {1, 0, 0}});
  rays.push_back({{0, 0, 300}, {0, 0, 1}});
  rays.push_back({{0, 0, -300}, {0, 0, 1}});  // meets the back first
  const double nan = std::nan("");
  rays.push_back({{nan, 0, 0}, {0, 0, -1}});
  for (const SimdLevel level : levels_here()) {
    const LensRayBatch result = tracer.trace(LensRayBatch(rays), level);
    for (std::size_t i = 0; i < rays.size(); ++i)
      EXPECT_EQ(result.end[i], i < 13 ? LensPathEnd::passed : LensPathEnd::missed) << i;
  }
}

TEST(LensBatchTracer, TotalReflectionAtASteepExit) {
  test::BSplineLensSpec spec;
  spec.front_radius_mm = 0;
  spec.back_radius_mm = -15;
  spec.thickness_mm = 12;
  spec.width_mm = 24;
  spec.poles = 20;
  const Optic lens = test::bspline_lens(spec);
  std::vector<Ray> rays;
  for (int i = 0; i <= 110; ++i) rays.push_back({{0.1 * i, 0.05, 50}, {0, 0, -1}});
  const LensIndices indices = lens_indices(lens, kLineD_nm);
  const LensTracer single(lens);
  const LensRayBatch result = LensBatchTracer(lens, LensSide::front, indices).trace(LensRayBatch(rays));
  std::size_t total = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(result.end[i], single.trace(rays[i], LensSide::front, indices).end) << i;
    total += result.end[i] == LensPathEnd::total_reflection;
  }
  EXPECT_GT(total, 5u);
}

TEST(LensBatchTracer, RefusesOtherSurfaces) {
  const Optic spheres = test::spherical_lens(80, 120, 4, 50, 5);
  EXPECT_FALSE(LensBatchTracer::supported(spheres));
  EXPECT_THROW(LensBatchTracer(spheres, LensSide::front, {1.5, 1}), Error);
  EXPECT_TRUE(LensBatchTracer::supported(test::bspline_lens({})));
}

}  // namespace
}  // namespace catoptra::optics
