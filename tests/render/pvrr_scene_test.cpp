// What a mirror shows and what it does not: sides, flank, what is behind it, its own back.
#include <gtest/gtest.h>

#include <algorithm>

#include "render/comparison.h"
#include "render/renderer.h"
#include "tests/render/raster_test_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

bool looks_like(const glm::vec4& color, const glm::vec3& hue) {
  // Channels that the hue lacks are dark; the one it has is several times brighter.
  const glm::vec3 c(color);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      if (hue[k] > 0.5f && hue[j] < 0.1f && c[k] < 3 * c[j]) return false;
  return true;
}

/// Mean column of the pixels in the mirror that look like `hue`; -1 where there is none.
double mean_column(const Frame& frame, const glm::vec3& hue) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < frame.color.size(); ++i)
    if (frame.optic_id[i] >= 0 && looks_like(frame.color[i], hue)) {
      sum += double(i % std::size_t(frame.width));
      ++count;
    }
  return count > 0 ? sum / count : -1;
}

class PvrrScene : public ::testing::TestWithParam<double> {
 protected:
  Scene scene_ = room();
  void add_mirror(int vertices = 9) {
    scene_.optics.push_back(conic_mirror(GetParam(), 0, 170, 110, vertices, vertices));
  }
  /// True where pixel `i` shows what lies behind the plane that touches the mirror at its surface point, by
  /// more than the facets (0.9 mm at R 300) and the depth of a texel account for.
  bool behind_surface(const Frame& f, std::size_t i) const {
    if (f.position[i].w == 0) return false;
    const glm::dvec3 surface(f.surface[i]);
    const glm::dvec3 normal =
        GetParam() > 0 ? glm::normalize(surface - glm::dvec3(0, 0, -GetParam())) : glm::dvec3(0, 0, 1);
    return glm::dot(glm::dvec3(glm::vec3(f.position[i])) - surface, normal) < -1;
  }
  Frame frame(Mode mode = Mode::pvrr) {
    return Renderer(scene_).render(mode, scene_.camera, picture_of(scene_)).frame;
  }
};

// The eye looks along -z with +y up, so its right is ahead x up = +x. A mirror does not swap sides: what lies
// at +x, to the right of the eye, is seen in the right half.
TEST_P(PvrrScene, BluePanelAtTheRightIsSeenAtTheRight) {
  scene_.surroundings.at(0) = {};
  add_quad(scene_.surroundings[0], {-300, -400, 4990}, {-900, 0, 0}, {0, 900, 0}, kRed);
  add_quad(scene_.surroundings[0], {1200, -400, 4990}, {-900, 0, 0}, {0, 900, 0}, kBlue);
  scene_.camera.eye_mm = {0, 100, 800};
  add_mirror();
  const Frame picture = frame();
  const double red = mean_column(picture, kRed), blue = mean_column(picture, kBlue);
  ASSERT_GE(red, 0);
  ASSERT_GE(blue, 0);
  EXPECT_LT(red, 160);
  EXPECT_GT(blue, 160);
}

// A box close behind the glass, wider than it, and one straight in the way of the virtual viewpoint.
TEST_P(PvrrScene, NothingBehindTheMirrorShows) {
  const float corner_z = GetParam() > 0 ? -float((85 * 85 + 55 * 55) / (2 * GetParam())) : 0.0f;
  add_box(scene_.surroundings[0], {-100, -70, corner_z - 60}, {100, 70, corner_z - 8}, kMagenta);
  add_box(scene_.surroundings[0], {-40, -30, -250}, {40, 30, -150}, kMagenta);
  scene_.camera.eye_mm = {-150, 60, 800};
  add_mirror();
  const Frame picture = frame();
  std::size_t behind = 0, magenta = 0, shown = 0;
  for (std::size_t i = 0; i < picture.color.size(); ++i) {
    if (picture.optic_id[i] < 0) continue;
    ++shown;
    magenta += looks_like(picture.color[i], kMagenta);
    behind += behind_surface(picture, i);
  }
  EXPECT_GT(shown, 5000u);
  EXPECT_EQ(magenta, 0u);
  EXPECT_EQ(behind, 0u);
}

// The car's flank: a slab beside the mirror that reaches from behind it to before it.
TEST_P(PvrrScene, FlankBesideTheMirrorShowsInFrontOfItsSurfaceOnly) {
  add_box(scene_.surroundings[0], {100, -60, -300}, {120, 60, 400}, kYellow);
  scene_.camera.eye_mm = {-150, 60, 800};
  add_mirror();
  const Frame pvrr = frame(), exact = frame(Mode::raytrace);
  const auto on_flank = [](const Frame& f, std::size_t i) {
    return f.optic_id[i] >= 0 && f.position[i].w > 0 && f.position[i].x > 99 && f.position[i].x < 121 &&
           f.position[i].z < 401;
  };
  std::size_t in_pvrr = 0, in_exact = 0, in_both = 0, behind = 0;
  for (std::size_t i = 0; i < pvrr.color.size(); ++i) {
    behind += on_flank(pvrr, i) && behind_surface(pvrr, i);
    in_pvrr += on_flank(pvrr, i);
    in_exact += on_flank(exact, i);
    in_both += on_flank(pvrr, i) && on_flank(exact, i);
  }
  ASSERT_GT(in_exact, 500u);
  EXPECT_EQ(behind, 0u);
  // The flank's outline is where neighbouring vertices show near and far things: 3 % of its pixels may
  // differ.
  EXPECT_GT(double(in_both), 0.97 * double(std::max(in_pvrr, in_exact)));
}

