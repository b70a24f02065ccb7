// Mirrors in mirrors, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "optics/reflection.h"
#include "tests/render/ray_chain_scenes.h"

namespace catoptra {
namespace {

using namespace test;

constexpr int kWidth = 160, kHeight = 120;

// ---- Kaleidoscope ----

/// Two mirrors of 4 m whose planes meet in the z axis at an angle, and a cube between them; optic 0 is the
/// plane y = 0 seen from y > 0.
struct Wedge {
  double angle;
  glm::dvec3 normal[2];
  render::Scene scene;
  glm::dvec3 object{420, 150, 30};

  Wedge(double angle_deg, int depth) : angle(angle_deg * std::numbers::pi / 180), scene(dark_scene(depth)) {
    const glm::dvec3 along[2]{{1, 0, 0}, {std::cos(angle), std::sin(angle), 0}};
    normal[0] = {0, 1, 0};
    normal[1] = {std::sin(angle), -std::cos(angle), 0};
    for (int k = 0; k < 2; ++k) scene.optics.push_back(plane_mirror(2000.0 * along[k], normal[k], 4000));
    scene.optics[0].reflectance = {0.9f, 0.5f, 0.7f};
    scene.optics[1].reflectance = {0.6f, 0.8f, 0.9f};
    add_shining_cube(scene, object, 20, {1.0f, 2.0f, 3.0f});
    scene.camera = {{900, 500, 60}, {}, {0, 0, 1}, 0.5, {kWidth, kHeight}};
  }

