// Colours of the reference picture: lights, textures, alpha, sky.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "render/src/sampling.h"
#include "tests/render/ray_scenes.h"

namespace catoptra {
namespace {

/// A wall at z = 0, `half` mm to each side, facing the camera at (0, 0, distance).
render::Scene wall_scene(double distance, float half) {
  render::Scene scene;
  scene.surroundings.push_back(test::empty_mesh());
  test::add_quad(scene.surroundings[0], {-half, half, 0}, {0, -2 * half, 0}, {2 * half, 0, 0});
  scene.environment = {{0.2f, 0.3f, 0.4f}, "", 0};
  scene.camera = {{0, 0, distance}, {0, 0, 0}, {0, 1, 0}, 0.5, {64, 64}};
  return scene;
}

glm::vec3 middle(const render::Frame& frame) {
  return glm::vec3(
      frame.color[std::size_t(frame.height / 2) * std::size_t(frame.width) + std::size_t(frame.width / 2)]);
}

glm::vec3 mean(const render::Frame& frame) {
  glm::dvec3 sum(0);
  for (const glm::vec4& c : frame.color) sum += glm::dvec3(c);
  return glm::vec3(sum / double(frame.color.size()));
}

double rms_difference(const render::Frame& a, const render::Frame& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.color.size(); ++i) {
    const glm::dvec3 d = glm::dvec3(a.color[i]) - glm::dvec3(b.color[i]);
    sum += glm::dot(d, d);
  }
  return std::sqrt(sum / double(a.color.size()));
}

TEST(RayTracerShading, LambertAmbientAndEmission) {
  render::Scene scene = wall_scene(1000, 2000);
  scene.surroundings[0].materials[0].base_color = {0.5f, 0.25f, 1};
  scene.surroundings[0].materials[0].emissive = {0, 0, 0.125f};
  scene.environment.ambient = 0.3f;
  render::Light& light = scene.lights.emplace_back();
  light.direction = {0, -std::sin(1.0), -std::cos(1.0)};
  light.color = {1, 0.5f, 1};
  light.intensity = 2;
  const glm::vec3 c = middle(test::TracedScene(std::move(scene)).render(64, 64));
  const float cosine = float(std::cos(1.0));
  EXPECT_NEAR(c.r, 0.5f * (0.3f + 2 * cosine), 1e-6);
  EXPECT_NEAR(c.g, 0.25f * (0.3f + cosine), 1e-6);
  EXPECT_NEAR(c.b, 0.125f + 0.3f + 2 * cosine, 1e-6);
}

TEST(RayTracerShading, PointLightFallsOffWithTheSquareOfDistance) {
  render::Scene scene = wall_scene(1000, 2000);
  render::Light& light = scene.lights.emplace_back();
  light.kind = render::LightKind::point;
  light.intensity = 1;
  light.position_mm = {0, 0, 2000};
  const render::Frame frame = test::TracedScene(std::move(scene)).render(63, 63);
  EXPECT_NEAR(middle(frame).g, 0.25, 1e-6) << "1 at 1 m, so a quarter at 2 m";
}

TEST(RayTracerShading, BothSidesOfATriangleAreLitFromTheViewersSide) {
  for (const double side : {1.0, -1.0}) {
    render::Scene scene = wall_scene(side * 1000, 2000);
    scene.lights.emplace_back().direction = {0, 0, -1};
    const glm::vec3 c = middle(test::TracedScene(std::move(scene)).render(64, 64));
    EXPECT_NEAR(c.g, side > 0 ? 1 : 0, 1e-6) << "the light shines on the +z side";
  }
}

TEST(RayTracerShading, TexturesLieTheRightWayUp) {
  // Top left of the picture red, top right green, bottom left blue, bottom right white.
  const test::TemporaryImage image("corners.png", test::painted(64, [](int column, int row) {
                                     if (row < 32)
                                       return column < 32 ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
                                     return column < 32 ? glm::vec3(0, 0, 1) : glm::vec3(1);
                                   }));
  render::Scene scene = wall_scene(1000, 100);
  auto& mesh = scene.surroundings[0];
  mesh.textures.push_back({"corners", image.path().string(), {}});
  mesh.materials[0].texture = 0;
  mesh.texture_coordinates = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};  // the corners in the order of add_quad
  scene.environment.ambient = 1;
  const render::Frame frame = test::TracedScene(std::move(scene)).render(64, 64);
  const auto at = [&](int column, int row) { return glm::vec3(frame.color[std::size_t(row * 64 + column)]); };
  EXPECT_EQ(at(24, 24), glm::vec3(1, 0, 0));
  EXPECT_EQ(at(39, 24), glm::vec3(0, 1, 0));
  EXPECT_EQ(at(24, 39), glm::vec3(0, 0, 1));
  EXPECT_EQ(at(39, 39), glm::vec3(1));
}