TEST_P(PvrrScene, BackOfTheMirrorIsTheSameDarkBodyInEveryMode) {
  add_box(scene_.surroundings[0], {300, 300, -500}, {400, 400, -400}, kRed);
  scene_.camera.eye_mm = {30, 60, -800};
  add_mirror();
  const Frame exact = frame(Mode::raytrace);
  for (const Mode mode : {Mode::pvrr, Mode::cubemap, Mode::hybrid}) {
    const Frame other = frame(mode);
    EXPECT_TRUE(std::all_of(other.optic_id.begin(), other.optic_id.end(), [](int id) { return id == -1; }));
    // Only pixels on silhouettes may differ.
    EXPECT_GT(image_error(exact, other).psnr_db, 45) << mode_name(mode);
  }
}

INSTANTIATE_TEST_SUITE_P(Radii, PvrrScene, ::testing::Values(0.0, 1200.0, 300.0),
                         [](const auto& suite) { return "R" + std::to_string(int(suite.param)); });

TEST(PvrrFlip, FlippedMirrorReflectsOnItsOtherSide) {
  Scene scene = room();
  scene.optics.push_back(conic_mirror(0, 0, 170, 110, 2, 2));
  for (auto& vertex : scene.optics[0].mesh.vertices) vertex.normal = -vertex.normal;
  for (auto& triangle : scene.optics[0].mesh.triangles) std::swap(triangle.vertices[1], triangle.vertices[2]);
  Scene flipped = scene;
  flipped.optics[0].flip = true;
  const auto shown = [](const Scene& s) {
    const Frame f = Renderer(s).render(Mode::pvrr, s.camera, picture_of(s)).frame;
    return std::count(f.optic_id.begin(), f.optic_id.end(), 0);
  };
  EXPECT_EQ(shown(scene), 0) << "the reflecting side is turned away";
  EXPECT_GT(shown(flipped), 5000);
}

/// The plane z = 500 seen from below: u = x, v = -y, normal -z.
class FacingPlane : public cad_import::ExactSurface {
 public:
  cad_import::SurfaceKind kind() const override { return cad_import::SurfaceKind::plane; }
  cad_import::ParameterDomain domain() const override { return {-60, 60, -60, 60, 0, 0}; }
  double orientation() const override { return 1; }
  glm::dvec3 point(double u, double v) const override { return {u, -v, 500}; }
  cad_import::SurfaceFrame d1(double u, double v) const override {
    return {point(u, v), {1, 0, 0}, {0, -1, 0}};
  }
  cad_import::SurfaceDerivatives d2(double u, double v) const override {
    return {point(u, v), {1, 0, 0}, {0, -1, 0}, glm::dvec3(0), glm::dvec3(0), glm::dvec3(0)};
  }
};

/// A mirror of 120 x 120 mm on that plane.
optics::Optic facing_mirror() {
  optics::Optic optic = conic_mirror(0, 0, 120, 120, 3, 3);
  const auto surface = std::make_shared<FacingPlane>();
  optic.faces[0].surface = surface;
  for (auto& vertex : optic.mesh.vertices) {
    vertex.position_mm = surface->point(vertex.uv.x, vertex.uv.y);
    vertex.normal = {0, 0, -1};
  }
  return optic;
}

// At depth 1 each of two mirrors shows the other as a plain body of its reflectance, as the ray tracer does.
TEST(PvrrTwoMirrors, EachShowsTheOtherAsADiffuseBody) {
  Scene scene = room();
  scene.settings.depth = 1;
  scene.optics = {conic_mirror(0, 0, 170, 110, 3, 3), facing_mirror()};
  scene.optics[1].reflectance = {0.9f, 0.5f, 0.1f};
  scene.settings.depth = 1;
  scene.camera.eye_mm = {-250, 100, 700};
  Renderer renderer(scene);
  const Frame exact = renderer.render(Mode::raytrace, scene.camera, picture_of(scene)).frame;
  for (const Mode mode : {Mode::pvrr, Mode::hybrid}) {
    const Frame other = renderer.render(mode, scene.camera, picture_of(scene)).frame;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < other.color.size(); ++i)
      seen += other.optic_id[i] == 0 && other.position[i].w > 0 && std::abs(other.position[i].z - 500) < 0.1f;
    EXPECT_GT(seen, 200u) << mode_name(mode);
    EXPECT_GT(image_error(exact, other).psnr_db, 35) << mode_name(mode);
  }
}

}  // namespace
}  // namespace catoptra::render
