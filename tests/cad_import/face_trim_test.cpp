// Point-in-face tests on outlines with a closed form.
#include "cad_import/src/face_trim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <thread>

namespace catoptra::cad_import {
namespace {

constexpr unsigned kSeed = 99;

class Ellipse final : public TrimCurve {
 public:
  Ellipse(glm::dvec2 centre, glm::dvec2 radii) : centre_(centre), radii_(radii) {}
  [[nodiscard]] glm::dvec2 uv(double t) const override {
    return centre_ + radii_ * glm::dvec2(std::cos(t), std::sin(t));
  }
  [[nodiscard]] glm::dvec3 point(double t) const override { return {uv(t), 0}; }

 private:
  glm::dvec2 centre_, radii_;
};

class Line final : public TrimCurve {
 public:
  Line(glm::dvec2 a, glm::dvec2 b) : a_(a), b_(b) {}
  [[nodiscard]] glm::dvec2 uv(double t) const override { return a_ + t * (b_ - a_); }
  [[nodiscard]] glm::dvec3 point(double t) const override { return {uv(t), 0}; }

 private:
  glm::dvec2 a_, b_;
};

TrimLoop ellipse(glm::dvec2 centre, glm::dvec2 radii, bool hole) {
  EdgeUse use;
  use.t_end = 2 * std::numbers::pi;
  use.reversed = hole;
  use.curve = std::make_shared<Ellipse>(centre, radii);
  return {{use}, !hole};
}

TrimLoop rectangle(glm::dvec2 low, glm::dvec2 high) {
  TrimLoop loop;
  const glm::dvec2 corners[] = {low, {high.x, low.y}, high, {low.x, high.y}};
  for (int i = 0; i < 4; ++i) {
    EdgeUse use;
    use.curve = std::make_shared<Line>(corners[i], corners[(i + 1) % 4]);
    loop.edges.push_back(use);
  }
  return loop;
}

PolygonTrim trim_of(const std::vector<TrimLoop>& loops, glm::dvec2 extent,
                    glm::dvec2 periods = glm::dvec2(0)) {
  std::vector<std::vector<glm::dvec2>> polygons;
  for (const TrimLoop& loop : loops) polygons.push_back(sample_loop(loop, extent * PolygonTrim::kChord));
  return {polygons, periods};
}

TEST(SampleLoop, StraightEdgesKeepTheirCornersOnly) {
  const auto polygon = sample_loop(rectangle({0, 0}, {2, 1}), glm::dvec2(1e-5));
  EXPECT_EQ(polygon.size(), 4u);
  EXPECT_NEAR(signed_area2(polygon), 4, 1e-12);
}

TEST(SampleLoop, CurveIsWithinTheChordError) {
  const auto polygon = sample_loop(ellipse({0, 0}, {1, 1}, false), glm::dvec2(1e-4));
  // The area between a circle and chords of sagitta e is 2/3 e times its length.
  EXPECT_NEAR(signed_area2(polygon) / 2, std::numbers::pi, 2 * std::numbers::pi * 1e-4);
  EXPECT_LT(polygon.size(), 512u);
  EXPECT_LT(signed_area2(sample_loop(ellipse({0, 0}, {1, 1}, true), glm::dvec2(1e-4))), 0);
}

// Random points against the ellipses' own inequality; what lies within the margin of a border may go either
// way.
TEST(PolygonTrim, EllipseWithAHole) {
  const glm::dvec2 outer{85, 55}, hole{30, 10}, hole_centre{20, -5};
  const auto trim = trim_of({ellipse({0, 0}, outer, false), ellipse(hole_centre, hole, true)}, 2.0 * outer);
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> in_u(-100, 100), in_v(-70, 70);
  const auto level = [](glm::dvec2 p, glm::dvec2 c, glm::dvec2 r) {
    const glm::dvec2 q = (p - c) / r;
    return std::sqrt(q.x * q.x + q.y * q.y) - 1;  // < 0 inside, share of the radius
  };
  int inside = 0, judged = 0;
  for (int i = 0; i < 200000; ++i) {
    const glm::dvec2 p{in_u(random), in_v(random)};
    const double a = level(p, {0, 0}, outer), b = level(p, hole_centre, hole);
    if (std::abs(a) < 2e-4 || std::abs(b) < 1e-3) continue;
    const bool expected = a < 0 && b > 0;
    ASSERT_EQ(trim.contains(p.x, p.y), expected) << p.x << ", " << p.y << ", seed " << kSeed;
    inside += expected;
    ++judged;
  }
  EXPECT_GT(inside, judged / 4);
}

TEST(PolygonTrim, PointsOfTheTrueBorderAreInside) {
  const glm::dvec2 radii{85, 55};
  const auto trim = trim_of({ellipse({0, 0}, radii, false)}, 2.0 * radii);
  for (int i = 0; i < 10000; ++i) {
    const double t = 2 * std::numbers::pi * i / 10000;
    EXPECT_TRUE(trim.contains(radii.x * std::cos(t), radii.y * std::sin(t)));
    EXPECT_FALSE(trim.contains(1.001 * radii.x * std::cos(t), 1.001 * radii.y * std::sin(t)));
  }
}

TEST(PolygonTrim, PeriodicParameterInAnyPeriod) {
  const double turn = 2 * std::numbers::pi;
  const auto trim = trim_of({rectangle({5, 0}, {7.5, 1})}, {2.5, 1}, {turn, 0});
  for (const double turns : {-2.0, -1.0, 0.0, 1.0, 3.0}) {
    EXPECT_TRUE(trim.contains(6 + turns * turn, 0.5));
    EXPECT_TRUE(trim.contains(5 + turns * turn, 0.5));
    EXPECT_TRUE(trim.contains(7.5 + turns * turn, 0.5));
    EXPECT_FALSE(trim.contains(4.9 + turns * turn, 0.5));
    EXPECT_FALSE(trim.contains(7.6 + turns * turn, 0.5));
  }
  EXPECT_FALSE(trim.contains(6, 0.5 + turn));
}

TEST(PolygonTrim, NothingIsInsideNoLoopAndNotANumberIsOutside) {
  EXPECT_FALSE(PolygonTrim({}, glm::dvec2(0)).contains(0, 0));
  const auto trim = trim_of({rectangle({0, 0}, {1, 1})}, {1, 1});
  EXPECT_FALSE(trim.contains(std::nan(""), 0.5));
  EXPECT_FALSE(trim.contains(0.5, std::nan("")));
}

TEST(PolygonTrim, ManyThreadsAgree) {
  const auto trim = trim_of({ellipse({0, 0}, {1, 1}, false)}, {2, 2});
  const auto count = [&] {
    int inside = 0;
    for (int i = 0; i < 300; ++i)
      for (int j = 0; j < 300; ++j) inside += trim.contains(i / 150.0 - 1, j / 150.0 - 1);
    return inside;
  };
  const int expected = count();
  std::vector<int> results(8);
  std::vector<std::thread> threads;
  for (int& result : results) threads.emplace_back([&] { result = count(); });
  for (std::thread& thread : threads) thread.join();
  for (const int result : results) EXPECT_EQ(result, expected);
}

}  // namespace
}  // namespace catoptra::cad_import
