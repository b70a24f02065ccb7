// What holds for every lens, on random ones.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <iostream>
#include <random>

#include "optics/lens_path.h"
#include "optics/refraction.h"
#include "tests/support/bspline_lens.h"

namespace catoptra::optics {
namespace {

class RandomLenses {
 public:
  explicit RandomLenses(unsigned seed) : engine_(seed) { std::cout << "seed " << seed << '\n'; }

  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  // Radii from 40 mm on, either sense, thick enough in the middle and at the edge that the sides never cross.
  Optic lens() {
    const auto radius = [&] { return (number(0, 1) < 0.5 ? -1 : 1) * number(40, 400); };
    const double front = radius(), back = radius();
    const double sag = 0.5 * 20.0 * 20.0 * std::abs(1 / front - 1 / back);
    const double thickness = 2 + 1.5 * sag + number(0, 5);
    if (number(0, 1) < 0.5) return test::spherical_lens(front, back, thickness, 28, 17);
    test::BSplineLensSpec spec{front, back, thickness, 28};
    spec.degree = 2 + int(number(0, 3.999));
    spec.poles = 10;
    spec.rational = number(0, 1) < 0.3;
    spec.per_side = 17;
    return test::bspline_lens(spec);
  }

  Ray ray() {
    const glm::dvec3 from(number(-60, 60), number(-60, 60), number(60, 300));
    return {from, glm::normalize(glm::dvec3(number(-13, 13), number(-13, 13), 0) - from)};
  }

  LensIndices indices() { return {number(1.3, 2), number(1, 1.4)}; }

 private:
  std::mt19937_64 engine_;
};

// The way back is the way there: whatever passed passes again, through the same points.
TEST(LensPathProperty, LightReturnsOnItsPath) {
  RandomLenses random(20261122);
  std::size_t passed = 0;
  for (int lens_number = 0; lens_number < 60; ++lens_number) {
    const Optic lens = random.lens();
    const LensTracer tracer(lens);
    for (int k = 0; k < 50; ++k) {
      const Ray ray = random.ray();
      const LensIndices indices = random.indices();
      const LensPath there = tracer.trace(ray, LensSide::front, indices);
      if (there.end != LensPathEnd::passed) continue;
      // Grazing paths lose digits in Snell's square root; near the rim the return may start beside the mesh.
      const double cos_out = glm::dot(there.exit.normal, there.inside);
      const double cos_outside = glm::dot(there.exit.normal, there.outside);
      if (cos_out < 0.1 || cos_outside < 0.1) continue;
      const LensPath back = tracer.trace({there.exit.position_mm + 30.0 * there.outside, -there.outside},
                                         LensSide::back, indices);
      if (back.end == LensPathEnd::rim || back.end == LensPathEnd::missed) {
        EXPECT_GT(std::max(std::abs(there.exit.position_mm.x), std::abs(there.exit.position_mm.y)), 13.9);
        continue;
      }
      ++passed;
      ASSERT_EQ(back.end, LensPathEnd::passed);
      EXPECT_LT(glm::distance(back.exit.position_mm, there.entry.position_mm), 1e-8);  // mm
      EXPECT_LT(glm::length(back.outside + ray.direction), 1e-9);
      EXPECT_NEAR(back.transmittance, there.transmittance, 1e-8);
    }
  }
  EXPECT_GT(passed, 1000u);
}

// Hits lie on both exact surfaces, and Snell's law holds at each: n sin i is kept.
TEST(LensPathProperty, HitsAreExactAndSnellHolds) {
  RandomLenses random(20261123);
  std::size_t passed = 0;
  for (int lens_number = 0; lens_number < 60; ++lens_number) {
    const Optic lens = random.lens();
    const LensTracer tracer(lens);
    for (int k = 0; k < 50; ++k) {
      const Ray ray = random.ray();
      const LensIndices indices = random.indices();
      const LensPath path = tracer.trace(ray, LensSide::front, indices);
      if (path.end != LensPathEnd::passed) continue;
      ++passed;
      const auto& front = *lens.faces[0].surface;
      const auto& back = *lens.back.faces[0].surface;
      EXPECT_LT(glm::distance(front.point(path.entry.uv.x, path.entry.uv.y), path.entry.position_mm), 1e-9);
      EXPECT_LT(glm::distance(back.point(path.exit.uv.x, path.exit.uv.y), path.exit.position_mm), 1e-9);
      const glm::dvec3 on_ray = path.entry.position_mm - ray.origin_mm;
      EXPECT_LT(glm::length(glm::cross(on_ray, ray.direction)), 1e-9);
      EXPECT_LT(glm::length(glm::cross(path.exit.position_mm - path.entry.position_mm, path.inside)), 1e-9);
      EXPECT_LT(glm::length(indices.around * glm::cross(ray.direction, path.entry.normal) -
                            indices.lens * glm::cross(path.inside, path.entry.normal)),
                1e-12);
      EXPECT_LT(glm::length(indices.lens * glm::cross(path.inside, path.exit.normal) -
                            indices.around * glm::cross(path.outside, path.exit.normal)),
                1e-12);
      EXPECT_GT(path.transmittance, 0);
      EXPECT_LE(path.transmittance, 1);
    }
  }
  EXPECT_GT(passed, 1000u);
}

}  // namespace
}  // namespace catoptra::optics
