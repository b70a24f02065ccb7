// The reference through lenses, against closed forms and against exact paths computed here.
#include <gtest/gtest.h>

#include <array>

#include "tests/render/lens_pvrr_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

RenderResult rendered(const Scene& scene, std::size_t threads = 0, Mode mode = Mode::raytrace) {
  FrameOptions options = picture_of(scene);
  options.threads = threads;
  return Renderer(scene).render(mode, scene.camera, options);
}

std::size_t pixel(const Frame& frame, int column, int row) {
  return std::size_t(row) * std::size_t(frame.width) + std::size_t(column);
}

// A plate of thickness t moves what stands behind it by t tan(a) (1 - cos(a) / (n cos(b))), sin(a) = n
// sin(b), towards the axis, whatever the distance. Source: Snell's law.
TEST(RayLens, PlateShiftsThePictureByTheClosedForm) {
  constexpr double kWall = 1500, kThick = 10, kIndex = 1.5, kEye = 200;
  Scene scene = wall_behind_lens(kEye, 0.4, float(kWall));
  scene.optics.push_back(lens_of(0, 0, kThick, 60, 9));
  const Frame frame = rendered(scene).frame;
  const CameraRays rays = camera_rays(scene.camera, frame.width, frame.height);
  int count = 0;
  for (int row = 0; row < frame.height; row += 7)
    for (int column = 0; column < frame.width; column += 7) {
      const std::size_t i = pixel(frame, column, row);
      if (frame.optic_id[i] != 0) continue;
      const glm::dvec3 d = glm::normalize(rays.direction(column, row));
      const double across = std::hypot(d.x, d.y),
                   tan_b = across / std::sqrt(kIndex * kIndex - across * across);
      const double radius = (kWall + kEye - kThick) * across / d.z + kThick * tan_b;
      const glm::dvec2 wanted = radius / across * glm::dvec2(d);
      // Floats hold coordinates of 1500 mm to 1e-4.
      EXPECT_LT(glm::length(glm::dvec2(frame.position[i]) - wanted), 1e-3);
      EXPECT_LT(glm::length(glm::dvec3(frame.direction[i]) - d), 1e-6);
      ++count;
    }
  EXPECT_GT(count, 500);
}

struct PowerCase {
  double front, back, thickness;
};

// Close to the axis what is seen follows Gaussian optics: surfaces of power (n - 1) / R in steps of the
// reduced thickness t / n. The field is 0.2 degrees, so that its cubic terms are below 1e-4.
TEST(RayLens, MagnifiesAsGaussianOptics) {
  constexpr double kWall = 3000, kEye = 60, kIndex = 1.5;
  for (const auto& [front, back, thickness] : {PowerCase{95.2, 400, 0.5}, PowerCase{400, 95.2, 0.5}}) {
    Scene scene = wall_behind_lens(kEye, 0.004, float(kWall));
    scene.optics.push_back(lens_of(front, back, thickness, 60, 33));
    const Frame frame = rendered(scene).frame;
    const CameraRays rays = camera_rays(scene.camera, frame.width, frame.height);
    const auto seen = [&](int column) { return double(frame.position[pixel(frame, column, 120)].x); };
    const double per_slope =
        (seen(260) - seen(60)) / (rays.direction(260, 120).x - rays.direction(60, 120).x);
    // The ray of slope 1 from the eye, back surface first; both centres lie towards the eye.
    double height = kEye - thickness, slope = 1;
    slope += (kIndex - 1) / back * height;  // n times the slope in the glass
    height += thickness * slope / kIndex;
    slope -= (kIndex - 1) / front * height;
    height += kWall * slope;
    EXPECT_NEAR(per_slope / height, 1, 2e-3) << front;
  }
}