TEST(RayTracerShading, AlphaTestCutsHoles) {
  // Alpha 1 in the left half of the picture and 0 in the right half; behind it stands a white wall.
  render::Frame leaf = test::painted(64, [](int, int) { return glm::vec3(0.25f, 0.5f, 0); });
  for (std::size_t i = 0; i < leaf.color.size(); ++i) leaf.color[i].a = i % 64 < 32 ? 1.0f : 0.0f;
  const test::TemporaryImage image("leaf.exr", leaf);
  render::Scene scene = wall_scene(1000, 2000);
  auto& mesh = scene.surroundings[0];
  mesh.textures.push_back({"leaf", image.path().string(), {}});
  mesh.materials.emplace_back();
  mesh.materials[1].base_color = glm::vec3(1);
  mesh.materials[1].texture = 0;
  mesh.materials[1].alpha_cutoff = 0.5f;
  mesh.materials[1].wrap = cad_import::TextureWrap::clamp;
  test::add_quad(mesh, {-100, -100, 300}, {200, 0, 0}, {0, 200, 0}, 1);
  scene.environment.ambient = 1;
  const render::Frame frame = test::TracedScene(std::move(scene)).render(64, 64);
  const auto at = [&](int column) { return glm::vec3(frame.color[std::size_t(32 * 64 + column)]); };
  EXPECT_NEAR(at(24).g, 0.5f, 0.005) << "8-bit sRGB";
  EXPECT_NEAR(at(24).b, 0, 1e-6);
  EXPECT_EQ(at(40), glm::vec3(1));
}

TEST(RayTracerShading, FarTexturesTakeTheirMeanColor) {
  const test::TemporaryImage image("fine.png", test::painted(256, [](int column, int row) {
                                     return glm::vec3(float((column + row) % 2));
                                   }));
  render::Scene scene = wall_scene(20000, 8000);
  scene.surroundings[0].textures.push_back({"fine", image.path().string(), {}});
  scene.surroundings[0].materials[0].texture = 0;
  for (glm::vec2& st : scene.surroundings[0].texture_coordinates)
    st *= 10;  // 6.25 mm a texel, 160 mm a pixel
  scene.environment.ambient = 1;
  const test::TracedScene traced(std::move(scene));
  const render::Frame frame = traced.render(64, 64);
  for (const glm::vec4& c : frame.color)
    EXPECT_NEAR(c.g, 0.5, 0.005) << "one texel in two is white; 8-bit mips";
}

/// A checkered wall in a convex mirror of strong curvature, at an angle. The level of detail must follow the
/// mirror's minification: without it single samples would alias.
TEST(RayTracerShading, LevelOfDetailFollowsTheMirrorsMinification) {
  const test::TemporaryImage image("checker.png", test::checker(512, 8));
  render::Scene scene;
  scene.surroundings.push_back(test::empty_mesh());
  test::add_quad(scene.surroundings[0], {-6000, -6000, 3000}, {0, 12000, 0}, {12000, 0, 0}, 0, 4);
  scene.surroundings[0].textures.push_back({"checker", image.path().string(), {}});
  scene.surroundings[0].materials[0].texture = 0;
  scene.environment.ambient = 1;
  scene.optics.push_back(test::conic_mirror(300, 0, 120, 120, 15, 15));
  scene.camera = {{250, 0, 700}, {0, 0, 0}, {0, 1, 0}, 0.12, {96, 96}};
  const test::TracedScene traced(std::move(scene));
  const render::Frame one = traced.render(96, 96, 1), many = traced.render(96, 96, 64);
  // The squares' contrast is 0.9 - 0.05 in red; an isotropic filter keeps a single sample within a sixth of
  // it.
  EXPECT_LT(rms_difference(one, many), 0.15);
  EXPECT_LT(glm::length(mean(one) - mean(many)), 0.01);
}

