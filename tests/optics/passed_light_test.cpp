// Which ray of an optic passes a point: law of reflection, Snell's law on the way back, and the wave's
// curvature.
#include "optics/passed_light.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "optics/placement.h"
#include "optics/reflection.h"
#include "tests/support/analytic_lens.h"
#include "tests/support/analytic_optic.h"

namespace catoptra::optics {
namespace {

using namespace catoptra::test;

const glm::dvec3 kEye{-150, 60, 700};

PassedLight::ArrivalAt from(const glm::dvec3& eye) {
  return [eye](const glm::dvec3& point) { return arrival_from_eye(eye, point); };
}

/// The derivative of the direction by central differences against what the arrival says.
void expect_turn(const PassedLight& light, const glm::dvec3& point, double tolerance) {
  const auto arrival = light.to(point);
  ASSERT_TRUE(arrival);
  constexpr double kStep = 0.5;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 step{0};
    step[axis] = kStep;
    const auto plus = light.to(point + step), minus = light.to(point - step);
    ASSERT_TRUE(plus && minus);
    const glm::dvec3 slope = (plus->direction - minus->direction) / (2 * kStep);
    EXPECT_LT(glm::length(slope - arrival->turn[axis]), tolerance);
  }
}

class PassedLightOfMirror : public ::testing::TestWithParam<double> {};

TEST_P(PassedLightOfMirror, ObeysTheLawOfReflectionAtASurfacePoint) {
  const double radius = GetParam();
  const Optic mirror = conic_mirror(radius, 0, 170, 110, 9, 7);
  const auto rays = reflect_vertices(mirror, kEye);
  const PassedLight light(mirror, LensSide::front, nullptr, {}, rays, from(kEye));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.4, 0.4), far(150, 2500);
  for (int k = 0; k < 200; ++k) {
    // A point that is seen: along the exact ray of some place on the glass.
    const glm::dvec2 uv(170 * place(random), 110 * place(random));
    const auto& surface = *mirror.faces[0].surface;
    const glm::dvec3 on = surface.point(uv.x, uv.y), normal = surface.unit_normal(uv.x, uv.y);
    const glm::dvec3 point = on + far(random) * reflect(glm::normalize(on - kEye), normal);
    const auto arrival = light.to(point);
    ASSERT_TRUE(arrival) << "seed 7, point " << k;
    EXPECT_LT(glm::distance(arrival->origin_mm, on), 1e-3) << "seed 7, point " << k;
    EXPECT_LT(glm::length(glm::cross(arrival->direction, glm::normalize(point - on))), 1e-6);
  }
  // The wave is that at the last exact ray, up to 0.05 mm beside: a share of 0.05 / 200 of some 1e-3 a mm.
  expect_turn(light, glm::dvec3(130, -40, 800), 5e-7);
}
INSTANTIATE_TEST_SUITE_P(Radii, PassedLightOfMirror, ::testing::Values(0.0, 1200.0, 200.0));

// Behind two mirrors the field of the first is what arrives at the second: asked of a nested field, the path
// obeys the law of reflection at both.
TEST(PassedLight, GoesByTwoMirrors) {
  const Optic first = conic_mirror(600, 0, 300, 300, 9, 9);
  const auto first_rays = reflect_vertices(first, kEye);
  const PassedLight first_light(first, LensSide::front, nullptr, {}, first_rays, from(kEye));
  Optic second = conic_mirror(400, 0, 300, 300, 9, 9);
  second = placed(second, {glm::dmat3({-1, 0, 0}, {0, 1, 0}, {0, 0, -1}), {120, 0, 500}});
  const auto arrives = [&](const glm::dvec3& point) {
    const auto arrival = first_light.to(point);
    return arrival ? *arrival : arrival_from_eye(kEye, point);
  };
  std::vector<VertexHit> rays;
  for (const auto& vertex : second.mesh.vertices)
    rays.push_back(reflect_vertex(vertex, second, arrives(vertex.position_mm)));
  const PassedLight light(second, LensSide::front, nullptr, {}, rays, arrives);
  const glm::dvec3 point{400, -150, -300};
  const auto last = light.to(point);
  ASSERT_TRUE(last);
  const auto before = first_light.to(last->origin_mm);
  ASSERT_TRUE(before);
  const auto mean_normal = [](const glm::dvec3& in, const glm::dvec3& out) {
    return glm::normalize(out - in);
  };
  const glm::dvec3 second_center = glm::dvec3(120, 0, 500 + 400), first_center(0, 0, -600);
  EXPECT_NEAR(glm::distance(last->origin_mm, second_center), 400, 1e-3);
  EXPECT_NEAR(glm::distance(before->origin_mm, first_center), 600, 1e-3);
  EXPECT_LT(glm::length(mean_normal(before->direction, last->direction) -
                        glm::normalize(last->origin_mm - second_center)),
            1e-5);
  EXPECT_LT(glm::length(mean_normal(glm::normalize(before->origin_mm - kEye), before->direction) -
                        glm::normalize(before->origin_mm - first_center)),
            1e-5);
  expect_turn(light, point, 5e-7);
}

TEST(PassedLight, GoesThroughALens) {
  const Optic lens = spherical_lens(100, 400, 6, 60, 9);
  const LensTracer tracer(lens);
  const LensIndices indices = lens_indices(lens, 587.56);
  const glm::dvec3 eye{5, -8, -120};
  const LensSide entered = side_towards(lens, eye);
  const auto rays = refract_vertices(lens, tracer, entered, 587.56, eye);
  const PassedLight light(lens, entered, &tracer, indices, rays, from(eye));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> across(-0.12, 0.12);
  for (int k = 0; k < 50; ++k) {
    const LensPath path =
        tracer.trace({eye, glm::normalize(glm::dvec3(across(random), across(random), 1))}, entered, indices);
    if (path.end != LensPathEnd::passed) continue;
    const glm::dvec3 point = path.exit.position_mm + 800.0 * path.outside;
    const auto arrival = light.to(point);
    ASSERT_TRUE(arrival) << "seed 11, ray " << k;
    EXPECT_LT(glm::distance(arrival->origin_mm, path.exit.position_mm), 1e-3) << "seed 11, ray " << k;
    EXPECT_LT(glm::length(glm::cross(arrival->direction, path.outside)), 1e-6) << "seed 11, ray " << k;
  }
}

TEST(PassedLight, HasNoneForWhatTheOpticHasItsBackTo) {
  const Optic mirror = conic_mirror(1200, 0, 170, 110, 9, 7);
  const auto rays = reflect_vertices(mirror, kEye);
  const PassedLight light(mirror, LensSide::front, nullptr, {}, rays, from(kEye));
  EXPECT_FALSE(light.to({0, 0, -500}));
}

}  // namespace
}  // namespace catoptra::optics