TEST(RayLens, WallIsSeenWhereTheExactPathsLead) {
  for (const auto& [front, back, thickness] : {PowerCase{95.2, 400, 6}, PowerCase{400, 95.2, 2}}) {
    Scene scene = wall_behind_lens(70, 0.6, 3000);
    scene.optics.push_back(lens_of(front, back, thickness, 60, 25));
    const auto errors = wall_errors_px(scene, rendered(scene).frame, 3000, 3);
    ASSERT_GT(errors.size(), 2000u);
    EXPECT_LT(errors.back(), 1e-3);
  }
}

TEST(RayLens, AnyNumberOfThreadsGivesTheSamePicture) {
  Scene scene = room_behind_lens(70, 0.9);
  scene.optics.push_back(lens_of(400, 95.2, 2, 60, 17, 3, optics::abbe_medium(1.6, 30)));
  const RenderResult one = rendered(scene, 1), three = rendered(scene, 3);
  EXPECT_EQ(one.frame.color, three.frame.color);
  EXPECT_EQ(one.frame.position, three.frame.position);
  EXPECT_EQ(one.stats.rays, three.stats.rays);
  // One ray for each pixel, and three more for each that sees through the lens.
  std::size_t through = 0;
  for (const int id : one.frame.optic_id) through += id == 0 ? 1 : 0;
  const auto pixels = double(one.frame.color.size());
  EXPECT_NEAR(double(one.stats.rays), pixels + 3 * double(through), 0.02 * pixels);
}

TEST(RayLens, SixteenWavelengthsLeaveColoursWithoutDispersion) {
  Scene scene = room_behind_lens(70, 0.6);
  scene.optics.push_back(lens_of(400, 95.2, 2, 60, 17, 1));
  const Frame one = rendered(scene).frame;
  scene.optics[0].wavelengths = 16;
  const Frame sixteen = rendered(scene).frame;
  for (std::size_t i = 0; i < one.color.size(); ++i)
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(sixteen.color[i][c], one.color[i][c], 0.01f * std::max(1.0f, one.color[i][c]));
}

/// The column at which `channel` passes half its range along a row.
double edge_column(const Frame& frame, int channel) {
  const auto value = [&](int x) { return frame.color[pixel(frame, x, frame.height / 2)][channel]; };
  const float half = 0.5f * (value(0) + value(frame.width - 1));
  for (int x = 0; x + 1 < frame.width; ++x)
    if ((value(x) - half) * (value(x + 1) - half) <= 0) return x + 0.5;
  return -1;
}

// The prism of a thin lens at a height is power x height, and differs between F and C by its Abbe number's
// share: (n_F - n_C) / (n_d - 1) = 1 / V. An edge at distance `wall` then splits by that, as seen from the
// eye.
TEST(RayLens, EdgeSplitsByPrismOverAbbeNumber) {
  constexpr double kWall = 3000, kEye = 70, kSlope = 0.08, kAbbe = 30;
  const double power = 0.6 * (1 / 95.2 - 1 / 400.0);  // 1/mm, diverging
  const double height = kEye * kSlope, seen_from = kEye + kWall + kWall * power * kEye;
  Scene scene = wall_behind_lens(kEye, 1.6e-5, float(kWall));
  scene.camera.target_mm.x = height;
  scene.camera.resolution = {4000, 4};
  scene.optics.push_back(lens_of(400, 95.2, 0.5, 60, 41, 3, optics::abbe_medium(1.6, kAbbe)));
  add_quad(scene.surroundings[0], {9000, -9000, float(kWall) - 1}, {float(kSlope * seen_from) - 9000, 0, 0},
           {0, 18000, 0}, glm::vec3(0.02f));
  const Frame frame = rendered(scene).frame;
  const CameraRays rays = camera_rays(scene.camera, frame.width, frame.height);
  std::array<double, 3> slopes;
  for (int channel = 0; channel < 3; ++channel) {
    const double column = edge_column(frame, channel);
    ASSERT_GE(column, 0) << channel;
    const glm::dvec3 d = rays.direction(column, 2);
    slopes[std::size_t(channel)] = d.x / d.z;
  }
  const double wanted = power * height / kAbbe * kWall / seen_from;
  EXPECT_NEAR((slopes[0] - slopes[2]) / wanted, 1, 0.02);
  EXPECT_GT(slopes[0], slopes[1]);
  EXPECT_GT(slopes[1], slopes[2]);
}

