// Shadows of the reference ray tracer against geometry.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "tests/render/ray_light_scenes.h"

namespace catoptra {
namespace {

using test::irradiance;

/// Tolerance of places, mm: shadow rays start 2e-6 of the triangle's coordinates (here 2 m) off it, and
/// bisect to 1e-5 of at most 400 mm.
constexpr double kPlace_mm = 0.02;

TEST(RayShadows, EdgeOfABoxLiesWhereGeometrySays) {
  render::Scene scene = test::dark_scene();
  test::add_quad(scene.surroundings[0], {-2000, -2000, 0}, {4000, 0, 0}, {0, 4000, 0});
  test::add_box(scene.surroundings[0], {0, 0, 0}, {100, 100, 200});
  // The light comes from -x and -y: the top's far corner (100, 100, 200) is cast to (200, 150, 0).
  scene.lights.push_back(test::sun({-0.5, -0.25, 1}));
  const test::TracedScene traced(std::move(scene));
  const double lit = 1 / std::sqrt(1 + 0.25 + 0.0625);
  EXPECT_NEAR(irradiance(traced, {300, 75, 0}), lit, 1e-6);
  EXPECT_EQ(irradiance(traced, {150, 110, 0}), 0);
  EXPECT_NEAR(test::edge_between(traced, {300, 120, 0}, {150, 120, 0}, lit / 2).x, 200, kPlace_mm);
  EXPECT_NEAR(test::edge_between(traced, {180, 300, 0}, {180, 120, 0}, lit / 2).y, 150, kPlace_mm);
  EXPECT_NEAR(irradiance(traced, {50, 50, 200}), lit, 1e-6) << "the top is lit";
  EXPECT_EQ(irradiance(traced, {100, 50, 100}, {20, 0, 0}), 0) << "the side turned away";
  EXPECT_EQ(irradiance(traced, {100.05, 50, 0}), 0) << "no light leaks in at the foot";
}

TEST(RayShadows, LightsWithoutShadowsShineThrough) {
  render::Scene scene = test::dark_scene();
  test::add_quad(scene.surroundings[0], {-200, -200, 0}, {400, 0, 0}, {0, 400, 0});
  test::add_quad(scene.surroundings[0], {-200, -200, 100}, {400, 0, 0}, {0, 400, 0});
  scene.optics.push_back(test::square_optic(optics::OpticKind::mirror, 50, {0, 0, -50}));
  scene.lights.push_back(test::sun({0, 0, 1}));
  scene.lights[0].shadows = false;
  scene.lights[0].radius_mm = 50;
  EXPECT_NEAR(irradiance(test::TracedScene(std::move(scene)), {0, 0, 0}), 1, 1e-6);
}

TEST(RayShadows, WhatStandsBeyondAPointLightCastsNone) {
  render::Scene scene = test::dark_scene();
  test::add_quad(scene.surroundings[0], {-200, -200, 0}, {400, 0, 0}, {0, 400, 0});
  test::add_quad(scene.surroundings[0], {-200, -200, 600}, {400, 0, 0}, {0, 400, 0});
  scene.lights.push_back({render::LightKind::point, {}, {0, 0, 500}});
  const test::TracedScene traced(std::move(scene));
  EXPECT_NEAR(irradiance(traced, {0, 0, 0}), 4, 1e-5);
}

TEST(RayShadows, AlphaTestedTrianglesCastNone) {
  render::Scene scene = test::dark_scene();
  auto& mesh = scene.surroundings[0];
  mesh.materials.emplace_back().alpha_cutoff = 0.5f;
  test::add_quad(mesh, {-200, -200, 0}, {400, 0, 0}, {0, 400, 0});
  test::add_quad(mesh, {-200, -200, 100}, {400, 0, 0}, {0, 400, 0}, 1);
  scene.lights.push_back(test::sun({0, 0, 1}));
  EXPECT_NEAR(irradiance(test::TracedScene(std::move(scene)), {0, 0, 0}), 1, 1e-6);
}

/// A flat ground under a flat sun, of any size, far from the origin, and seen from afar: no pixel of it is in
/// shadow.
TEST(RayShadows, AFlatMeshDoesNotShadowItself) {
  for (const float size : {10.0f, 1e3f, 1e5f})
    for (const float away : {0.0f, 50.0f}) {
      render::Scene scene = test::dark_scene();
      const glm::vec3 middle(away * size, -away * size, 0.37f * size);
      // Tilted, so that no coordinate is exact.
      test::add_quad(scene.surroundings[0], middle - glm::vec3(size, size, 0.1f * size),
                     {2 * size, 0, 0.13f * size}, {0, 2 * size, 0.07f * size});
      const glm::dvec3 normal = glm::normalize(glm::dvec3(scene.surroundings[0].normals[0]));
      const glm::dvec3 flat = glm::normalize(glm::cross(normal, glm::dvec3(1, 2, 0)));
      scene.lights.push_back(test::sun(flat + 0.01 * normal));
      scene.camera.eye_mm = glm::dvec3(middle) + 3.0 * size * normal;
      scene.camera.target_mm = glm::dvec3(middle);
      scene.camera.up = {0, 1, 0};
      scene.camera.fov_rad = 0.2;
      const test::TracedScene traced(std::move(scene));
      int dark = 0;
      for (const glm::vec4& c : traced.render(64, 64).color) dark += c.g < 0.005f ? 1 : 0;
      EXPECT_EQ(dark, 0) << "size " << size << ", away " << away;
    }
}

/// What a point light on the disc of an area light adds at `point` where the part with x > `edge` is seen.
double disc_irradiance(double radius, double height, double x, double edge) {
  constexpr int kSteps = 2000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double u = radius * (2 * (i + 0.5) / kSteps - 1);
    if (u < edge) continue;
    const double half = std::sqrt(radius * radius - u * u), d2 = (u - x) * (u - x) + height * height;
    // Across the edge the square of the distance grows by at most v^2, integrated in closed form:
    // of h / (d2 + v^2)^(3/2) from -half to half.
    sum += 2 * half / (d2 * std::sqrt(d2 + half * half)) * height * 2 * radius / kSteps;
  }
  return 1e6 * sum / (std::numbers::pi * radius * radius);
}

double penumbra_error(int samples) {
  constexpr double kRadius = 100, kHeight = 2000;
  render::Scene scene = test::dark_scene();
  test::add_quad(scene.surroundings[0], {-2000, -2000, 0}, {4000, 0, 0}, {0, 4000, 0});
  test::add_quad(scene.surroundings[0], {-5000, -2000, 1000}, {5000, 0, 0}, {0, 4000, 0});
  render::Light light{render::LightKind::area, {0, 0, -1}, {0, 0, kHeight}};
  light.radius_mm = kRadius;
  scene.lights.push_back(light);
  scene.settings.soft_shadow_samples = samples;
  const test::TracedScene traced(std::move(scene));
  const double full = disc_irradiance(kRadius, kHeight, 0, -kRadius);
  double squared = 0;
  int count = 0;
  for (double x = -98.7; x < 100; x += 4.31, ++count) {
    const double error = irradiance(traced, {x, 0, 0}) - disc_irradiance(kRadius, kHeight, x, -x);
    squared += error * error;
  }
  EXPECT_NEAR(irradiance(traced, {120, 0, 0}), disc_irradiance(kRadius, kHeight, 120, -kRadius), 1e-4);
  EXPECT_EQ(irradiance(traced, {-120, 0, 0}), 0);
  return std::sqrt(squared / count) / full;
}

/// The penumbra of a half-plane is the area of a circular segment. N points on a spiral leave an error of
/// order N^(-3/4), as well spread points do at a straight edge (random ones: N^(-1/2)).
TEST(RayShadows, PenumbraOfADiscIsTheSegmentsArea) {
  double last = 0, first = 0;
  for (const int samples : {16, 64, 256, 1024}) {
    const double error = penumbra_error(samples);
    std::cout << "soft shadow, " << samples << " points: rms error " << error << " of full light\n";
    if (first == 0) first = error;
    last = error;
  }
  const double order = std::log(first / last) / std::log(64.0);
  std::cout << "order " << order << "\n";
  EXPECT_GT(order, 0.6);
  EXPECT_LT(first, 0.04);
}

TEST(RayShadows, DirectionalDiscStandsOneMetreAway) {
  render::Scene scene = test::dark_scene();
  test::add_quad(scene.surroundings[0], {-2000, -2000, 0}, {4000, 0, 0}, {0, 4000, 0});
  test::add_quad(scene.surroundings[0], {-5000, -2000, 1000}, {5000, 0, 0}, {0, 4000, 0});
  render::Light light = test::sun({0, 0, 1});
  light.radius_mm = 50;
  scene.lights.push_back(light);
  scene.settings.soft_shadow_samples = 256;
  const test::TracedScene traced(std::move(scene));
  // The edge at 1 m blurs over 50 mm to each side.
  EXPECT_EQ(irradiance(traced, {-51, 0, 0}), 0);
  EXPECT_NEAR(irradiance(traced, {51, 0, 0}), 1, 1e-3);
  EXPECT_NEAR(irradiance(traced, {0.01, 0, 0}), 0.5, 0.02);
}

TEST(RayShadows, SameWithAnyNumberOfThreads) {
  render::Scene scene = test::dark_scene();
  test::add_quad(scene.surroundings[0], {-2000, -2000, 0}, {4000, 0, 0}, {0, 4000, 0});
  test::add_box(scene.surroundings[0], {0, 0, 0}, {100, 100, 200});
  scene.optics.push_back(test::square_optic(optics::OpticKind::mirror, 300, {300, 0, 300}, {-1, 0, 0}));
  scene.optics.push_back(test::square_optic(optics::OpticKind::pane, 200, {-300, 0, 300}));
  scene.optics[1].material.thickness_mm = 20;
  scene.lights.push_back(test::sun({-0.5, -0.25, 1}));
  scene.lights[0].radius_mm = 60;
  scene.lights.push_back({render::LightKind::point, {}, {-600, 300, 900}});
  scene.camera = {{-800, -900, 700}, {0, 0, 0}, {0, 0, 1}, 0.9, {96, 64}};
  const test::TracedScene traced(std::move(scene));
  EXPECT_EQ(traced.render(96, 64, 1, 1).color, traced.render(96, 64, 1, 5).color);
}

}  // namespace
}  // namespace catoptra
