// Chief rays several at once against the same one by one, on every vector unit that there is.
#include "optics/src/lens_chief_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <iostream>
#include <random>

#include "optics/lens_evaluation.h"
#include "tests/optics/pencil.h"
#include "tests/support/bspline_lens.h"

namespace catoptra::optics {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) { std::cout << "seed " << seed << '\n'; }
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  test::BSplineLensSpec lens() {
    test::BSplineLensSpec spec;
    spec.front_radius_mm = number(60, 300);
    spec.back_radius_mm = number(60, 300);
    spec.thickness_mm = 8;
    spec.degree = 2 + int(number(0, 3.999));
    spec.poles = 8 + int(number(0, 20));
    spec.rational = number(0, 1) < 0.3;
    spec.trim_radius_mm = number(0, 1) < 0.5 ? 30 : 0;
    return spec;
  }
  Ray ray(double rotation_centre_z) {
    const glm::dvec3 d(number(-1.1, 1.1), number(-1.1, 1.1), 1);
    return {{0, 0, rotation_centre_z}, glm::normalize(d)};
  }
  ChiefRayTask task() {
    ChiefRayTask t;
    t.kind = number(0, 1) < 0.5 ? ChiefRayKind::straight : ChiefRayKind::along_the_normal;
    if (number(0, 1) < 0.5) t.object_distance_mm = number(250, 2000);
    t.coloured = number(0, 1) < 0.7;
    t.indices = {number(1.45, 1.9), 1};
    t.indices_f = {t.indices.lens + 0.012, 1};
    t.indices_c = {t.indices.lens - 0.006, 1};
    return t;
  }

 private:
  std::mt19937_64 engine_;
};

double distance(const Wavefront& a, const Wavefront& b) {
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    sum += glm::dot(a.curvature[k] - b.curvature[k], a.curvature[k] - b.curvature[k]);
  return std::sqrt(sum);
}

struct Worst {
  double back_mm = 0, direction = 0, wave = 0, colour = 0;

  void take(const ChiefRay& a, const ChiefRay& b) {
    back_mm = std::max(back_mm, glm::distance(a.back_mm, b.back_mm));
    direction = std::max(
        {direction, glm::distance(a.eye_side, b.eye_side), glm::distance(a.object_side, b.object_side)});
    wave = std::max(wave, distance(a.wave, b.wave));
    if (!a.coloured) return;
    colour = std::max({colour, glm::distance(a.object_side_f, b.object_side_f),
                       glm::distance(a.object_side_c, b.object_side_c)});
  }
};

TEST(ChiefRays, ManyAtOnceAreTheSameOneByOne) {
  Random random(77);
  Worst against_single, among_levels;
  std::size_t passed = 0, blocked = 0;
  for (int lens_number = 0; lens_number < 120; ++lens_number) {
    const Optic lens = test::bspline_lens(random.lens());
    ASSERT_TRUE(LensBatchTracer::supported(lens));
    const ChiefRays tracer(lens);
    const ChiefRayTask task = random.task();
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < ChiefRays::kMost - 3; ++i) rays.push_back(random.ray(-33));
    const auto scalar = tracer.trace(rays, task, SimdLevel::scalar);
    ASSERT_EQ(scalar.size(), rays.size());
    for (const SimdLevel level : {SimdLevel::avx2, SimdLevel::avx512}) {
      const auto wide = tracer.trace(rays, task, level);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(wide[i].end, scalar[i].end);
        ASSERT_EQ(wide[i].coloured, scalar[i].coloured);
        if (wide[i].end == LensPathEnd::passed) among_levels.take(wide[i], scalar[i]);
      }
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const ChiefRay single = tracer.one_by_one().trace(rays[i], task);
      ASSERT_EQ(single.end, scalar[i].end);
      ASSERT_EQ(single.coloured, scalar[i].coloured);
      if (single.end == LensPathEnd::passed) against_single.take(single, scalar[i]);
      (single.end == LensPathEnd::passed ? passed : blocked) += 1;
    }
  }
  EXPECT_GT(passed, 2000u);
  EXPECT_GT(blocked, 400u);
  std::cout << "levels: " << among_levels.back_mm << " mm, " << among_levels.direction << " rad, "
            << 1000 * among_levels.wave << " D, " << among_levels.colour
            << " rad\nsingle: " << against_single.back_mm << " mm, " << against_single.direction << " rad, "
            << 1000 * against_single.wave << " D, " << against_single.colour << " rad\n";
  // Of what is some 30 mm, 1 and 0.03 / mm.
  EXPECT_LT(among_levels.back_mm, 3e-11);
  EXPECT_LT(among_levels.direction, 1e-12);
  EXPECT_LT(among_levels.wave, 3e-14);
  EXPECT_LT(among_levels.colour, 1e-12);
  // LensTracer stops within 1e-10 mm of the surface, at steep incidence some times that along it.
  EXPECT_LT(against_single.back_mm, 1e-9);
  EXPECT_LT(against_single.direction, 1e-10);
  EXPECT_LT(1000 * against_single.wave, 1e-7);  // D
  EXPECT_LT(against_single.colour,
            1e-9);  // its last step may cross a knot of degree 2, where second derivatives jump
}

// A B-spline's knots are where its third derivative jumps: the pencil is kept within a span.
TEST(ChiefRays, PowersOfSplinesAreThoseOfAPencil) {
  Random random(78);
  double worst_d = 0;
  for (int passed = 0; passed < 100;) {
    test::BSplineLensSpec spec = random.lens();
    spec.poles = spec.degree + 1;  // one span
    const Optic lens = test::bspline_lens(spec);
    const glm::dvec2 gaze(random.number(-0.5, 0.5), random.number(-0.5, 0.5));
    EvaluationOptions options;
    options.mode = EvaluationMode::as_worn;
    const LensFrame frame{.back_vertex_mm = lens.back.faces[0].surface->point(0, 0)};
    const LensPoint point = LensEvaluator(lens, frame).at_gaze(std::span(&gaze, 1), options).points[0];
    if (point.end != LensPathEnd::passed) continue;
    ++passed;
    const glm::dvec3 d = glm::normalize(glm::dvec3(std::tan(gaze.x), std::tan(gaze.y), 1));
    const glm::dvec3 centre = frame.back_vertex_mm - glm::dvec3(0, 0, 25);
    const glm::dvec3 x = glm::dvec3(1, 0, 0) - (d + glm::dvec3(0, 0, 1)) * (d.x / (1 + d.z)),
                     y = glm::dvec3(0, 1, 0) - (d + glm::dvec3(0, 0, 1)) * (d.y / (1 + d.z));
    const glm::dmat2 vergence =
        1000.0 * test::pencil_vergence(lens, {centre + 25.0 * d, d}, centre + 25.0 * d, x, y, kInfinity,
                                       lens_indices(lens, options.wavelength_nm));
    worst_d =
        std::max({worst_d, std::abs(point.power.xx - vergence[0][0]),
                  std::abs(point.power.xy - vergence[0][1]), std::abs(point.power.yy - vergence[1][1])});
    ASSERT_LT(worst_d, 1e-6);
  }
  std::cout << "greatest difference " << worst_d << " D\n";
}

}  // namespace
}  // namespace catoptra::optics