// Where one optic is all that a path may have, the nearer of two lenses in a row shows what is behind both.
TEST(RayLens, AtDepthOneTheNearestLensCountsAndTheOtherIsAbsent) {
  Scene scene = wall_behind_lens(70, 0.6, 3000);
  scene.settings.depth = 1;
  scene.optics.push_back(lens_of(400, 95.2, 2, 60, 25));
  const Frame alone = rendered(scene).frame;
  optics::Optic behind = lens_of(0, 0, 2, 50, 9);
  for (auto* mesh : {&behind.mesh, &behind.back.mesh})
    for (auto& vertex : mesh->vertices) vertex.position_mm.z += 100;
  behind.faces[0].surface = std::make_shared<BackSurface>(behind.faces[0].surface, 100);
  behind.back.faces[0].surface = std::make_shared<BackSurface>(behind.back.faces[0].surface, 100);
  scene.optics.push_back(behind);
  const Frame both = rendered(scene).frame;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < alone.color.size(); ++i) {
    if (alone.optic_id[i] != 0) continue;
    ++compared;
    ASSERT_EQ(both.color[i], alone.color[i]);
    ASSERT_EQ(both.optic_id[i], 0);
  }
  EXPECT_GT(compared, 30000u);
}

// A thick plate seen from the side: some rays enter it and leave through its rim, which is not drawn here.
TEST(RayLens, BlockedPathsShowTheRimColourByAmbientLight) {
  Scene scene = wall_behind_lens(200, 0.5, 1500);
  scene.camera.eye_mm.x = 150;
  scene.environment.ambient = 0.5f;
  for (const int wavelengths : {1, 3, 16}) {
    optics::Optic plate = lens_of(0, 0, 20, 60, 9, wavelengths);
    plate.rim_color = {0.8f, 0.1f, 0.4f};
    scene.optics = {plate};
    const Frame frame = rendered(scene).frame;
    const ExactPaths paths(scene);
    int blocked = 0;
    for (int row = 0; row < frame.height; row += 3)
      for (int column = 0; column < frame.width; column += 3) {
        if (paths.path(column, row).end != optics::LensPathEnd::rim) continue;
        ++blocked;
        const std::size_t i = pixel(frame, column, row);
        EXPECT_EQ(frame.optic_id[i], -1);
        EXPECT_LT(glm::length(glm::vec3(frame.color[i]) - 0.5f * plate.rim_color), 1e-5f);
      }
    EXPECT_GT(blocked, 100);
  }
}

// A lens between a mirror and what it shows, off the eye's way.
TEST(RayLens, AtDepthOneMirrorsDoNotShowLenses) {
  Scene scene = room();
  scene.settings.depth = 1;
  scene.optics.push_back(conic_mirror(300, 0, 100, 80, 17, 17));
  const Frame alone = rendered(scene).frame;
  optics::Optic lens = lens_of(400, 95.2, 2, 60, 9);
  for (auto* side : {&lens.mesh, &lens.back.mesh})
    for (auto& vertex : side->vertices) vertex.position_mm.z += 900;  // behind the eye
  lens.faces[0].surface = std::make_shared<BackSurface>(lens.faces[0].surface, 900);
  lens.back.faces[0].surface = std::make_shared<BackSurface>(lens.back.faces[0].surface, 900);
  scene.optics.push_back(lens);
  const Frame with = rendered(scene).frame;
  EXPECT_EQ(with.color, alone.color);
  EXPECT_EQ(with.position, alone.position);
}

}  // namespace
}  // namespace catoptra::render
