// Planar optics in mode pvrr: mirrors against unfolded paths, glass against rays that this test refracts
// itself.
#include <gtest/gtest.h>

#include <map>

#include "optics/refraction.h"
#include "render/comparison.h"
#include "tests/render/planar_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;
using optics::OpticKind;

std::vector<PlacedMirror> facing_mirrors() {
  return {PlacedMirror::facing({0, 0, 0}, {0.2, 0, 1}, 420, 320),
          PlacedMirror::facing({260, 40, 420}, {-0.55, -0.1, -1}, 420, 320)};
}

/// The mirrors as planar optics; with `turned` they show from their backs, where both sides reflect.
Scene planar_scene(const std::vector<PlacedMirror>& mirrors, int depth, bool turned) {
  Scene scene = scene_of(mirrors, 2, depth);
  for (optics::Optic& optic : scene.optics) {
    optic.planar = optic.two_sided = true;
    if (turned)
      for (auto& vertex : optic.mesh.vertices) vertex.normal = -vertex.normal;
    if (turned)
      for (auto& triangle : optic.mesh.triangles) std::swap(triangle.vertices[1], triangle.vertices[2]);
  }
  scene.camera = {{-330, 90, 760}, {20, 0, 60}, {0, 1, 0}, 0.6, {320, 240}};
  return scene;
}

class HallOfMirrors : public ::testing::TestWithParam<std::tuple<int, bool>> {};

// Nothing is resampled at any level: what is off is off by the rounding of floats, and by pixels whose centre
// lies on an outline.
TEST_P(HallOfMirrors, ShowsWhatUnfoldedPathsShow) {
  const auto [depth, turned] = GetParam();
  const auto mirrors = facing_mirrors();
  const Scene scene = planar_scene(mirrors, depth, turned);
  const RenderResult result = Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene));
  const BounceErrors errors = bounce_errors(scene, mirrors, result.frame);
  const std::size_t seen[] = {0, 13000, 5500, 3800, 1300, 60};
  for (int k = 1; k <= depth; ++k) {
    const auto& arcmin = errors.arcmin[std::size_t(k)];
    EXPECT_GT(arcmin.size(), seen[k]) << k << " bounces";
    EXPECT_LT(quantile(arcmin, 1), 0.1 * pixel_arcmin(scene)) << k << " bounces";
    EXPECT_LT(double(errors.other_way[std::size_t(k)]), 0.002 * double(arcmin.size()) + 2) << k << " bounces";
  }
  EXPECT_EQ(result.stats.maps.size(), std::size_t(depth));
}
INSTANTIATE_TEST_SUITE_P(Depth, HallOfMirrors, ::testing::Combine(::testing::Range(1, 6), ::testing::Bool()));

TEST(PlanarChecks, ChangeNoPixel) {
  const Scene scene = planar_scene(facing_mirrors(), 4, false);
  Renderer renderer(scene);
  FrameOptions options = picture_of(scene);
  const Frame with = renderer.render(Mode::pvrr, scene.camera, options).frame;
  options.check_visibility = false;
  const Frame without = renderer.render(Mode::pvrr, scene.camera, options).frame;
  std::size_t different = 0;
  for (std::size_t i = 0; i < with.color.size(); ++i)
    different += with.path[i] != without.path[i] || glm::length(with.color[i] - without.color[i]) > 2e-3f;
  // The grids are the same, their matrices round differently: pixels with an edge through their centre.
  EXPECT_LE(different, 15u);
}

Scene behind_glass(OpticKind kind, double thickness_mm = 0) {
  Scene scene = room();
  add_box(scene.surroundings[0], {-6000, -5000, -6000}, {6000, 5000, 6000}, glm::vec3(0.4f, 0.5f, 0.6f));
  scene.optics.push_back(planar_optic(kind, {0, 0, 600}, {0.2, 0.1, -1}, 500, 400));
  scene.optics[0].material.thickness_mm = thickness_mm;
  scene.camera = {{40, 30, -300}, {30, 0, 600}, {0, 1, 0}, 0.6, {320, 240}};
  return scene;
}