TEST(SampleOffset, StartsAtTheCenterAndDoesNotShiftThePicture) {
  for (const int samples : {1, 3, 4, 5, 8, 16, 64, 255}) {
    glm::dvec2 sum(0);
    EXPECT_EQ(render::sample_offset(0, samples), glm::dvec2(0));
    for (int i = 0; i < samples; ++i) {
      const glm::dvec2 at = render::sample_offset(i, samples);
      EXPECT_LT(std::max(std::abs(at.x), std::abs(at.y)), 0.5);
      sum += at;
    }
    EXPECT_LT(glm::length(sum), 1e-12) << samples;
  }
}

TEST(RayTracerShading, MoreSamplesComeNearerToManySamples) {
  const test::TemporaryImage image("checker.png", test::checker(64, 8));
  render::Scene scene = wall_scene(1000, 300);
  scene.surroundings[0].textures.push_back({"checker", image.path().string(), {}});
  scene.surroundings[0].materials[0].texture = 0;
  scene.environment.ambient = 1;
  scene.camera.up = {0.3, 1, 0};  // so that no edge runs along the pixels
  const test::TracedScene traced(std::move(scene));
  const render::Frame reference = traced.render(64, 64, 400);
  const auto error = [&](int samples) { return rms_difference(traced.render(64, 64, samples), reference); };
  const double e1 = error(1), e4 = error(4), e64 = error(64);
  EXPECT_LT(e4, 0.5 * e1) << "as the square root of the number, or better, the samples being well spread";
  EXPECT_LT(e64, 0.25 * e4);
}

TEST(RayTracerShading, SkyCenterIsPlusYAndRightHalfIsPlusX) {
  // 8 x 4 texels; each a colour of its own by column (red) and row (green).
  render::SkyImage sky;
  sky.width = 8;
  sky.height = 4;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 8; ++column)
      for (const float c : {float(column), float(row), 0.0f}) sky.rgb.push_back(c);
  const auto look = [&](float x, float y, float z) { return render::sky_radiance(sky, {}, {x, y, z}); };
  EXPECT_NEAR(look(0, 1, 0).r, 3.5, 1e-5) << "between columns 3 and 4";
  EXPECT_NEAR(look(0, 1, 0).g, 1.5, 1e-5) << "between rows 1 and 2";
  EXPECT_NEAR(look(3, 0, 0).r, 5.5, 1e-5) << "a quarter of the width to the right";
  EXPECT_NEAR(look(-3, 0, 0).r, 1.5, 1e-5);
  EXPECT_NEAR(look(0, 0.001f, 1).g, 0, 1e-5) << "the top row is +z";
  EXPECT_NEAR(look(0, 0.001f, -1).g, 3, 1e-5);
  EXPECT_NEAR(look(-1e-4f, -1, 0).r, 3.5, 1e-2) << "the seam: half column 7, half column 0";
  EXPECT_EQ(render::sky_radiance({}, {{1, 2, 3}, "", 0}, {0, 0, 1}), glm::vec3(1, 2, 3));
}

TEST(RayTracerShading, SkyShowsAsADirection) {
  render::Scene scene = wall_scene(1000, 10);
  const test::TracedScene traced(std::move(scene));
  const render::Frame frame = traced.render(64, 64);
  EXPECT_EQ(frame.position[0].w, 0);
  EXPECT_NEAR(glm::length(glm::vec3(frame.position[0])), 1, 1e-6);
  EXPECT_EQ(glm::vec3(frame.color[0]), glm::vec3(0.2f, 0.3f, 0.4f));
}

}  // namespace
}  // namespace catoptra
