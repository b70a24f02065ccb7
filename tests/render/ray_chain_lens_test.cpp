// Lenses in mirrors, mirrors through lenses, lenses behind lenses: against closed forms and exact paths
// computed here.
#include <gtest/gtest.h>

#include <cmath>

#include "optics/reflection.h"
#include "tests/render/lens_pvrr_scene.h"
#include "tests/render/ray_chain_scenes.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

RenderResult rendered(const Scene& scene, std::size_t threads = 0) {
  FrameOptions options = picture_of(scene);
  options.threads = threads;
  return Renderer(scene).render(Mode::raytrace, scene.camera, options);
}

/// A wall across the z axis that shines with 1.
cad_import::TriangleMesh shining_wall(double z_mm) {
  cad_import::TriangleMesh mesh = empty_mesh();
  mesh.materials[0].base_color = glm::vec3(0);
  mesh.materials[0].emissive = glm::vec3(1);
  add_quad(mesh, {-10000, -10000, float(z_mm)}, {20000, 0, 0}, {0, 20000, 0});
  return mesh;
}

/// Unpolarised share that is reflected where light passes from air into the index, by Fresnel's formulae.
double fresnel(double sin_a, double index) {
  const double cos_a = std::sqrt(1 - sin_a * sin_a), cos_b = std::sqrt(1 - sin_a * sin_a / (index * index));
  const double s = (cos_a - index * cos_b) / (cos_a + index * cos_b),
               p = (index * cos_a - cos_b) / (index * cos_a + cos_b);
  return 0.5 * (s * s + p * p);
}

// Window glass before a mirror: the light passes the glass on both ways. Across the axis it goes tan(a) per
// mm in air and tan(b) in glass, sin(a) = n sin(b). Source: Snell's law.
TEST(RayChainLens, PlateBeforeAMirrorShiftsTwice) {
  constexpr double kEye = 200, kThick = 10, kGap = 25, kWall = 1500, kIndex = 1.5;
  Scene scene = dark_scene(3);
  scene.surroundings = {shining_wall(-kWall)};
  scene.optics.push_back(lens_of(0, 0, kThick, 80, 9));
  scene.optics.push_back(plane_mirror({0, 0, kGap}, {0, 0, -1}, 80));
  scene.optics[1].reflectance = glm::vec3(0.8f);
  scene.camera = {{0, 0, -kEye}, {0, 0, 0}, {0, 1, 0}, 0.2, {160, 120}};
  const Frame frame = rendered(scene).frame;
  int count = 0;
  for (std::size_t i = 0; i < frame.color.size(); i += 7) {
    const glm::dvec3 d = ray_of(scene.camera, 160, 120, i);
    const double sin_a = std::hypot(d.x, d.y), tan_a = sin_a / d.z,
                 tan_b = sin_a / std::sqrt(kIndex * kIndex - sin_a * sin_a);
    const double radius = (kEye - kThick + 2 * kGap + kWall - kThick) * tan_a + 2 * kThick * tan_b;
    ASSERT_EQ(frame.path[i], path_by({0, 1, 0}));
    EXPECT_EQ(frame.bounces[i], 3);
    EXPECT_EQ(frame.optic_id[i], 0);
    EXPECT_LT(glm::length(glm::dvec2(frame.position[i]) - radius / sin_a * glm::dvec2(d)), 1e-3);
    EXPECT_LT(glm::length(glm::dvec3(frame.direction[i]) - glm::dvec3(d.x, d.y, -d.z)), 1e-6);
    EXPECT_NEAR(frame.surface[i].z, -kThick, 1e-5);
    EXPECT_NEAR(frame.color[i].g, 0.8 * std::pow(1 - fresnel(sin_a, kIndex), 4), 2e-6);
    ++count;
  }
  EXPECT_GT(count, 2000);
}

