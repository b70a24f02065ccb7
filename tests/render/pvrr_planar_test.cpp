// A plane mirror, where PVRR has no error of its own: what differs from the ray tracer is drawing.
#include <gtest/gtest.h>

#include "render/comparison.h"
#include "render/renderer.h"
#include "tests/render/raster_test_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

Scene plane_mirror_room() {
  Scene scene = room();
  scene.optics.push_back(conic_mirror(0, 0, 170, 110, 2, 2));
  scene.camera.eye_mm = {-150, 60, 800};
  return scene;
}

// Float hit distances and float directions leave a few 1e-3 arcmin; a tenth of a pixel is what is promised.
TEST(PvrrPlane, FourVerticesShowTheExactPointInEveryPixel) {
  const Scene scene = plane_mirror_room();
  Renderer renderer(scene);
  const Frame exact = renderer.render(Mode::raytrace, scene.camera, picture_of(scene)).frame;
  const RenderResult pvrr = renderer.render(Mode::pvrr, scene.camera, picture_of(scene));
  EXPECT_EQ(pvrr.stats.optics.at(0).vertices, 4u);
  EXPECT_TRUE(pvrr.warnings.empty());
  const Comparison comparison = compare(exact, pvrr.frame, scene);
  ASSERT_GT(comparison.optics.at(0).pixels, 5000u);
  EXPECT_EQ(comparison.optics.at(0).outline_pixels, 0u);
  EXPECT_LT(comparison.optics.at(0).screen_px.max, 0.1);
  EXPECT_LT(comparison.optics.at(0).arcmin.max, 0.02);
}

// A plane mirror's map lies on the picture's own pixel grid, so that nothing is resampled: what differs is
// rounding to half floats and pixels whose centre lies on an edge. 45 dB is what is promised, 57 dB and more
// are measured.
TEST(PvrrPlane, PicturesAgreeTo45Decibel) {
  const Scene scene = plane_mirror_room();
  Renderer renderer(scene);
  for (const int samples : {1, 16}) {
    const Frame exact = renderer.render(Mode::raytrace, scene.camera, picture_of(scene, samples)).frame;
    const Frame pvrr = renderer.render(Mode::pvrr, scene.camera, picture_of(scene, samples)).frame;
    EXPECT_GE(image_error(exact, pvrr).psnr_db, 50) << samples << " samples";
  }
}

// The same where the mirror is cut by the picture's border, turned, and seen from the side.
TEST(PvrrPlane, AgreesFromAnyEyeAndAtThePicturesBorder) {
  Scene scene = plane_mirror_room();
  Renderer renderer(scene);
  for (const glm::dvec3& eye :
       {glm::dvec3(600, -50, 300), glm::dvec3(20, 400, 500), glm::dvec3(-40, 10, 150)}) {
    scene.camera.eye_mm = eye;
    scene.camera.target_mm = {70, 30, 0};
    scene.camera.up = {0.3, 1, 0.1};
    const Frame exact = renderer.render(Mode::raytrace, scene.camera, picture_of(scene)).frame;
    const Frame pvrr = renderer.render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
    const OpticError error = compare(exact, pvrr, scene).optics.at(0);
    ASSERT_GT(error.pixels, 500u);
    EXPECT_LT(error.screen_px.max, 0.1) << "eye at " << eye.x;
    EXPECT_GE(image_error(exact, pvrr).psnr_db, 45) << "eye at " << eye.x;
  }
}

// An eye beside the mirror's plane that looks past it, so that the mirror reaches behind the eye: no pixel
// grid then, but the ordinary map.
TEST(PvrrPlane, MirrorThatReachesBehindTheEyeIsStillRight) {
  Scene scene = plane_mirror_room();
  scene.optics[0] = conic_mirror(0, 0, 2000, 1500, 2, 2);
  scene.camera = {{0, 0, 200}, {900, 100, 60}, {0, 1, 0}, 0.8, {320, 240}};
  Renderer renderer(scene);
  const Frame exact = renderer.render(Mode::raytrace, scene.camera, picture_of(scene)).frame;
  const Frame pvrr = renderer.render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
  const OpticError error = compare(exact, pvrr, scene).optics.at(0);
  ASSERT_GT(error.pixels, 5000u);
  EXPECT_LT(error.screen_px.p99, 0.1);
}

TEST(PvrrPlane, ViewpointIsTheEyesMirrorImage) {
  const Scene scene = plane_mirror_room();
  Renderer renderer(scene);
  const RenderResult pvrr = renderer.render(Mode::pvrr, scene.camera, picture_of(scene));
  const PatchStats& patch = pvrr.stats.optics.at(0).patches.at(0);
  EXPECT_LT(glm::distance(patch.viewpoint_mm, glm::dvec3(-150, 60, -800)), 1e-6);
  EXPECT_LT(patch.residual_mm, 1e-6);
}

// Closed form: the ray from the eye through the surface point, its z turned round, meets z = 5000 or the box
// and floor in front of it; only wall pixels are judged, by their z.
TEST(PvrrPlane, WallPointsObeyTheLawOfReflection) {
  const Scene scene = plane_mirror_room();
  Renderer renderer(scene);
  const Frame frame = renderer.render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
  std::size_t judged = 0;
  for (std::size_t i = 0; i < frame.position.size(); ++i) {
    if (frame.optic_id[i] != 0 || std::abs(frame.position[i].z - 5000) > 0.01) continue;
    const glm::dvec3 surface(frame.surface[i]);
    glm::dvec3 d = surface - scene.camera.eye_mm;
    d.z = -d.z;
    const glm::dvec3 expected = surface + (5000 - surface.z) / d.z * d;
    // 0.05 mm at 6 m is 0.03 arcmin.
    EXPECT_LT(glm::distance(expected, glm::dvec3(glm::vec3(frame.position[i]))), 0.05);
    ++judged;
  }
  EXPECT_GT(judged, 1000u);
}

}  // namespace
}  // namespace catoptra::render
