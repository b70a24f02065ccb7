// Optics in optics in mode pvrr: mirrors against the closed form, lenses against the ray tracer.
#include <gtest/gtest.h>

#include "render/comparison.h"
#include "tests/render/bounce_scene.h"
#include "tests/support/analytic_lens.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

/// Two mirrors that see each other, the second one plane or convex.
std::vector<PlacedMirror> facing_mirrors(double radius_mm = 0) {
  return {PlacedMirror::facing({0, 0, 0}, {0.2, 0, 1}, 420, 320),
          PlacedMirror::facing({260, 40, 420}, {-0.55, -0.1, -1}, 420, 320, radius_mm)};
}

Scene scene_with(const std::vector<PlacedMirror>& mirrors, int vertices, int depth) {
  Scene scene = scene_of(mirrors, vertices, depth);
  scene.camera = {{-330, 90, 760}, {20, 0, 60}, {0, 1, 0}, 0.6, {320, 240}};
  return scene;
}

RenderResult picture(const Scene& scene) {
  return Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene));
}

bool same_bytes(const Frame& a, const Frame& b) {
  return a.color == b.color && a.position == b.position && a.surface == b.surface && a.path == b.path;
}

class TwoPlanes : public ::testing::TestWithParam<int> {};

// Unfolded, the way by any number of plane mirrors is a straight line: nothing is interpolated wrongly, and
// what is left is the rounding of floats.
TEST_P(TwoPlanes, ShowWhatUnfoldedPathsShow) {
  const auto mirrors = facing_mirrors();
  const Scene scene = scene_with(mirrors, 3, GetParam());
  const RenderResult result = picture(scene);
  const BounceErrors errors = bounce_errors(scene, mirrors, result.frame);
  const std::size_t seen[] = {0, 13000, 5500, 3800, 1300, 60};  // pixels of that many bounces, about
  for (int k = 1; k <= GetParam(); ++k) {
    const auto& arcmin = errors.arcmin[std::size_t(k)];
    EXPECT_GT(arcmin.size(), seen[k]) << k << " bounces";
    EXPECT_LT(quantile(arcmin, 0.97), 0.01) << k << " bounces";
    // At the edges of things that are seen so, texels on both sides are mixed, and a mirror's outline is that
    // of the nearest texel: within two texels, which are as large as pixels here.
    EXPECT_LT(quantile(arcmin, 1), 2 * pixel_arcmin(scene)) << k << " bounces";
    EXPECT_LT(double(errors.other_way[std::size_t(k)]), 0.01 * double(arcmin.size()) + 2) << k << " bounces";
  }
  // One more map for every level, and of ever fewer texels, since each shows less of the picture.
  ASSERT_EQ(result.stats.maps.size(), std::size_t(GetParam()));
  for (std::size_t m = 0; m < result.stats.maps.size(); ++m) {
    EXPECT_EQ(result.stats.maps[m].level, int(m) + 1);
    if (m > 0) {
      EXPECT_LT(result.stats.maps[m].texels, result.stats.maps[m - 1].texels);
    }
  }
  EXPECT_EQ(result.stats.maps.back().way.substr(0, 19),
            GetParam() > 1 ? "mirror 1 > mirror 2" : std::string("mirror 1"));
}
INSTANTIATE_TEST_SUITE_P(Depth, TwoPlanes, ::testing::Range(1, 6));

// Light that has left a curved mirror comes from no one point. With that of the map's viewpoint the error at
// the third bounce stays at 19 arcmin however fine the mesh is; with the exact light of each vertex it goes
// with the square of the spacing, as after one bounce.
TEST(PlaneAndSphere, ThirdBounceConvergesWithTheSquareOfTheSpacing) {
  const auto mirrors = facing_mirrors(1200);
  double last = 0;
  for (const int vertices : {9, 17, 33}) {
    const Scene scene = scene_with(mirrors, vertices, 3);
    const BounceErrors errors = bounce_errors(scene, mirrors, picture(scene).frame);
    EXPECT_GT(errors.arcmin[3].size(), 2000u);
    const double median = quantile(errors.arcmin[3], 0.5);
    // 4 in the limit. The first spacing, 52 mm, is a sixth of what the third bounce shows of the mirror.
    if (last > 0) {
      EXPECT_GT(last / median, 3) << vertices;
    }
    last = median;
  }
  EXPECT_LT(last, 0.1);
}

