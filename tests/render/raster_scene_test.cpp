// The raster picture of a scene without mirrors is the ray tracer's: the two descriptions of the shading are
// one.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/common.hpp>

#include "cad_import/error.h"
#include "render/comparison.h"
#include "render/renderer.h"
#include "tests/render/raster_test_scene.h"
#include "tests/support/temporary_image.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

Frame painted(int width, int height, auto&& color_at) {
  Frame frame;
  frame.width = width;
  frame.height = height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) frame.color.push_back(glm::vec4(color_at(x, y), 1));
  return frame;
}

glm::vec3 checks(int x, int y) {
  return (x / 16 + y / 16) % 2 ? glm::vec3(0.9f, 0.2f, 0.1f) : glm::vec3(0.1f, 0.3f, 0.8f * float(y) / 256);
}

struct Difference {
  double psnr_db = 0;
  std::size_t pixels = 0;  ///< in which a channel differs by more than the half-float target's rounding
};

Difference from_raytrace(const Scene& scene, int samples = 1) {
  Renderer renderer(scene);
  const Frame exact = renderer.render(Mode::raytrace, scene.camera, picture_of(scene, samples)).frame;
  const Frame raster = renderer.render(Mode::pvrr, scene.camera, picture_of(scene, samples)).frame;
  Difference difference{image_error(exact, raster).psnr_db, 0};
  for (std::size_t i = 0; i < exact.color.size(); ++i) {
    const glm::vec4 d = glm::abs(exact.color[i] - raster.color[i]);
    difference.pixels += std::max({d.r, d.g, d.b}) > 2e-3f;
  }
  return difference;
}

// Of 76,800 pixels, those whose sample lies within rounding of an edge may fall on either side of it (5 are
// measured).
constexpr std::size_t kPixelsOnEdges = 12;

TEST(RasterScene, LightsAndColoursAreTheRayTracers) {
  Scene scene = room();
  scene.camera = {{-1500, 900, -500}, {200, -300, 3000}, {0, 1, 0}, 0.9, {320, 240}};
  EXPECT_LE(from_raytrace(scene).pixels, kPixelsOnEdges);
}

TEST(RasterScene, SamplesOfAPixelLieWhereTheRayTracersDo) {
  Scene scene = room();
  scene.camera = {{-1500, 900, -500}, {200, -300, 3000}, {0.2, 1, 0}, 0.9, {320, 240}};
  EXPECT_LE(from_raytrace(scene, 7).pixels, 7 * kPixelsOnEdges);
}

TEST(RasterScene, FarFromTheWorldsOriginNothingTrembles) {
  Scene scene = room();
  scene.camera = {{-1500, 900, -500}, {200, -300, 3000}, {0, 1, 0}, 0.9, {320, 240}};
  const glm::vec3 far_away(3e6f, -2e6f, 5e5f);  // 3.7 km, where a float still resolves 0.25 mm
  for (auto& position : scene.surroundings[0].positions) position += far_away;
  for (auto& light : scene.lights) light.position_mm += glm::dvec3(far_away);
  scene.camera.eye_mm += glm::dvec3(far_away);
  scene.camera.target_mm += glm::dvec3(far_away);
  // The ray tracer's packets are float too: a few more pixels at edges fall on the other side.
  EXPECT_GT(from_raytrace(scene).psnr_db, 40);
}

TEST(RasterScene, TexturesHaveTheSameLevelOfDetail) {
  const TemporaryImage image("texture.png", painted(256, 256, checks));
  Scene scene = room();
  scene.surroundings[0] = {};
  add_quad(scene.surroundings[0], {4000, -900, 6000}, {-8000, 0, 0}, {0, 3400, 0}, glm::vec3(1), 0);
  add_quad(scene.surroundings[0], {-3000, -900, 6000}, {6000, 0, 0}, {0, 0, -6000}, glm::vec3(0.9f, 1, 0.8f),
           0);
  for (auto& st : scene.surroundings[0].texture_coordinates) st *= 4.0f;
  scene.surroundings[0].textures.push_back({"checks", image.path().string(), {}});
  scene.camera = {{-700, 500, -500}, {200, -300, 3000}, {0, 1, 0}, 0.9, {320, 240}};
  // Trilinear weights have 8 bits in the raster passes; the level's formula differs in the last bits.
  EXPECT_GT(from_raytrace(scene).psnr_db, 40);
}