struct GlassErrors {
  std::vector<double> arcmin;  // ascending
  double off_line_mm = 0;      // greatest distance of what is shown from the exact line
};

/// Of the passed light, by refracting each pixel's own ray.
GlassErrors glass_errors(const Scene& scene, const Frame& frame) {
  const optics::Optic& glass = scene.optics[0];
  const glm::dvec3 c = glass.mesh.vertices[0].position_mm;
  const auto rays = camera_rays(scene.camera, frame.width, frame.height);
  GlassErrors errors;
  for (std::size_t i = 0; i < frame.optic_id.size(); ++i) {
    if (frame.optic_id[i] != 0 || frame.position[i].w == 0) continue;
    const glm::dvec3 d = glm::normalize(
        rays.direction(double(i % std::size_t(frame.width)), double(i / std::size_t(frame.width))));
    glm::dvec3 n = glass.mesh.vertices[0].normal;
    const bool front = glm::dot(n, scene.camera.eye_mm - c) > 0;
    if (!front) n = -n;
    glm::dvec3 q = scene.camera.eye_mm + glm::dot(c - scene.camera.eye_mm, n) / glm::dot(d, n) * d, exact = d;
    if (glass.kind == OpticKind::refractor) {
      const auto refracted = optics::refract(d, n, front ? 1 / glass.material.ior : glass.material.ior);
      if (!refracted) continue;
      exact = *refracted;
    } else {
      const double cosine = -glm::dot(d, n), sine = std::sqrt(1 - cosine * cosine);
      const double inside = sine / glass.material.ior, tan_b = inside / std::sqrt(1 - inside * inside);
      const glm::dvec3 along = sine > 0 ? (d + cosine * n) / sine : glm::dvec3(0);
      q -= glass.material.thickness_mm * (sine / cosine - tan_b) * along;
    }
    const glm::dvec3 shown = glm::dvec3(glm::vec3(frame.position[i])) - q;
    errors.arcmin.push_back(angle_arcmin(shown, exact));
    errors.off_line_mm = std::max(errors.off_line_mm, glm::length(glm::cross(shown, exact)));
  }
  std::sort(errors.arcmin.begin(), errors.arcmin.end());
  return errors;
}

// A plate moves every ray in parallel: directions are exact, places to the spread of tan b / tan a over the
// face.
TEST(Pane, ShowsWhatTwoRefractionsShow) {
  const Scene scene = behind_glass(OpticKind::pane, 20);
  const Frame frame = Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
  const GlassErrors errors = glass_errors(scene, frame);
  ASSERT_GT(errors.arcmin.size(), 20000u);
  // Of a shift of up to 9 mm; measured 0.35.
  EXPECT_LT(errors.off_line_mm, 0.5);
}

TEST(Pane, WithoutThicknessIsNotThereButForItsReflectance) {
  const Scene scene = behind_glass(OpticKind::pane, 0);
  const Frame frame = Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
  EXPECT_LT(glass_errors(scene, frame).arcmin.back(), 0.1 * pixel_arcmin(scene));
}

// One viewpoint is exact at one angle; docs/planar-optics.md has the errors over faces of all angles.
TEST(Refractor, IsExactOnTheViewsAxisAndCloseAroundIt) {
  Scene scene = behind_glass(OpticKind::refractor);
  const Frame frame = Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
  const GlassErrors errors = glass_errors(scene, frame);
  ASSERT_GT(errors.arcmin.size(), 20000u);
  EXPECT_LT(errors.arcmin.front(), 0.5);
  EXPECT_LT(quantile(errors.arcmin, 0.5), 30);
}