// What a plane mirror shows of a lens is what the mirrored eye sees, with left and right changed.
TEST(RayChainLens, LensInAPlaneMirrorIsTheMirroredEyesLens) {
  const glm::dvec3 pole(0, 0, -150), normal(std::sqrt(0.5), 0, std::sqrt(0.5));
  for (const int wavelengths : {1, 3, 16}) {
    Scene direct = room_behind_lens(300, 0.15);
    direct.optics.push_back(lens_of(400, 95.2, 2, 60, 25, wavelengths, optics::abbe_medium(1.6, 30)));
    Scene scene = direct;
    scene.optics.push_back(plane_mirror(pole, normal, 100));
    scene.optics[1].reflectance = {0.9f, 0.8f, 0.7f};
    scene.camera.eye_mm = mirrored(direct.camera.eye_mm, pole, normal);
    scene.camera.target_mm = pole;
    const Frame a = rendered(scene).frame, b = rendered(direct).frame;
    const int width = a.width;
    std::size_t compared = 0, different = 0;
    for (std::size_t i = 0; i < a.color.size(); ++i) {
      const std::size_t row = i / std::size_t(width), column = i % std::size_t(width),
                        j = row * std::size_t(width) + std::size_t(width) - 1 - column;
      if (b.optic_id[j] != 0) continue;
      ++compared;
      const glm::vec3 wanted = scene.optics[1].reflectance * glm::vec3(b.color[j]);
      const bool same = a.path[i] == path_by({1, 0}) && a.position[i].w == b.position[j].w &&
                        glm::length(glm::vec3(a.position[i] - b.position[j])) < 0.02f &&
                        glm::length(glm::vec3(a.color[i]) - wanted) < 1e-3f;
      different += same ? 0 : 1;
    }
    EXPECT_GT(compared, 10000u);
    EXPECT_LT(different, compared / 200) << "edges, where rounding decides";
  }
}

// A sphere mirror behind a lens, turned aside, so that the light does not come back through the lens.
TEST(RayChainLens, MirrorBehindALensFollowsTheExactPath) {
  constexpr double kRadius = 200;
  const glm::dvec3 pole(0, 0, 120), normal = glm::normalize(glm::dvec3(1, 0, -0.9));
  Scene scene = room_behind_lens(150, 0.3);
  scene.optics.push_back(lens_of(400, 95.2, 2, 60, 25));
  scene.optics.push_back(facing(conic_mirror(kRadius, 0, 140, 140, 33, 33), pole, normal));
  const Frame frame = rendered(scene).frame;
  const ExactPaths paths(scene);
  const glm::dvec3 center = pole - kRadius * normal;
  int count = 0;
  for (int row = 0; row < frame.height; row += 5)
    for (int column = 0; column < frame.width; column += 5) {
      const auto i = std::size_t(row) * std::size_t(frame.width) + std::size_t(column);
      if (frame.path[i] != path_by({0, 1})) continue;
      const optics::LensPath path = paths.path(column, row);
      ASSERT_EQ(path.end, optics::LensPathEnd::passed);
      const glm::dvec3 o = path.exit.position_mm - center;
      const double b = glm::dot(o, path.outside);
      const glm::dvec3 at =
          path.exit.position_mm + (-b - std::sqrt(b * b - glm::dot(o, o) + kRadius * kRadius)) * path.outside;
      const glm::dvec3 direction = optics::reflect(path.outside, (at - center) / kRadius);
      EXPECT_LT(glm::length(glm::dvec3(frame.surface[i]) - at), 5e-5);
      EXPECT_LT(glm::length(glm::dvec3(frame.direction[i]) - direction), 3e-7);
      ++count;
    }
  EXPECT_GT(count, 500);
}

/// A lens moved along z.
optics::Optic moved(const optics::Optic& lens, double z_mm) {
  return optics::placed(lens, {glm::dmat3(1), {0, 0, z_mm}});
}

TEST(RayChainLens, LensBehindALensFollowsTheExactPath) {
  constexpr double kWall = 3000;
  Scene scene = wall_behind_lens(70, 0.5, kWall);
  scene.optics.push_back(lens_of(400, 95.2, 2, 60, 25));
  scene.optics.push_back(moved(lens_of(120, -300, 6, 90, 25), 50));
  const Frame frame = rendered(scene).frame;
  const ExactPaths first(scene);
  const optics::LensTracer second(scene.optics[1]);
  int count = 0;
  for (int row = 0; row < frame.height; row += 5)
    for (int column = 0; column < frame.width; column += 5) {
      const auto i = std::size_t(row) * std::size_t(frame.width) + std::size_t(column);
      if (frame.path[i] != path_by({0, 1})) continue;
      const optics::LensPath a = first.path(column, row);
      ASSERT_EQ(a.end, optics::LensPathEnd::passed);
      const optics::LensPath b =
          second.trace({a.exit.position_mm, a.outside}, optics::LensSide::back, {1.5, 1});
      ASSERT_EQ(b.end, optics::LensPathEnd::passed);
      const glm::dvec3 wanted = b.exit.position_mm + (kWall - b.exit.position_mm.z) / b.outside.z * b.outside;
      EXPECT_LT(glm::length(glm::dvec3(frame.position[i]) - wanted), 3e-3);
      EXPECT_NEAR(frame.color[i].g, 0.5 * a.transmittance * b.transmittance, 1e-5);
      ++count;
    }
  EXPECT_GT(count, 1500);
}

