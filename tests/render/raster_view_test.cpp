// Views: where points fall in the picture, and which directions its corners show.
#include "render/src/raster_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "cad_import/error.h"

namespace catoptra::render {
namespace {

constexpr Camera kCamera{{100, -700, 150}, {0, 0, 0}, {0, 0, 1}, 0.7, {640, 480}};

TEST(RasterView, TargetIsThePicturesCentreAndRightIsRight) {
  const RasterView view = camera_view(kCamera, {640, 480});
  const glm::dvec3 center = view.pixel(kCamera.target_mm);
  EXPECT_NEAR(center.x, 320, 1e-9);
  EXPECT_NEAR(center.y, 240, 1e-9);
  EXPECT_NEAR(center.z, glm::length(kCamera.eye_mm), 1e-9);
  // Looking along +y with z up, +x is to the right and +z towards row 0.
  EXPECT_GT(view.pixel({50, 0, 0}).x, 320);
  EXPECT_LT(view.pixel({0, 0, 50}).y, 240);
  EXPECT_LT(view.pixel({0, -2000, 0}).z, 0) << "behind the eye";
}

TEST(RasterView, DirectionsAgreeWithPixels) {
  const RasterView view = camera_view(kCamera, {640, 480}, {0.3, -0.2});
  const auto [center, dx, dy] = view.directions();
  for (const glm::dvec2 ndc : {glm::dvec2(-1, -1), glm::dvec2(0.3, 0.8), glm::dvec2(1, 0)}) {
    const glm::dvec3 pixel = view.pixel(view.origin_mm + 1234.5 * (center + ndc.x * dx + ndc.y * dy));
    EXPECT_NEAR(pixel.x, (0.5 + 0.5 * ndc.x) * 640, 1e-9);
    EXPECT_NEAR(pixel.y, (0.5 - 0.5 * ndc.y) * 480, 1e-9);
  }
}

TEST(RasterView, SampleOffsetShowsWhatLiesAtThatPlaceInThePixel) {
  const glm::dvec3 point{30, 10, 40};
  const glm::dvec3 centered = camera_view(kCamera, {640, 480}).pixel(point);
  const glm::dvec3 offset = camera_view(kCamera, {640, 480}, {0.3, -0.2}).pixel(point);
  EXPECT_NEAR(offset.x, centered.x - 0.3, 1e-9);
  EXPECT_NEAR(offset.y, centered.y + 0.2, 1e-9);
}

TEST(RasterView, DepthRunsFromOneAtTheNearPlaneToZeroAtInfinity) {
  const RasterView view = camera_view(kCamera, {640, 480});
  const glm::dvec3 ahead = -glm::normalize(kCamera.eye_mm);
  const auto depth = [&](double distance) {
    const glm::dvec4 clip = view.clip_from_relative() * glm::dvec4(distance * ahead, 1);
    return clip.z / clip.w;
  };
  EXPECT_NEAR(depth(kCameraNear), 1, 1e-12);
  EXPECT_NEAR(depth(1e12), 0, 1e-9);
  EXPECT_GT(depth(100), depth(101));
}

TEST(RasterView, CubeFacesLookAlongTheirAxes) {
  const glm::dvec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const glm::dvec3 center{10, 20, 30};
  for (int face = 0; face < 6; ++face) {
    const RasterView view = cube_face_view(center, face, 64);
    const glm::dvec3 pixel = view.pixel(center + 500.0 * axes[face]);
    EXPECT_NEAR(pixel.x, 32, 1e-9);
    EXPECT_NEAR(pixel.y, 32, 1e-9);
    EXPECT_NEAR(pixel.z, 500, 1e-9);
    EXPECT_NEAR(glm::determinant(view.rotation), 1, 1e-12) << "mirrored";
  }
}

TEST(RasterView, CameraAlongItsUpVectorIsAnError) {
  Camera camera = kCamera;
  camera.up = camera.target_mm - camera.eye_mm;
  EXPECT_THROW((void)camera_view(camera, {64, 64}), Error);
  camera = kCamera;
  camera.target_mm = camera.eye_mm;
  EXPECT_THROW((void)camera_view(camera, {64, 64}), Error);
}

}  // namespace
}  // namespace catoptra::render