  /// The image of a point that is seen over mirrors `path`, the first of which is met first.
  glm::dvec3 image(glm::dvec3 point, const std::vector<int>& path) const {
    for (auto k = path.rbegin(); k != path.rend(); ++k) point = mirrored(point, {0, 0, 0}, normal[*k]);
    return point;
  }
};

struct KaleidoscopeCase {
  double angle_deg;
  std::vector<std::vector<int>> paths;  ///< of the images, one each: 360 / angle - 1 of them
};

class Kaleidoscope : public testing::TestWithParam<KaleidoscopeCase> {};

// Between two mirrors at an angle of 360 degrees / n the object and its images, n - 1 in number, stand in a
// ring. Each is looked at by an own camera. Source: Hecht 2017, 5.4.
TEST_P(Kaleidoscope, ImagesStandWhereTheWedgeRepeats) {
  const KaleidoscopeCase& tested = GetParam();
  Wedge wedge(tested.angle_deg, 5);
  ASSERT_EQ(tested.paths.size(), std::size_t(std::lround(360 / tested.angle_deg)) - 1);
  const TracedScene traced(wedge.scene);
  render::Camera camera = wedge.scene.camera;
  camera.fov_rad = 0.02;
  render::FrameOptions options;
  options.width = options.height = 41;
  options.geometry = true;
  for (const std::vector<int>& path : tested.paths) {
    const glm::dvec3 image = wedge.image(wedge.object, path);
    // In polar coordinates the images are at -a and at +-a + k 2 angle.
    const double a = std::atan2(wedge.object.y, wedge.object.x), turn = std::atan2(image.y, image.x),
                 sign = path.size() % 2 == 1 ? -1 : 1;
    const double steps = (turn - sign * a) / (2 * wedge.angle);
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    camera.target_mm = image;
    const render::Frame frame = traced.tracer->render(camera, options).frame;
    const std::size_t middle = 41 * 20 + 20;
    ASSERT_EQ(frame.position[middle].w, 1);
    EXPECT_LT(glm::length(glm::dvec3(frame.position[middle]) - wedge.object), 0.5 * 20 * std::sqrt(3.0));
    EXPECT_EQ(frame.bounces[middle], path.size());
    EXPECT_EQ(frame.optic_id[middle], path[0]);
    glm::vec3 wanted{1, 2, 3};
    for (const int k : path) wanted *= wedge.scene.optics[std::size_t(k)].reflectance;
    EXPECT_LT(glm::length(glm::vec3(frame.color[middle]) - wanted), 1e-6f) << "reflectances multiply";
  }
}

INSTANTIATE_TEST_SUITE_P(Angles, Kaleidoscope,
                         testing::Values(KaleidoscopeCase{90, {{0}, {1}, {1, 0}}},
                                         KaleidoscopeCase{60, {{0}, {1}, {0, 1}, {1, 0}, {0, 1, 0}}}),
                         [](const auto& tested) {
                           return "Degrees" + std::to_string(int(tested.param.angle_deg));
                         });

// Whatever the path, what is shown and its image by the path's mirrors lie on the eye's ray.
TEST(RayChain, WhatIsShownUnfoldsOntoTheEyesRay) {
  for (const double angle_deg : {90.0, 60.0, 47.0}) {
    Wedge wedge(angle_deg, 8);
    wedge.scene.surroundings.push_back(empty_mesh());
    add_quad(wedge.scene.surroundings.back(), {-3000, -3000, -400}, {6000, 0, 0}, {0, 6000, 0});
    wedge.scene.environment.ambient = 1;
    const TracedScene traced(wedge.scene);
    const render::Frame frame = traced.render(kWidth, kHeight);
    std::map<std::uint32_t, std::vector<int>> paths;
    for (int first : {0, 1}) {
      std::vector<int> path;
      for (int k = 0; k < 8; ++k) {
        path.push_back((first + k) % 2);
        paths[path_by(path)] = path;
      }
    }
    std::map<std::size_t, int> by_bounces;
    for (std::size_t i = 0; i < frame.color.size(); ++i) {
      if (frame.optic_id[i] < 0 || frame.position[i].w == 0) continue;
      ASSERT_TRUE(paths.contains(frame.path[i]));
      const std::vector<int>& path = paths[frame.path[i]];
      ASSERT_EQ(frame.bounces[i], path.size());
      ++by_bounces[path.size()];
      const glm::dvec3 image = wedge.image(glm::dvec3(frame.position[i]), path);
      const glm::dvec3 seen = glm::normalize(image - wedge.scene.camera.eye_mm);
      EXPECT_LT(glm::length(seen - ray_of(wedge.scene.camera, kWidth, kHeight, i)), 2e-6)
          << "floats hold 4 m to 2e-4 mm";
      // The last direction is the eye's turned back.
      glm::dvec3 direction = ray_of(wedge.scene.camera, kWidth, kHeight, i);
      for (const int k : path) direction = optics::reflect(direction, wedge.normal[k]);
      EXPECT_LT(glm::length(glm::dvec3(frame.direction[i]) - direction), 2e-7);
      // The last point lies in the last mirror, and what is shown beyond it along that direction.
      const glm::dvec3 surface(frame.surface[i]);
      EXPECT_LT(std::abs(glm::dot(surface, wedge.normal[path.back()])), 3e-4);
      const glm::dvec3 way = glm::dvec3(frame.position[i]) - surface;
      EXPECT_LT(glm::length(way - glm::length(way) * direction), 2e-3) << "mm";
    }
    EXPECT_GE(by_bounces.size(), 2u);
    for (const auto& [bounces, count] : by_bounces) EXPECT_GT(count, 50) << bounces;
  }
}

// ---- A hall of mirrors ----

// Between parallel mirrors at z = 0 and z = L, objects at z have their images over n mirrors, seen towards
// -z, at -z, z - 2 L, -z - 2 L, z - 4 L, ...
TEST(RayChain, ParallelMirrorsRepeatTheObjectAtTheClosedForm) {
  constexpr double kLength = 1000, kAt = 300;
  constexpr int kDepth = 7;
  render::Scene scene = dark_scene(kDepth);
  scene.optics.push_back(plane_mirror({0, 0, 0}, {0, 0, 1}, 3000));
  scene.optics.push_back(plane_mirror({0, 0, kLength}, {0, 0, -1}, 3000));
  scene.optics[0].reflectance = glm::vec3(0.9f);
  scene.optics[1].reflectance = glm::vec3(0.8f);
  const glm::dvec3 object(200, 0, kAt);
  add_shining_cube(scene, object, 16, glm::vec3(1));
  scene.camera = {{-150, 40, 600}, {-100, 20, 0}, {0, 1, 0}, 1.2, {640, 480}};
  const TracedScene traced(scene);
  const render::Frame frame = traced.render(640, 480);
  double reflectance = 1;
  for (int n = 1; n <= kDepth; ++n) {
    reflectance *= n % 2 == 1 ? 0.9 : 0.8;
    const int half = n / 2;
    const double z = n % 2 == 1 ? -kAt - 2 * half * kLength : kAt - 2 * half * kLength;
    const std::size_t i = pixel_of(scene.camera, 640, 480, {object.x, object.y, z});
    ASSERT_EQ(frame.position[i].w, 1) << n;
    EXPECT_LT(glm::length(glm::dvec3(frame.position[i]) - object), 0.5 * 16 * std::sqrt(3.0)) << n;
    EXPECT_EQ(frame.bounces[i], n);
    EXPECT_NEAR(frame.color[i].g, reflectance, 1e-6) << n;
  }
}

// The mirror after the last that counts is a plain body: its reflectance as albedo under the ambient light.
TEST(RayChain, WhenTheDepthIsUsedUpAMirrorIsAPlainBody) {
  for (const int depth : {1, 2, 5}) {
    render::Scene scene = dark_scene(depth);
    scene.environment.ambient = 0.5f;
    scene.optics.push_back(plane_mirror({0, 0, 0}, {0, 0, 1}, 3000));
    scene.optics.push_back(plane_mirror({0, 0, 1000}, {0, 0, -1}, 3000));
    scene.optics[0].reflectance = glm::vec3(0.9f);
    scene.optics[1].reflectance = glm::vec3(0.8f);
    scene.camera = {{-150, 40, 600}, {-150, 40, 0}, {0, 1, 0}, 0.05, {kWidth, kHeight}};
    const TracedScene traced(scene);
    const render::Frame frame = traced.render(kWidth, kHeight);
    const std::size_t i = kWidth * kHeight / 2 + kWidth / 2;
    double wanted = 0.5 * (depth % 2 == 1 ? 0.8 : 0.9);
    for (int n = 1; n <= depth; ++n) wanted *= n % 2 == 1 ? 0.9 : 0.8;
    EXPECT_NEAR(frame.color[i].r, wanted, 1e-6) << depth;
    EXPECT_EQ(frame.bounces[i], depth);
    EXPECT_NEAR(frame.position[i].z, depth % 2 == 1 ? 1000 : 0, 1e-3);
  }
}

// ---- Curved mirrors ----

// Over a plane mirror at 45 degrees the eye sees a sphere and, in it, over the plane again, a wall. Close to
// the axis a ray of slope u that arrives at height y leaves a mirror of radius R with u + 2 y / R (convex R >
// 0).
TEST(RayChain, PlaneAndSphereMirrorMagnifyAsTheMirrorEquationSays) {
  constexpr double kEyeToPlane = 500, kPlaneToSphere = 400, kWall = 3000;
  for (const double radius : {1200.0, 250.0, -4000.0}) {
    render::Scene scene = dark_scene(3);
    scene.environment.ambient = 1;
    const double root = std::sqrt(0.5);
    scene.optics.push_back(plane_mirror({0, 0, kPlaneToSphere}, {-root, 0, -root}, 300));
    scene.optics.push_back(facing(conic_mirror(radius, 0, 60, 60, 9, 9), {0, 0, 0}, {0, 0, 1}));
    scene.surroundings.push_back(empty_mesh());
    add_quad(scene.surroundings[0], {float(-kWall), -500, -500}, {0, 1000, 0}, {0, 0, 1500});
    scene.camera = {{-kEyeToPlane, 0, kPlaneToSphere}, {0, 0, kPlaneToSphere}, {0, 0, 1}, 0.004, {320, 240}};
    const TracedScene traced(scene);
    const render::Frame frame = traced.render(320, 240);
    const render::CameraRays rays = render::camera_rays(scene.camera, 320, 240);
    const auto at = [&](int column, int row) { return std::size_t(row * 320 + column); };
    const std::size_t a = at(60, 120), b = at(260, 120);
    ASSERT_EQ(frame.path[a], path_by({0, 1, 0}));
    const double seen = (frame.position[b].y - frame.position[a].y) /
                        (rays.direction(260, 120).y - rays.direction(60, 120).y);
    const double arm = kEyeToPlane + kPlaneToSphere, back = kPlaneToSphere + kWall;
    const double wanted = arm + back * (1 + 2 * arm / radius);
    EXPECT_NEAR(seen / wanted, 1, 1e-4) << radius;
  }
}

/// Follows a ray within a sphere around `center`, as long as it meets the rectangle x, y of it below z = 0.
struct SphereBounces {
  glm::dvec3 surface{0}, direction{0};
  int count = 0;
};
SphereBounces bounces_in_sphere(glm::dvec3 from, glm::dvec3 direction, double radius, double half_width,
                                double half_height, int depth) {
  SphereBounces result;
  const glm::dvec3 center(0, 0, radius);
  while (result.count < depth) {
    const glm::dvec3 o = from - center;
    const double b = glm::dot(o, direction), t = -b + std::sqrt(b * b - glm::dot(o, o) + radius * radius);
    const glm::dvec3 at = from + t * direction;
    if (!(std::abs(at.x) < half_width && std::abs(at.y) < half_height && at.z < radius)) break;
    from = result.surface = at;
    result.direction = direction = optics::reflect(direction, (center - at) / radius);
    ++result.count;
  }
  return result;
}

// A hollow sphere of short radius shows itself in itself.
TEST(RayChain, HollowMirrorSeesItselfAsTheSphereSays) {
  constexpr double kRadius = 110;
  render::Scene scene = dark_scene(6);
  scene.optics.push_back(conic_mirror(-kRadius, 0, 200, 60, 161, 41));
  scene.camera = {{90, 5, 300}, {75, 0, 40}, {0, 1, 0}, 0.3, {kWidth, kHeight}};
  const TracedScene traced(scene);
  const render::Frame frame = traced.render(kWidth, kHeight);
  std::map<int, int> counts;
  int different = 0;
  for (std::size_t i = 0; i < frame.color.size(); ++i) {
    if (frame.optic_id[i] < 0) continue;
    const auto wanted =
        bounces_in_sphere(scene.camera.eye_mm, ray_of(scene.camera, kWidth, kHeight, i), kRadius, 100, 30, 6);
    ++counts[wanted.count];
    if (frame.bounces[i] != wanted.count) {
      ++different;
      continue;
    }
    EXPECT_LT(glm::length(glm::dvec3(frame.surface[i]) - wanted.surface), 2e-4)
        << "errors grow 3-fold a bounce";
    EXPECT_LT(glm::length(glm::dvec3(frame.direction[i]) - wanted.direction), 2e-6);
  }
  EXPECT_GT(counts[1], 1000);
  EXPECT_GT(counts[2], 300);
  EXPECT_GT(counts[3], 20);
  EXPECT_LT(different, 0.01 * kWidth * kHeight) << "along the outline, where the mesh decides";
}

TEST(RayChain, AnyNumberOfThreadsAndListedPixelsGiveTheSame) {
  Wedge wedge(60, 6);
  wedge.scene.environment.ambient = 1;
  wedge.scene.optics.push_back(facing(conic_mirror(-300, 0, 200, 200, 21, 21), {1500, 700, 0}, {-1, 0, 0}));
  const TracedScene traced(wedge.scene);
  const render::Frame one = traced.render(kWidth, kHeight, 3, 1), two = traced.render(kWidth, kHeight, 3, 2);
  EXPECT_EQ(one.color, two.color);
  EXPECT_EQ(one.position, two.position);
  EXPECT_EQ(one.path, two.path);
  EXPECT_EQ(one.bounces, two.bounces);
  render::FrameOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.samples = 3;
  options.geometry = true;
  render::Frame listed = two;
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t i = 0; i < two.color.size(); i += 7) pixels.push_back(i);
  for (const std::uint32_t i : pixels) {
    listed.color[i] = glm::vec4(-1);
    listed.path[i] = 1;
  }
  (void)traced.tracer->trace_pixels(wedge.scene.camera, options, pixels, listed);
  EXPECT_EQ(listed.color, two.color);
  EXPECT_EQ(listed.path, two.path);
}

}  // namespace
}  // namespace catoptra
