// Random mirrors and lenses in a room with near objects: mode exact shows what exact rays meet.
#include <gtest/gtest.h>

#include <cstdio>
#include <random>
#include <string>

#include "tests/support/aspheric_surface.h"
#include "tests/support/bspline_lens.h"
#include "tests/support/exact_judgement.h"
#include "tests/support/near_objects.h"

namespace catoptra::test {
namespace {

/// As over the examples (issue: 99.9 % of the pixels).
constexpr double kMostWrong = 0.001;
/// Measured: none to 0.34 %, of pixels at the edges of near things, where mode pvrr has up to 29 %. (The
/// texture has to be resolved for that: with three waves over each narrow bar, at half the resolution, it was
/// 7 %.)
constexpr double kMostDiscolored = 0.005;
constexpr int kRounds = 4;

struct Random {
  std::mt19937 engine;
  explicit Random(unsigned seed) : engine(seed) { std::printf("seed %u\n", seed); }
  double operator()(double low, double high) {
    return low + (high - low) * (double(engine()) / 4294967296.0);  // the same on every machine
  }
  double sign() { return (*this)(0, 1) < 0.5 ? -1 : 1; }
};

/// A bicubic spline over a square of 100 mm, u = x, v = y: z = -(k1 x^2 + k2 y^2) / 2 and waves of `wave_mm`.
optics::Optic spline_mirror(Random& random, double k1, double k2, double wave_mm) {
  constexpr int kPoles = 9;
  constexpr double kWidth = 100;
  const double a = random(0, 6.28), b = random(0, 6.28), fx = random(0.02, 0.06), fy = random(0.02, 0.06);
  cad_import::BSplineData data;
  data.degree_u = data.degree_v = 3;
  data.pole_count_u = data.pole_count_v = kPoles;
  for (int i = 0; i < kPoles + 4; ++i)
    data.knots_u.push_back(kWidth * (double(std::clamp(i - 3, 0, kPoles - 3)) / (kPoles - 3) - 0.5));
  data.knots_v = data.knots_u;
  const auto greville = [&](int i) {
    return (data.knots_u[std::size_t(i) + 1] + data.knots_u[std::size_t(i) + 2] +
            data.knots_u[std::size_t(i) + 3]) /
           3;
  };
  for (int i = 0; i < kPoles; ++i)
    for (int j = 0; j < kPoles; ++j) {
      const double x = greville(i), y = greville(j);
      data.poles.emplace_back(
          x, y, -0.5 * (k1 * x * x + k2 * y * y) + wave_mm * std::sin(fx * x + a) * std::sin(fy * y + b));
      data.weights.push_back(random(0.9, 1.1));
    }
  return rectangular_mirror(std::make_shared<cad_import::BSplineSurface>(data, 1), kWidth, kWidth, 17, 17);
}

void expect_exact(optics::Optic optic, const std::string& what) {
  SCOPED_TRACE(what);
  static const TemporaryImage texture("waves.png", waves(512));
  render::Scene scene;
  scene.file = what;
  scene.optics.push_back(std::move(optic));
  add_near_objects(scene, 0, texture.path().string(), 4);
  const ExactJudgement j = judge_exact(scene, 320, 240).at(0);
  std::puts(table_row(what, scene.optics[0].name, j).c_str());
  EXPECT_GT(j.pixels, 1500u);
  EXPECT_LE(j.wrong(), kMostWrong) << j.other << " outline, " << j.turned << " turned, " << j.elsewhere
                                   << " elsewhere of " << j.pixels;
  EXPECT_LE(j.share(j.discolored), kMostDiscolored);
}

TEST(ExactProperty, RandomNurbsMirrors) {
  Random random(20261124);
  for (int round = 0; round < kRounds; ++round) {
    const double k1 = 1 / random(150, 3000), k2 = 1 / random(150, 3000);
    expect_exact(spline_mirror(random, k1, k2, 0), "convex " + std::to_string(round));
    expect_exact(spline_mirror(random, -k1, -k2, 0), "concave " + std::to_string(round));
    expect_exact(spline_mirror(random, k1, -k2, 0), "saddle " + std::to_string(round));
    expect_exact(spline_mirror(random, k1, k2, random(0.05, 0.4)), "wavy " + std::to_string(round));
  }
}

TEST(ExactProperty, RandomLenses) {
  Random random(5831);
  for (int round = 0; round < kRounds; ++round) {
    const double thickness = random(8, 12);
    const auto medium = optics::abbe_medium(random(1.45, 1.9), random(25, 70));
    const auto finished = [&](optics::Optic lens) {
      lens.medium = medium;
      lens.wavelengths = 3;
      return lens;
    };
    const auto sphere = [&] {
      return std::make_shared<ConicSurface>(random.sign() / random(90, 600), 0, 30, 30);
    };
    const auto asphere = [&](bool toric) {
      AsphereSpec spec;
      spec.c1 = random.sign() / random(90, 600);
      spec.c2 = toric ? random.sign() / random(90, 600) : spec.c1;
      spec.k1 = spec.k2 = toric ? 0 : random(-2, 0.5);
      spec.angle_rad = random(0, 3.14);
      spec.a = toric ? 0 : random(-2e-7, 2e-7);
      return std::make_shared<AsphericSurface>(spec);
    };
    expect_exact(finished(lens_between(sphere(), sphere(), thickness, 50, 17)),
                 "sphere " + std::to_string(round));
    expect_exact(finished(lens_between(sphere(), asphere(true), thickness, 50, 17)),
                 "toric " + std::to_string(round));
    expect_exact(finished(lens_between(asphere(false), sphere(), thickness, 50, 17)),
                 "asphere " + std::to_string(round));
  }
}

}  // namespace
}  // namespace catoptra::test
