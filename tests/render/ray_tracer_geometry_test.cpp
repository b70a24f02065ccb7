// What the reference picture shows where, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "cad_import/error.h"
#include "optics/reflection.h"
#include "render/src/sampling.h"
#include "tests/render/ray_scenes.h"

namespace catoptra {
namespace {

constexpr int kWidth = 96, kHeight = 64;

// A float holds a coordinate below 256 mm to 1.5e-5 mm and a unit direction to 6e-8; the picture cannot be
// better.
constexpr double kSurfaceTolerance = 5e-5;    // mm
constexpr double kDirectionTolerance = 2e-7;  // rad

/// A room of differently coloured walls on the +z side of the mirror plane, 4 m deep, open towards -z.
cad_import::TriangleMesh room() {
  cad_import::TriangleMesh mesh = test::empty_mesh();
  for (const glm::vec3 color :
       {glm::vec3(0.8f, 0.1f, 0.1f), glm::vec3(0.1f, 0.8f, 0.1f), glm::vec3(0.1f, 0.1f, 0.8f)})
    mesh.materials.emplace_back().base_color = color;
  test::add_quad(mesh, {-1500, -1000, 4000}, {0, 2000, 0}, {3000, 0, 0}, 1);
  test::add_quad(mesh, {-1500, -1000, 0}, {0, 2000, 0}, {0, 0, 4000}, 2);
  test::add_quad(mesh, {-1500, -1000, 0}, {0, 0, 4000}, {3000, 0, 0}, 3);
  test::add_box(mesh, {200, -1000, 2500}, {300, 700, 300}, 2);
  return mesh;
}

render::Scene mirror_scene(optics::Optic mirror, const glm::dvec3& eye) {
  render::Scene scene;
  scene.surroundings.push_back(room());
  scene.lights.emplace_back().direction = glm::normalize(glm::dvec3(0.3, -0.8, 0.5));
  scene.optics.push_back(std::move(mirror));
  scene.camera = {eye, {0, 0, 0}, {0, 1, 0}, 0.25, {kWidth, kHeight}};
  return scene;
}

/// Unit eye ray through the centre of pixel `i`.
glm::dvec3 eye_ray(const render::Camera& camera, std::size_t i) {
  const auto rays = render::camera_rays(camera, kWidth, kHeight);
  return glm::normalize(rays.direction(double(i % kWidth), double(i / kWidth)));
}

TEST(RayTracerGeometry, PlaneMirrorShowsThePictureOfTheMirroredCamera) {
  const glm::dvec3 eye(350, 120, 700);
  const test::TracedScene mirrored(mirror_scene(test::conic_mirror(0, 0, 170, 110, 3, 3), eye));
  render::Scene direct_scene = mirrored.scene;
  direct_scene.optics.clear();
  direct_scene.camera.eye_mm.z = -eye.z;
  const test::TracedScene direct(std::move(direct_scene));
  const render::Frame a = mirrored.render(kWidth, kHeight), b = direct.render(kWidth, kHeight);
  int compared = 0;
  for (int row = 0; row < kHeight; ++row)
    for (int column = 0; column < kWidth; ++column) {
      const auto i = std::size_t(row * kWidth + column);
      // Seen from behind the mirror left and right change places. The reflectance is 0.9.
      const auto j = std::size_t(row * kWidth + kWidth - 1 - column);
      if (a.optic_id[i] != 0) continue;
      ++compared;
      ASSERT_EQ(a.position[i].w, b.position[j].w);
      EXPECT_LT(glm::length(glm::vec3(a.position[i] - b.position[j])), 2e-3f)
          << "mm, at 4 m in single precision";
      EXPECT_LT(glm::length(glm::vec3(a.color[i]) - 0.9f * glm::vec3(b.color[j])), 1e-5f);
    }
  EXPECT_GT(compared, kWidth * kHeight / 4);
}

class SphereMirror : public testing::TestWithParam<double> {};

TEST_P(SphereMirror, SurfaceAndDirectionAreTheClosedForm) {
  const double radius = GetParam();
  const test::TracedScene traced(
      mirror_scene(test::conic_mirror(radius, 0, 170, 110, 7, 7), {300, 100, 700}));
  const render::Frame frame = traced.render(kWidth, kHeight);
  const glm::dvec3 eye = traced.scene.camera.eye_mm, center(0, 0, -radius);
  int compared = 0;
  for (std::size_t i = 0; i < frame.color.size(); ++i) {
    if (frame.optic_id[i] < 0) continue;
    ++compared;
    const glm::dvec3 d = eye_ray(traced.scene.camera, i), o = eye - center;
    const double b = glm::dot(o, d), root = std::sqrt(b * b - glm::dot(o, o) + radius * radius);
    const glm::dvec3 s = eye + (radius > 0 ? -b - root : -b + root) * d, n = (s - center) / radius;
    const glm::dvec3 r = d - 2 * glm::dot(d, n) * n;
    EXPECT_LT(glm::length(glm::dvec3(frame.surface[i]) - s), kSurfaceTolerance);
    EXPECT_LT(glm::length(glm::dvec3(frame.direction[i]) - r), kDirectionTolerance);
    const glm::dvec3 shown(frame.position[i]);
    const glm::dvec3 seen = frame.position[i].w != 0 ? glm::normalize(shown - s) : shown;
    EXPECT_LT(glm::length(seen - r), 3e-6) << "the point shown lies on the ray to 0.01 arcmin";
  }
  EXPECT_GT(compared, kWidth * kHeight / 4);
}

INSTANTIATE_TEST_SUITE_P(ConvexAndConcave, SphereMirror, testing::Values(1200, 300, -3000, -1200),
                         [](const auto& tested) {
                           return (tested.param > 0 ? "Convex" : "Concave") +
                                  std::to_string(int(std::abs(tested.param)));
                         });

TEST(RayTracerGeometry, ParaboloidSendsRaysFromItsFocusAlongItsAxis) {
  const double radius = 800;
  render::Scene scene = mirror_scene(test::conic_mirror(-radius, -1, 170, 110, 9, 9), {0, 0, radius / 2});
  const test::TracedScene traced(std::move(scene));
  const render::Frame frame = traced.render(kWidth, kHeight);
  int compared = 0;
  for (std::size_t i = 0; i < frame.color.size(); ++i) {
    if (frame.optic_id[i] < 0) continue;
    ++compared;
    EXPECT_LT(glm::length(glm::dvec3(frame.direction[i]) - glm::dvec3(0, 0, 1)), kDirectionTolerance);
  }
  EXPECT_GT(compared, kWidth * kHeight / 2);
}

TEST(RayTracerGeometry, ConvexMirrorMinifiesAsTheFormulaSays) {
  const double distance = 750, radius = 1200, incidence = 30 * std::acos(-1.0) / 180;
  const glm::dvec3 eye(distance * std::sin(incidence), 0, distance * std::cos(incidence));
  const test::TracedScene traced(mirror_scene(test::conic_mirror(radius, 0, 170, 110, 9, 9), eye));
  const render::Frame frame = traced.render(kWidth, kHeight);
  const auto ratio = [&](std::size_t a, std::size_t b) {
    const double eye_angle =
        std::acos(glm::dot(eye_ray(traced.scene.camera, a), eye_ray(traced.scene.camera, b)));
    return eye_angle / glm::length(glm::dvec3(frame.direction[a]) - glm::dvec3(frame.direction[b]));
  };
  // Pixels on both sides of the middle, which lies between two of them; columns run in the plane of
  // incidence.
  const auto middle = std::size_t(kHeight / 2 * kWidth + kWidth / 2);
  const auto m = optics::mirror_magnification(distance, radius, incidence);
  // Single precision over an angle of 0.02 rad, and the formula holds at the middle only: 1 in 1000.
  EXPECT_NEAR(ratio(middle - 2, middle + 1), m.tangential, 1e-3 * m.tangential);
  EXPECT_NEAR(ratio(middle - 2 * kWidth, middle + kWidth), m.sagittal, 1e-3 * m.sagittal);
}

TEST(RayTracerGeometry, OneThreadAndTwoMakeTheSamePicture) {
  const test::TracedScene traced(mirror_scene(test::conic_mirror(1200, 0, 170, 110, 7, 7), {300, 100, 700}));
  const render::Frame one = traced.render(kWidth, kHeight, 3, 1), two = traced.render(kWidth, kHeight, 3, 2);
  EXPECT_EQ(one.color, two.color);
  EXPECT_EQ(one.position, two.position);
  EXPECT_EQ(one.direction, two.direction);
}

TEST(RayTracerGeometry, ListedPixelsAreThoseOfTheWholePicture) {
  const test::TracedScene traced(mirror_scene(test::conic_mirror(1200, 0, 170, 110, 7, 7), {300, 100, 700}));
  const render::Frame whole = traced.render(kWidth, kHeight, 2);
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t i = 0; i < whole.color.size(); ++i)
    if (whole.optic_id[i] >= 0) pixels.push_back(i);
  pixels.push_back(0);  // shows no optic
  render::FrameOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.samples = 2;
  options.geometry = true;
  render::Frame listed;
  listed.width = kWidth;
  listed.height = kHeight;
  listed.color.resize(whole.color.size());
  listed.position.resize(whole.color.size());
  listed.surface.resize(whole.color.size());
  listed.direction.resize(whole.color.size());
  listed.optic_id.resize(whole.color.size(), -1);
  const std::size_t rays = traced.tracer->trace_pixels(traced.scene.camera, options, pixels, listed);
  EXPECT_GE(rays, 2 * pixels.size());
  for (const std::uint32_t i : pixels) {
    EXPECT_EQ(listed.color[i], whole.color[i]);
    EXPECT_EQ(listed.position[i], whole.position[i]);
    EXPECT_EQ(listed.optic_id[i], whole.optic_id[i]);
  }
}

TEST(RayTracerGeometry, MirrorSeenFromBehindIsDark) {
  render::Scene scene = mirror_scene(test::conic_mirror(1200, 0, 170, 110, 5, 5), {0, 0, -700});
  scene.lights.clear();
  scene.environment.ambient = 1;
  const test::TracedScene traced(std::move(scene));
  const render::Frame frame = traced.render(kWidth, kHeight);
  const auto middle = std::size_t(kHeight / 2 * kWidth + kWidth / 2);
  EXPECT_EQ(frame.optic_id[middle], -1);
  EXPECT_NEAR(frame.color[middle].g, render::kOpticBackAlbedo, 1e-6);
}

TEST(RayTracerGeometry, FlippedMirrorReflectsOnTheOtherSide) {
  optics::Optic mirror = test::conic_mirror(0, 0, 170, 110, 3, 3);
  mirror.flip = true;
  render::Scene scene = mirror_scene(std::move(mirror), {0, 0, -700});
  const test::TracedScene traced(std::move(scene));
  const render::Frame frame = traced.render(kWidth, kHeight);
  const auto middle = std::size_t(kHeight / 2 * kWidth + kWidth / 2);
  EXPECT_EQ(frame.optic_id[middle], 0);
  EXPECT_LT(frame.direction[middle].z, -0.99f);
}

TEST(RayTracerGeometry, AtDepthOneAMirrorShowsOtherMirrorsButNotItself) {
  // A concave mirror of short radius, whose own rim its rays would meet, and a second mirror before it.
  render::Scene scene = mirror_scene(test::conic_mirror(-110, 0, 170, 110, 21, 21), {0, 0, 300});
  optics::Optic second = test::conic_mirror(0, 0, 60, 60, 3, 3);
  for (auto& v : second.mesh.vertices)
    v.position_mm.z += 320;  // behind the eye, its reflecting side turned away
  second.reflectance = {0.2f, 0.4f, 0.6f};
  scene.settings.depth = 1;
  scene.surroundings[0] = test::empty_mesh();
  test::add_quad(scene.surroundings[0], {-5000, -5000, 4000}, {0, 10000, 0}, {10000, 0, 0});
  scene.optics.push_back(std::move(second));
  scene.lights.clear();
  scene.environment.ambient = 1;
  const test::TracedScene traced(std::move(scene));
  const render::Frame frame = traced.render(kWidth, kHeight);
  const auto middle = std::size_t(kHeight / 2 * kWidth + kWidth / 2);
  EXPECT_EQ(frame.optic_id[middle], 0);
  EXPECT_NEAR(frame.position[middle].z, 320, 1);
  EXPECT_NEAR(frame.color[middle].g, 0.9f * render::kOpticBackAlbedo, 1e-5);
  for (std::size_t i = 0; i < frame.color.size(); ++i) {
    const float z = frame.position[i].z;
    if (frame.optic_id[i] != 0 || frame.position[i].w == 0) continue;
    EXPECT_TRUE(std::abs(z - 320) < 1 || z > 3999) << z;
  }
}

TEST(RayTracerGeometry, CamerasWithoutAPictureAreErrors) {
  render::Camera camera;
  camera.up = camera.target_mm - camera.eye_mm;
  EXPECT_THROW((void)render::camera_rays(camera, 8, 8), Error);
  camera = {};
  camera.target_mm = camera.eye_mm;
  EXPECT_THROW((void)render::camera_rays(camera, 8, 8), Error);
  camera = {};
  camera.fov_rad = 4;
  EXPECT_THROW((void)render::camera_rays(camera, 8, 8), Error);
}

}  // namespace
}  // namespace catoptra