TEST(PlaneAndSphere, RefinementKeepsItsLimitInTheSecondMirror) {
  const auto mirrors = facing_mirrors(400);
  Scene scene = scene_with(mirrors, 5, 3);
  const BounceErrors coarse = bounce_errors(scene, mirrors, picture(scene).frame);
  scene.settings.max_error_px = 0.25;
  const BounceErrors fine = bounce_errors(scene, mirrors, picture(scene).frame);
  // The limit is one of pixels of the map above, in which the convex mirror spans some 40 arcmin a pixel.
  EXPECT_GT(quantile(coarse.arcmin[2], 0.5), 60);
  EXPECT_LT(quantile(fine.arcmin[2], 0.5), 10);
}

TEST(PvrrBounces, ColoursAreThoseOfTheRayTracer) {
  for (const double radius : {0.0, 1200.0}) {
    Scene scene = scene_with(facing_mirrors(radius), 33, 4);
    scene.optics[0].reflectance = {0.9f, 0.6f, 0.5f};
    scene.optics[1].reflectance = {0.4f, 0.8f, 0.9f};
    Renderer renderer(scene);
    const auto options = picture_of(scene);
    const Frame exact = renderer.render(Mode::raytrace, scene.camera, options).frame,
                shown = renderer.render(Mode::pvrr, scene.camera, options).frame;
    std::size_t same = 0, several = 0;
    for (std::size_t i = 0; i < exact.color.size(); ++i) {
      if (exact.bounces[i] < 2) continue;
      ++several;
      same += glm::length(exact.color[i] - shown.color[i]) < 0.02f;
    }
    EXPECT_GT(several, 9000u);
    // The others lie on edges, which maps blur by a texel at each bounce.
    EXPECT_GT(double(same) / double(several), 0.93) << radius;
    EXPECT_GT(image_error(exact, shown).psnr_db, 28) << radius;
  }
}

/// Share of the pixels of at least two optics in `exact` that `shown` shows by the same way, and the median
/// angle there.
struct WayAgreement {
  std::size_t pixels = 0;
  double same = 0, median_arcmin = 0;
};
WayAgreement agreement(const Frame& exact, const Frame& shown) {
  WayAgreement result;
  std::vector<double> angles;
  for (std::size_t i = 0; i < exact.color.size(); ++i) {
    if (exact.bounces[i] < 2) continue;
    ++result.pixels;
    if (path_of(shown, i) != path_of(exact, i)) continue;
    const glm::dvec3 from(exact.surface[i]);
    angles.push_back(angle_arcmin(glm::dvec3(exact.direction[i]), shown_direction(shown, i, from)));
  }
  std::sort(angles.begin(), angles.end());
  result.same = double(angles.size()) / double(std::max<std::size_t>(1, result.pixels));
  result.median_arcmin = quantile(angles, 0.5);
  return result;
}

WayAgreement pvrr_agrees(const Scene& scene) {
  Renderer renderer(scene);
  const auto options = picture_of(scene);
  return agreement(renderer.render(Mode::raytrace, scene.camera, options).frame,
                   renderer.render(Mode::pvrr, scene.camera, options).frame);
}

