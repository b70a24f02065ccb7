// Eye and optic that move together through the scene (paper, section 5): their rays are kept, and the picture
// is that of a world that moves the other way.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/ext/matrix_transform.hpp>

#include "cad_import/error.h"
#include "optics/placement.h"
#include "render/comparison.h"
#include "tests/render/lens_pvrr_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

glm::dvec3 moved(const glm::dmat4& motion, const glm::dvec3& point) {
  return glm::dvec3(motion * glm::dvec4(point, 1));
}

Camera moved(const glm::dmat4& motion, Camera camera) {
  camera.eye_mm = moved(motion, camera.eye_mm);
  camera.target_mm = moved(motion, camera.target_mm);
  camera.up = glm::dmat3(motion) * camera.up;
  return camera;
}

/// The scene with all but camera and optics moved. No placement has a part in it.
Scene with_world_moved(const glm::dmat4& motion, Scene scene) {
  for (auto& mesh : scene.surroundings) {
    for (glm::vec3& p : mesh.positions) p = glm::vec3(moved(motion, glm::dvec3(p)));
    for (glm::vec3& n : mesh.normals) n = glm::vec3(glm::dmat3(motion) * glm::dvec3(n));
  }
  for (Light& light : scene.lights) {
    light.direction = glm::dmat3(motion) * light.direction;
    light.position_mm = moved(motion, light.position_mm);
  }
  return scene;
}

// A turn of 5 degrees about no axis of the scene, and a step aside.
glm::dmat4 turn_and_step() {
  return glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(60, -25, 40)), 0.09,
                     glm::normalize(glm::dvec3(1, 2, -0.5)));
}

/// Whether colours differ by more than two steps of the half floats that pictures are made of.
bool differs(const glm::vec4& a, const glm::vec4& b) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(a[k] - b[k]) > 2.0f / 1024 * std::max(0.0625f, a[k])) return true;
  return false;
}

std::size_t different_pixels(const Frame& a, const Frame& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.color.size(); ++i) count += differs(a.color[i], b.color[i]);
  return count;
}

/// Those of them around which `a` has one colour: no edge explains them.
std::size_t different_off_edges(const Frame& a, const Frame& b) {
  std::size_t count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const std::size_t i = std::size_t(y * a.width + x);
      if (!differs(a.color[i], b.color[i])) continue;
      bool edge = false;
      for (int v = std::max(0, y - 1); v <= std::min(a.height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(a.width - 1, x + 1); ++u)
          edge = edge || differs(a.color[i], a.color[std::size_t(v * a.width + u)]);
      count += !edge;
    }
  return count;
}

// Of 76,800 pixels, one in six hundred: samples within rounding of an edge fall on either side of it, and the moved
// world's vertices are rounded anew, to 2e-4 mm at 5 m. All of them have to lie at edges. Without edges of shadows one
// in a thousand had to do; with them 102 pixels were seen to change.
constexpr std::size_t kOnEdges = 128;

struct MovingCase {
  const char* name;
  bool lens;
  double front, back, thickness, eye, fov;
};

void PrintTo(const MovingCase& c, std::ostream* out) {
  *out << c.name;
}

Scene scene_of(const MovingCase& c) {
  if (c.lens) {
    Scene scene = room_behind_lens(c.eye, c.fov);
    scene.optics.push_back(lens_of(c.front, c.back, c.thickness, 60, 17, 3, optics::abbe_medium(1.6, 30)));
    return scene;
  }
  Scene scene = room();
  scene.camera.eye_mm = {-150, 60, 800};
  scene.optics.push_back(conic_mirror(c.front, 0, 170, 110, 13, 13));
  return scene;
}

class MovingTogether : public ::testing::TestWithParam<MovingCase> {};