// Colours: a uniform world, so that every share can be told apart: passed light is the wall's, reflected the
// sky's.
TEST(Glass, SharesAreFresnels) {
  Scene scene;
  scene.file = "shares";
  scene.environment = {{0, 0, 0}, "", 1.0f};
  cad_import::TriangleMesh mesh;
  add_quad(mesh, {-9000, -9000, 1000}, {0, 18000, 0}, {18000, 0, 0}, glm::vec3(0.5f));
  add_quad(mesh, {-9000, -9000, -1000}, {18000, 0, 0}, {0, 18000, 0}, glm::vec3(0, 0, 0.25f));
  scene.surroundings.push_back(mesh);
  scene.camera = {{0, 0, -500}, {0, 0, 0}, {0, 1, 0}, 1.2, {64, 48}};
  for (const OpticKind kind : {OpticKind::refractor, OpticKind::pane})
    for (const bool from_back : {false, true}) {
      scene.optics = {planar_optic(kind, {0, 0, 0}, {0, 0, from_back ? 1 : -1}, 900, 700)};
      scene.optics[0].material.tint = {1, 0.5f, 0.25f};
      const Frame frame = Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
      const auto rays = camera_rays(scene.camera, 64, 48);
      std::size_t judged = 0, total = 0;
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
          const std::size_t i = std::size_t(y) * 64 + std::size_t(x);
          if (frame.optic_id[i] != 0) continue;
          const double cosine = glm::normalize(rays.direction(x, y)).z;
          const bool inside = kind == OpticKind::refractor && from_back;
          double r = optics::fresnel_dielectric(cosine, inside ? 1.5 : 1, inside ? 1 : 1.5).unpolarised;
          if (kind == OpticKind::pane) r = 2 * r / (1 + r);
          const glm::dvec3 expected((1 - r) * 0.5, (1 - r) * 0.25, (1 - r) * 0.125 + r * 0.25);
          EXPECT_LT(glm::distance(expected, glm::dvec3(glm::vec3(frame.color[i]))), 2e-3) << x << " " << y;
          ++judged;
          total += r == 1;
        }
      EXPECT_GT(judged, 2000u);
      EXPECT_EQ(total > 0, kind == OpticKind::refractor && from_back);
    }
}

TEST(Glass, FogFollowsTheDistanceBehindTheFace) {
  Scene scene;
  scene.file = "fog";
  scene.environment = {{0, 0, 0}, "", 1.0f};
  cad_import::TriangleMesh mesh;
  add_quad(mesh, {-9000, -9000, 1000}, {0, 18000, 0}, {18000, 0, 0}, glm::vec3(0.5f));
  scene.surroundings.push_back(mesh);
  scene.camera = {{0, 0, -500}, {0, 0, 0}, {0, 1, 0}, 0.8, {64, 48}};
  scene.optics = {planar_optic(OpticKind::pane, {0, 0, 0}, {0, 0, -1}, 300, 200)};
  scene.optics[0].material.translucency = 0.4;
  scene.optics[0].material.color = {0, 1, 0};
  const Frame frame = Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
  const auto rays = camera_rays(scene.camera, 64, 48);
  std::size_t judged = 0;
  for (std::size_t i = 0; i < frame.color.size(); ++i) {
    if (frame.optic_id[i] != 0) continue;
    const double cosine = glm::normalize(rays.direction(double(i % 64), double(i / 64))).z;
    const double r = optics::fresnel_dielectric(cosine, 1, 1.5).unpolarised, passes = (1 - r) / (1 + r);
    const double clear = std::pow(0.6, 1 / cosine);  // 1 m to the wall along the axis
    EXPECT_NEAR(frame.color[i].x, passes * clear * 0.5, 2e-3);
    EXPECT_NEAR(frame.color[i].y, passes * (clear * 0.5 + (1 - clear)), 2e-3);
    ++judged;
  }
  EXPECT_GT(judged, 300u);
}

}  // namespace
}  // namespace catoptra::render