// A lens before a mirror, seen directly: the light passes it on its way to the mirror and, near the middle,
// once more.
TEST(PvrrBounces, MirrorThroughALensAndALensInAMirror) {
  Scene scene = scene_of({PlacedMirror::facing({0, 0, 0}, {0.3, 0.1, 1}, 420, 320, 1200)}, 17, 3);
  scene.camera = {{-100, 60, 700}, {10, 0, 0}, {0, 1, 0}, 0.45, {320, 240}};
  const auto lens = [](const glm::dvec3& middle, double front, double back, double thickness, double width) {
    auto optic = spherical_lens(front, back, thickness, width, 25);
    optic.wavelengths = 1;
    return optics::placed(optic, {glm::dmat3(1), middle});
  };
  // Rim and reflection of the glass play no part; with refinement, since a lens's own mesh is coarse.
  scene.settings.max_error_px = 0.25;
  scene.optics.push_back(lens({-60, 30, 250}, 400, 400, 8, 120));
  const WayAgreement through = pvrr_agrees(scene);
  EXPECT_GT(through.pixels, 5000u);
  EXPECT_GT(through.same, 0.95);
  EXPECT_LT(through.median_arcmin, 3);
  // To the right of the line of sight, so that it is seen in the mirror alone.
  scene.optics[1] = lens({170, 60, 300}, 400, 400, 8, 120);
  const WayAgreement in_mirror = pvrr_agrees(scene);
  EXPECT_GT(in_mirror.pixels, 1000u);
  EXPECT_GT(in_mirror.same, 0.9);
  EXPECT_LT(in_mirror.median_arcmin, 3);
}

TEST(PvrrBounces, KeptMapsChangeNoByte) {
  Scene scene = scene_with(facing_mirrors(1200), 9, 3);
  scene.settings.max_error_px = 0.5;
  Renderer renderer(scene);
  FrameOptions options = picture_of(scene);
  const auto first = renderer.render(Mode::pvrr, scene.camera, options);
  const auto kept = renderer.render(Mode::pvrr, scene.camera, options);
  EXPECT_TRUE(same_bytes(first.frame, kept.frame));
  for (const MapStats& map : kept.stats.maps) {
    EXPECT_FALSE(map.drawn) << map.way;
    EXPECT_EQ(map.rays, 0u) << map.way;
  }
  Camera elsewhere = scene.camera;
  elsewhere.eye_mm += glm::dvec3(-20, 60, 40);
  (void)renderer.render(Mode::pvrr, elsewhere, options);
  options.reuse_static = false;
  EXPECT_TRUE(same_bytes(first.frame, renderer.render(Mode::pvrr, scene.camera, options).frame));
}

TEST(PvrrBounces, MovedMirrorIsSeenWhereItIs) {
  const auto mirrors = facing_mirrors(1200);
  const Scene there = scene_with(mirrors, 17, 3);
  // The same scene with the second mirror as it is in its own frame, put in its place afterwards.
  Scene moved = there;
  moved.optics[1] = conic_mirror(1200, 0, 420, 320, 17, 17);
  moved.optics[1].name = there.optics[1].name;
  Renderer renderer(moved);
  const auto options = picture_of(moved);
  (void)renderer.render(Mode::pvrr, moved.camera, options);
  glm::dmat4 placement(mirrors[1].at.rotation);
  placement[3] = glm::dvec4(mirrors[1].at.translation_mm, 1);
  renderer.place_optic(1, placement);
  const Frame frame = renderer.render(Mode::pvrr, moved.camera, options).frame;
  EXPECT_GT(image_error(picture(there).frame, frame).psnr_db, 50);
  const BounceErrors errors = bounce_errors(there, mirrors, frame);
  EXPECT_GT(errors.arcmin[3].size(), 2000u);
  EXPECT_LT(quantile(errors.arcmin[3], 0.5), 0.5);
}

// Six mirrors around the eye, all of which see each other: the tree would have some 5^9 maps.
TEST(PvrrBounces, NumberOfMapsHasALimitOfWhichAWarningTells) {
  std::vector<PlacedMirror> mirrors;
  for (int k = 0; k < 6; ++k) {
    const double a = k * 3.14159265358979 / 3;
    mirrors.push_back(PlacedMirror::facing({900 * std::cos(a), 0, 900 * std::sin(a)},
                                           {-std::cos(a), 0, -std::sin(a)}, 800, 600));
  }
  Scene scene = scene_of(mirrors, 3, 10);
  scene.camera = {{0, 0, 0}, {900, 0, 0}, {0, 1, 0}, 1.2, {64, 48}};
  const RenderResult result = picture(scene);
  EXPECT_LE(result.stats.maps.size(), 256u);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_NE(result.warnings.back().find("limit of 256"), std::string::npos) << result.warnings.back();
}

}  // namespace
}  // namespace catoptra::render