TEST_P(MovingTogether, KeepsEveryRayAndShowsWhatTheyMeetNow) {
  const Scene scene = scene_of(GetParam());
  const glm::dmat4 motion = turn_and_step();
  const Camera there = moved(motion, scene.camera);
  Renderer renderer(scene);
  const FrameOptions options = picture_of(scene);
  const auto home = renderer.render(Mode::pvrr, scene.camera, options);
  const std::size_t rays = home.stats.optics[0].rays;
  EXPECT_GE(rays, 169u);

  renderer.place_optic(0, motion);
  const auto riding = renderer.render(Mode::pvrr, there, options);
  EXPECT_EQ(riding.stats.optics[0].rays, 0u) << "a ray was traced again";
  EXPECT_EQ(riding.stats.optics[0].scene_rays, rays);
  EXPECT_GT(different_pixels(home.frame, riding.frame), 2000u) << "the motion is to be seen";
  const auto rest = renderer.render(Mode::pvrr, there, options);
  EXPECT_EQ(rest.stats.rays, 0u);
  EXPECT_EQ(rest.frame.color, riding.frame.color);

  // From scratch at the same place: the eye differs by rounding, about 1e-13 mm.
  Renderer fresh(scene);
  fresh.place_optic(0, motion);
  const auto anew = fresh.render(Mode::pvrr, there, options);
  EXPECT_EQ(anew.stats.optics[0].rays, rays);
  EXPECT_LE(different_pixels(anew.frame, riding.frame), 2u);

  // The world moved the other way.
  const Scene turned = with_world_moved(glm::inverse(motion), scene);
  const auto truth = Renderer(turned).render(Mode::pvrr, turned.camera, options);
  EXPECT_LE(different_pixels(truth.frame, riding.frame), kOnEdges);
  EXPECT_EQ(different_off_edges(truth.frame, riding.frame), 0u);
  double farthest_mm = 0;
  for (std::size_t i = 0; i < truth.frame.optic_id.size(); ++i)
    if (truth.frame.optic_id[i] == 0 && riding.frame.optic_id[i] == 0)
      farthest_mm = std::max(farthest_mm, glm::distance(moved(motion, glm::dvec3(truth.frame.surface[i])),
                                                        glm::dvec3(riding.frame.surface[i])));
  EXPECT_LT(farthest_mm, 1e-2);
}

TEST_P(MovingTogether, EveryModeFindsTheOpticWhereItIs) {
  const Scene scene = scene_of(GetParam());
  const glm::dmat4 motion = turn_and_step();
  const Scene turned = with_world_moved(glm::inverse(motion), scene);
  Renderer renderer(scene), truth(turned);
  renderer.place_optic(0, motion);
  const FrameOptions options = picture_of(scene);
  for (const Mode mode : {Mode::raytrace, Mode::hybrid}) {
    const Frame there = renderer.render(mode, moved(motion, scene.camera), options).frame;
    const Frame home = truth.render(mode, turned.camera, options).frame;
    EXPECT_LE(different_pixels(home, there), kOnEdges) << mode_name(mode);
    EXPECT_EQ(different_off_edges(home, there), 0u) << mode_name(mode);
  }
  // The cube map's faces lie along the world's axes, so it is resampled otherwise.
  const Frame there = renderer.render(Mode::cubemap, moved(motion, scene.camera), options).frame;
  const Frame home = truth.render(Mode::cubemap, turned.camera, options).frame;
  EXPECT_GT(image_error(home, there).psnr_db, 30);
}