TEST(RasterScene, AlphaTestLeavesTheSameHoles) {
  Scene scene = room();
  auto& mesh = scene.surroundings[0];
  add_quad(mesh, {-500, -500, 2000}, {1000, 0, 0}, {0, 1000, 0}, kGreen);
  mesh.materials.back().alpha = 0.4f;
  mesh.materials.back().alpha_cutoff = 0.5f;
  scene.camera = {{13, 7, 0}, {3, -5, 3000}, {0, 1, 0}, 0.9, {320, 240}};
  EXPECT_LE(from_raytrace(scene).pixels, kPixelsOnEdges);
  // With a cutoff below its alpha the quad is there.
  mesh.materials.back().alpha_cutoff = 0.3f;
  EXPECT_LE(from_raytrace(scene).pixels, kPixelsOnEdges);
}

TEST(RasterScene, SkyLiesInItsTrueDirection) {
  const TemporaryImage sky("sky.png", painted(64, 32, [](int x, int y) {
                             return glm::vec3(float(x) / 64, float(y) / 32,
                                              (x / 8 + y / 8) % 2 ? 0.8f : 0.1f);
                           }));
  Scene scene;
  scene.environment.sky = sky.path().string();
  for (const glm::dvec3& target :
       {glm::dvec3(0, 1, 0), glm::dvec3(1, 0.2, 0.3), glm::dvec3(-0.3, -1, -0.5)}) {
    scene.camera = {{0, 0, 0}, target, {0, 0, 1}, 1.2, {320, 240}};
    EXPECT_GT(from_raytrace(scene).psnr_db, 45)
        << "towards " << target.x << " " << target.y << " " << target.z;
  }
}

TEST(RasterScene, GeometryIsTheWorldPointOfEveryPixel) {
  Scene scene = room();
  scene.camera = {{-1500, 900, -500}, {200, -300, 3000}, {0, 1, 0}, 0.9, {320, 240}};
  Renderer renderer(scene);
  const Frame exact = renderer.render(Mode::raytrace, scene.camera, picture_of(scene)).frame;
  const Frame raster = renderer.render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
  std::size_t far_off = 0;
  for (std::size_t i = 0; i < exact.position.size(); ++i) {
    const double angle = angle_arcmin(shown_direction(exact, i, scene.camera.eye_mm),
                                      shown_direction(raster, i, scene.camera.eye_mm));
    far_off += angle > 0.05 || exact.position[i].w != raster.position[i].w;  // a pixel is 13 arcmin
  }
  EXPECT_LE(far_off, 3u) << "pixels that are not on an edge";
}

TEST(RasterScene, PictureIsTheSameEveryTime) {
  Scene scene = room();
  scene.optics.push_back(conic_mirror(800, 0, 170, 110, 7, 7));
  Renderer first(scene), second(scene);
  const auto options = picture_of(scene, 2);
  const Frame a = first.render(Mode::pvrr, scene.camera, options).frame;
  Camera elsewhere = scene.camera;
  elsewhere.eye_mm.x += 100;
  (void)first.render(Mode::pvrr, elsewhere, options);
  const Frame b = first.render(Mode::pvrr, scene.camera, options).frame;
  const Frame c = second.render(Mode::pvrr, scene.camera, options).frame;
  EXPECT_EQ(a.color, b.color) << "after another picture";
  EXPECT_EQ(a.color, c.color) << "from another renderer";
}

TEST(RasterScene, TooManyLightsOrNoPixelsAreErrors) {
  Scene scene = room();
  FrameOptions options = picture_of(scene);
  options.width = 0;
  EXPECT_THROW((void)Renderer(scene).render(Mode::pvrr, scene.camera, options), Error);
  scene.lights.resize(65);
  EXPECT_THROW((void)Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene)), Error);
}

}  // namespace
}  // namespace catoptra::render
