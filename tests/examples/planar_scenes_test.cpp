// The example scenes of planar optics: that optics and models fit, and what flat mirrors show, in closed
// form.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "examples/plates/light_stage.h"
#include "optics/ray_scene.h"
#include "render/renderer.h"
#include "tests/support/planar_scene.h"

namespace catoptra::test {
namespace {

constexpr double kMetre = 1000;  // mm

void expect_same_arrangement(const std::string& name, const examples::LightStage& stage) {
  const render::Scene scene = example_scene(name).scene;
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_LT(glm::distance(scene.lights[0].direction, stage.sun), 1e-12);
  EXPECT_TRUE(scene.lights[0].shadows);
  const optics::Optic& face = optic_named(scene, "face");
  EXPECT_EQ(face.kind, stage.mirror ? optics::OpticKind::mirror : optics::OpticKind::refractor);
  if (!stage.mirror) {
    EXPECT_DOUBLE_EQ(face.material.ior, stage.ior);
  }
  const Rectangle r = upright_rectangle(face);
  EXPECT_NEAR(r.normal().x, -1, 1e-12);
  EXPECT_LT(glm::distance(r.corner, kMetre * glm::dvec3(0, stage.half_width, stage.low)), 1e-6);
  EXPECT_LT(glm::distance(r.corner + r.u + r.v, kMetre * glm::dvec3(0, -stage.half_width, stage.high)), 1e-6);
}

TEST(Figure2, ScenesHaveTheStagesNumbers) {
  expect_same_arrangement("figure2", examples::refraction_stage());
  expect_same_arrangement("figure2_mirror", examples::reflection_stage());
}

/// Around a window's pane: a hole in the wall inside its corners, wall outside them.
class Windows : public ::testing::TestWithParam<const char*> {};

TEST_P(Windows, LieInHolesOfTheWall) {
  const render::Scene scene = example_scene(GetParam()).scene;
  optics::RayScene walls;
  for (const auto& mesh : scene.surroundings) walls.add_surroundings(mesh);
  walls.commit();
  ASSERT_FALSE(scene.optics.empty());
  for (const auto& optic : scene.optics) {
    const Rectangle r = upright_rectangle(optic);
    EXPECT_NEAR(r.normal().x, -1, 1e-9) << "looks to the street";
    constexpr double kBeside = 20, kBefore = 300;  // mm
    const auto blocked = [&](const glm::dvec3& q) {
      optics::Ray ray;
      ray.origin_mm = q + kBefore * r.normal();
      ray.direction = -r.normal();
      ray.t_max_mm = kBefore;
      return walls.occluded(ray, optics::kSurroundings);
    };
    const glm::dvec3 u = glm::normalize(r.u) * kBeside, v = glm::normalize(r.v) * kBeside;
    const glm::dvec3 corners[] = {r.corner, r.corner + r.u, r.corner + r.u + r.v, r.corner + r.v};
    const glm::dvec3 inwards[] = {u + v, v - u, -u - v, u - v};
    for (int k = 0; k < 4; ++k) {
      EXPECT_FALSE(blocked(corners[k] + inwards[k])) << optic.name << ", corner " << k;
      EXPECT_TRUE(blocked(corners[k] - inwards[k])) << optic.name << ", corner " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Windows,
                         ::testing::Values("windows_20", "window_mirrors_20_depth_2", "shop_street"),
                         [](const auto& suite) { return std::string(suite.param); });

TEST(WindowSeries, HasTheNumbersInItsNames) {
  EXPECT_TRUE(example_scene("windows_0").scene.optics.empty());
  for (const int count : {1, 5, 10, 20})
    for (const int depth : {1, 2, 3})
      for (const auto& [name, kind] :
           {std::pair{"windows", optics::OpticKind::pane}, {"window_mirrors", optics::OpticKind::mirror}}) {
        const auto scene =
            example_scene(std::string(name) + "_" + std::to_string(count) + "_depth_" + std::to_string(depth))
                .scene;
        ASSERT_EQ(scene.optics.size(), std::size_t(count));
        EXPECT_EQ(scene.settings.depth, depth);
        for (const auto& optic : scene.optics) EXPECT_EQ(optic.kind, kind);
      }
}

/// What `scene` shows by exact rays, with geometry.
render::Frame traced(const render::Scene& scene, glm::ivec2 size) {
  render::Renderer renderer(scene);
  render::FrameOptions options;
  options.width = size.x;
  options.height = size.y;
  options.geometry = true;
  return renderer.render(render::Mode::raytrace, scene.camera, options).frame;
}

/// The picture says how many mirrors a pixel's path meets, for things that stand in the way; which ones, and
/// where the path ends, follow from planes.
TEST(Plate2, EachReflectionIsTheUnfoldedRoom) {
  constexpr glm::ivec2 kSize(320, 180);
  const render::Scene scene = example_scene("plate2").scene;
  const render::Frame frame = traced(scene, kSize);
  std::vector<Rectangle> mirrors;
  for (const auto& optic : scene.optics) mirrors.push_back(upright_rectangle(optic));
  std::vector<int> pixels(std::size_t(scene.settings.depth) + 1);
  double worst_mm = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const std::size_t i = std::size_t(y) * kSize.x + std::size_t(x);
      if (frame.optic_id[i] < 0) continue;
      const int bounces = frame.bounces[i];
      ASSERT_LE(bounces, scene.settings.depth);
      ++pixels[std::size_t(bounces)];
      StraightRay ray = pixel_ray(scene.camera, kSize, x, y);
      std::uint32_t path = 0;
      for (int k = 0; k < bounces; ++k) {
        std::optional<glm::dvec3> nearest;
        int which = -1;
        for (std::size_t m = 0; m < mirrors.size(); ++m) {
          const auto q =
              glm::dot(ray.direction, mirrors[m].normal()) < 0 ? mirrors[m].meet(ray) : std::nullopt;
          if (!q || (nearest && glm::distance(*q, ray.origin) > glm::distance(*nearest, ray.origin)))
            continue;
          nearest = q;
          which = int(m);
        }
        ASSERT_TRUE(nearest) << "pixel " << x << ' ' << y << " bounce " << k;
        const glm::dvec3 n = mirrors[std::size_t(which)].normal();
        ray = {*nearest, ray.direction - 2 * glm::dot(ray.direction, n) * n};
        path = render::path_after(path, which);
      }
      ASSERT_EQ(render::path_of(frame, i), path) << "pixel " << x << ' ' << y;
      ASSERT_EQ(frame.position[i].w, 1) << "the room is closed";
      const glm::dvec3 to = glm::dvec3(frame.position[i]) - ray.origin;
      worst_mm = std::max(worst_mm, glm::length(glm::cross(to, ray.direction)));
    }
  // Positions are single precision, at up to 20 m of path: a few um each.
  EXPECT_LE(worst_mm, 0.02);
  for (int bounces = 1; bounces <= scene.settings.depth; ++bounces)
    EXPECT_GE(pixels[std::size_t(bounces)], 50) << bounces << " reflections";
}

/// Paths by the door mirror and then the standing one leave from the standing mirror's plane, on its front.
TEST(DoorMirrorPlanar, CurvedMirrorShowsTheFlatOne) {
  constexpr glm::ivec2 kSize(320, 180);
  const render::Scene scene = example_scene("door_mirror_planar").scene;
  const render::Frame frame = traced(scene, kSize);
  const std::uint32_t both = render::path_after(render::path_after(0, 0), 1);
  const Rectangle flat = upright_rectangle(optic_named(scene, "standing mirror"));
  int pixels = 0;
  for (std::size_t i = 0; i < frame.path.size(); ++i) {
    if (frame.path[i] != both) continue;
    ++pixels;
    EXPECT_LT(std::abs(glm::dot(glm::dvec3(frame.surface[i]) - flat.corner, flat.normal())), 0.05);
    EXPECT_GT(glm::dot(glm::dvec3(frame.direction[i]), flat.normal()), 0);
  }
  EXPECT_GE(pixels, 500);
}

}  // namespace
}  // namespace catoptra::test