INSTANTIATE_TEST_SUITE_P(Optics, MovingTogether,
                         ::testing::Values(MovingCase{"ConcaveLens", true, 400, 95.2, 2, 70, 0.6},
                                           MovingCase{"ConvexLens", true, 95.2, 400, 6, 60, 0.6},
                                           MovingCase{"FarLens", true, 95.2, 400, 6, 760, 0.07},
                                           MovingCase{"ConvexMirror", false, 1200, 0, 0, 0, 0},
                                           MovingCase{"PlaneMirror", false, 0, 0, 0, 0, 0}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(MovingOptic, RaysAreTracedAnewWhereEyeOrOpticMovesAlone) {
  const Scene scene = scene_of({"", true, 400, 95.2, 2, 70, 0.6});
  Renderer renderer(scene);
  const FrameOptions options = picture_of(scene, 1, false);
  (void)renderer.render(Mode::pvrr, scene.camera, options);
  const glm::dmat4 step = glm::translate(glm::dmat4(1), glm::dvec3(0.001, 0, 0));
  EXPECT_GT(renderer.render(Mode::pvrr, moved(step, scene.camera), options).stats.optics[0].rays, 600u);
  renderer.place_optic(0, step);
  EXPECT_GT(renderer.render(Mode::pvrr, scene.camera, options).stats.optics[0].rays, 600u);
  EXPECT_GT(renderer.render(Mode::pvrr, moved(step, scene.camera), options).stats.optics[0].rays, 600u);
}

TEST(MovingOptic, ALensOnTheNosePassesAMirrorThatStays) {
  Scene scene = scene_of({"", false, 1200, 0, 0, 0, 0});
  scene.optics.push_back(lens_of(400, 95.2, 2, 40, 9));
  const glm::dmat4 before_eye = glm::translate(glm::dmat4(1), glm::dvec3(-150, 60, 720));
  const glm::dmat4 step = glm::translate(glm::dmat4(1), glm::dvec3(12, 5, 0));
  Renderer renderer(scene), fresh(scene);
  const FrameOptions options = picture_of(scene);
  renderer.place_optic(1, before_eye);
  (void)renderer.render(Mode::pvrr, scene.camera, options);
  renderer.place_optic(1, step * before_eye);
  fresh.place_optic(1, step * before_eye);
  const Camera there = moved(step, scene.camera);
  const auto kept = renderer.render(Mode::pvrr, there, options),
             anew = fresh.render(Mode::pvrr, there, options);
  EXPECT_GT(kept.stats.optics[0].rays, 100u) << "the mirror is seen from elsewhere";
  EXPECT_EQ(kept.stats.optics[1].rays, 0u);
  EXPECT_LE(different_pixels(anew.frame, kept.frame), 2u);
}

TEST(MovingOptic, OnlyRigidMotionsArePlacements) {
  const Scene scene = scene_of({"", false, 1200, 0, 0, 0, 0});
  Renderer renderer(scene);
  glm::dmat4 mirrored(1);
  mirrored[0][0] = -1;
  glm::dmat4 projective(1);
  projective[0][3] = 0.1;
  for (const glm::dmat4& bad : {glm::scale(glm::dmat4(1), glm::dvec3(1.001)), mirrored, projective}) {
    try {
      renderer.place_optic(0, bad);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(scene.optics[0].name), std::string::npos);
    }
  }
  EXPECT_THROW(renderer.place_optic(7, glm::dmat4(1)), std::out_of_range);
}

TEST(Placement, MovesNormalsCurvaturesAndExactSurfaceAlike) {
  const optics::Optic own = conic_mirror(300, -1, 100, 60, 5, 5);
  const auto placement = optics::placement_from_matrix(turn_and_step(), own.name);
  const optics::Optic there = optics::placed(own, placement);
  for (std::size_t i = 0; i < own.mesh.vertices.size(); ++i) {
    const auto &a = own.mesh.vertices[i], &b = there.mesh.vertices[i];
    EXPECT_LT(glm::distance(placement.own_point(b.position_mm), a.position_mm), 1e-12);
    const auto& surface = *there.faces[0].surface;
    EXPECT_LT(glm::distance(surface.point(b.uv.x, b.uv.y), b.position_mm), 1e-9);
    EXPECT_LT(glm::distance(surface.unit_normal(b.uv.x, b.uv.y), b.normal), 1e-12);
    EXPECT_NEAR(surface.principal_curvatures(b.uv.x, b.uv.y).k1, a.k1, 1e-12);
  }
}

}  // namespace
}  // namespace catoptra::render