// Light splits at the first lens that has several wavelengths. One without dispersion before it may have one
// or as many.
TEST(RayChainLens, LightSplitsAtTheFirstLensWithSeveralWavelengths) {
  Scene scene = room_behind_lens(70, 0.5);
  scene.optics.push_back(lens_of(400, 95.2, 2, 60, 25, 1));
  scene.optics.push_back(moved(lens_of(400, 120, 2, 90, 25, 3, optics::abbe_medium(1.7, 20)), 50));
  const Frame one = rendered(scene).frame;
  scene.optics[0].wavelengths = 3;
  const Frame three = rendered(scene).frame;
  scene.optics[1].wavelengths = 1;
  const Frame without = rendered(scene).frame;
  std::size_t fringes = 0;
  for (std::size_t i = 0; i < one.color.size(); ++i) {
    ASSERT_LT(glm::length(one.color[i] - three.color[i]), 1e-5f);
    if (glm::length(one.color[i] - without.color[i]) > 0.02f) ++fringes;
  }
  EXPECT_GT(fringes, 200u) << "the second lens's dispersion shows";
}

// A coarse mesh's chords lie before or behind the exact surface that rays start on: none of them may be taken
// for an optic that is met again.
TEST(RayChainLens, OpticsThatDoNotSeeThemselvesShowTheSameAtEveryDepth) {
  for (int which = 0; which < 5; ++which) {
    Scene scene = room_behind_lens(70, 0.8);
    if (which == 0) scene.optics.push_back(lens_of(95.2, 400, 6, 60, 9));
    if (which == 1) scene.optics.push_back(lens_of(400, 95.2, 2, 60, 9));
    if (which == 2) scene.optics.push_back(lens_of(120, -120, 12, 60, 9, 3, optics::abbe_medium(1.6, 30)));
    if (which == 3)
      scene.optics.push_back(facing(conic_mirror(-600, 0, 80, 80, 7, 7), {20, 0, 60}, {0, 0, -1}));
    if (which == 4)
      scene.optics.push_back(facing(conic_mirror(300, 0, 80, 80, 7, 7), {20, 0, 60}, {0, 0, -1}));
    scene.settings.depth = 1;
    const RenderResult one = rendered(scene);
    scene.settings.depth = 4;
    const RenderResult four = rendered(scene);
    EXPECT_EQ(four.frame.color, one.frame.color) << which;
    EXPECT_EQ(four.frame.position, one.frame.position) << which;
    EXPECT_EQ(four.stats.rays, one.stats.rays) << which;
  }
}

TEST(RayChainLens, AnyNumberOfThreadsGivesTheSamePicture) {
  Scene scene = room_behind_lens(70, 0.9);
  scene.optics.push_back(lens_of(400, 95.2, 2, 60, 17, 3, optics::abbe_medium(1.6, 30)));
  scene.optics.push_back(moved(lens_of(120, -300, 6, 90, 25, 7, optics::abbe_medium(1.7, 20)), 50));
  scene.optics.push_back(facing(conic_mirror(-300, 0, 90, 90, 17, 17), {60, 0, 150}, {0, 0, -1}));
  const RenderResult one = rendered(scene, 1), two = rendered(scene, 2);
  EXPECT_EQ(one.frame.color, two.frame.color);
  EXPECT_EQ(one.frame.position, two.frame.position);
  EXPECT_EQ(one.frame.path, two.frame.path);
  EXPECT_EQ(one.stats.rays, two.stats.rays);
  std::size_t chains = 0;
  for (const std::uint8_t bounces : one.frame.bounces) chains += bounces > 1 ? 1 : 0;
  EXPECT_GT(chains, 5000u);
}

}  // namespace
}  // namespace catoptra::render
