// Mode exact: nothing that it shows in an optic is wrong, and what was wrong is what it traces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/comparison.h"
#include "render/src/pixel_error.h"
#include "tests/render/lens_pvrr_scene.h"
#include "tests/support/analytic_optic.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

RenderResult rendered(const Scene& scene, Mode mode, int samples = 1) {
  return Renderer(scene).render(mode, scene.camera, picture_of(scene, samples));
}

double share(const RenderResult& result) {
  const OpticStats& optic = result.stats.optics.at(0);
  return double(optic.retraced_pixels) / double(optic.shown_pixels);
}

/// The room from aside, with a bar so near to the mirror that one viewpoint gets its edges wrong.
Scene mirror_before_room(double radius_mm) {
  Scene scene = room();
  scene.camera.eye_mm = {420, 160, 560};
  scene.camera.fov_rad = 0.25;
  add_box(scene.surroundings[0], {-300, -500, 380}, {-270, 500, 400}, kYellow);
  scene.optics.push_back(conic_mirror(radius_mm, 0, 170, 110, 25, 17));
  return scene;
}

/// A dispersing lens of about +4 D before a wall of panels, with a bar between them.
Scene colours_behind_lens() {
  Scene scene = wall_behind_lens(70, 0.6, 3000);
  for (int i = 0; i < 6; ++i)
    add_quad(scene.surroundings[0], {1200.f - 400.f * float(i), -1200, 2990}, {-200, 0, 0}, {0, 2400, 0},
             i % 2 ? kRed : kBlue);
  add_box(scene.surroundings[0], {-40, -600, 700}, {30, 600, 720}, kGreen);
  scene.optics.push_back(lens_of(400, 95.2, 2, 60, 25, 3, optics::abbe_medium(1.586, 30)));
  return scene;
}

/// Pixels of the optic (in both pictures) that show another place than the exact ray meets: off the ray by
/// more than an arcminute and half a pixel, or on another surface, by the distance along the ray. An
/// independent count: by distances, not by planes.
struct Wrong {
  std::size_t pixels = 0, turned = 0, elsewhere = 0;
};

Wrong count_wrong(const Frame& reference, const Frame& frame, double pixel_size_arcmin) {
  Wrong wrong;
  for (std::size_t i = 0; i < reference.color.size(); ++i) {
    if (reference.optic_id[i] != 0 || frame.optic_id[i] != 0) continue;
    ++wrong.pixels;
    const glm::dvec3 surface(reference.surface[i]), direction(reference.direction[i]);
    const glm::dvec3 shown = test::shown_direction(frame, i, surface);
    wrong.turned += angle_arcmin(shown, direction) > std::max(1.0, 0.5 * pixel_size_arcmin) ? 1 : 0;
    if (reference.position[i].w != frame.position[i].w) ++wrong.elsewhere;
    if (reference.position[i].w == 0 || frame.position[i].w == 0) continue;
    const double met = glm::distance(glm::dvec3(reference.position[i]), surface);
    wrong.elsewhere += std::abs(glm::length(shown) - met) > 0.04 * met ? 1 : 0;
  }
  return wrong;
}

TEST(ExactMode, ShowsNothingWrongInAMirrorAndTracesLittle) {
  const Scene scene = mirror_before_room(500);
  const Frame reference = rendered(scene, Mode::raytrace).frame;
  const RenderResult pvrr = rendered(scene, Mode::pvrr), exact = rendered(scene, Mode::exact);
  // At 718 mm from a mirror of R 500 the angle of a pixel grows by 1 + 2 * 718 / (500 cos 38), at most; seen
  // from the place where it is reflected, its width there, 718 / cos 38 times its angle, adds to that for
  // what is 380 mm off.
  const double pixel = (4.7 + 718 / (380 * 0.788)) * pixel_arcmin(scene);
  const Wrong before = count_wrong(reference, pvrr.frame, pixel),
              after = count_wrong(reference, exact.frame, pixel);
  ASSERT_GT(after.pixels, 10000u);
  EXPECT_GT(before.elsewhere, 20u) << "the scene no longer has what the mode is for";
  EXPECT_EQ(after.turned, 0u);
  EXPECT_EQ(after.elsewhere, 0u);
  EXPECT_LT(share(exact), 0.15);
  EXPECT_GT(share(exact), 0.0);
  EXPECT_TRUE(exact.warnings.empty());
}

/// By the measures of the comparison: pixels off by more than an arcminute that are off by more than half a
/// pixel.
std::size_t pixels_out_of_tolerance(const Frame& reference, const Frame& frame) {
  std::size_t out = 0;
  for (std::size_t i = 0; i < reference.color.size(); ++i) {
    if (reference.optic_id[i] != 0 || frame.optic_id[i] != 0) continue;
    const auto direction = render::shown_direction(reference, frame, i);
    if (!direction) {
      ++out;
      continue;
    }
    if (kArcminPerRad * angle(*direction, glm::dvec3(reference.direction[i])) <= 1.001) continue;
    const auto px = screen_error(reference, frame, i, *direction);
    out += !px || *px > 0.501 ? 1 : 0;
  }
  return out;
}

TEST(ExactMode, ComparisonHoldsOnMirrorsAndLenses) {
  for (const Scene& scene : {mirror_before_room(1200), mirror_before_room(300), mirror_before_room(-1500),
                             colours_behind_lens()}) {
    const Frame reference = rendered(scene, Mode::raytrace).frame;
    const RenderResult exact = rendered(scene, Mode::exact);
    const OpticError error = compare(reference, exact.frame, scene).optics.at(0);
    ASSERT_GT(error.pixels, 10000u);
    EXPECT_EQ(error.outline_pixels, 0u) << scene.optics[0].name;
    EXPECT_EQ(pixels_out_of_tolerance(reference, exact.frame), 0u) << scene.optics[0].name;
  }
}

TEST(ExactMode, TracedPixelsAreThoseOfTheReference) {
  const Scene scene = mirror_before_room(300);
  const Frame reference = rendered(scene, Mode::raytrace).frame, exact = rendered(scene, Mode::exact).frame;
  ASSERT_EQ(exact.retraced.size(), exact.color.size());
  std::size_t traced = 0;
  for (std::size_t i = 0; i < exact.color.size(); ++i) {
    if (!exact.retraced[i]) continue;
    ++traced;
    ASSERT_EQ(exact.color[i], reference.color[i]);
    ASSERT_EQ(exact.position[i], reference.position[i]);
  }
  EXPECT_GT(traced, 20u) << "of the few that no patch's map shows";
}

TEST(ExactMode, PlaneMirrorTracesNothing) {
  Scene scene = room();
  scene.surroundings[0] = {};
  add_quad(scene.surroundings[0], {4000, -3400, 5000}, {-8000, 0, 0}, {0, 6800, 0}, glm::vec3(0.7f));
  scene.optics.push_back(conic_mirror(0, 0, 170, 110, 3, 3));
  const RenderResult exact = rendered(scene, Mode::exact);
  EXPECT_GT(exact.stats.optics.at(0).shown_pixels, 10000u);
  EXPECT_EQ(exact.stats.optics.at(0).retraced_pixels, 0u);
}

TEST(ExactMode, SameBytesOnAnyNumberOfThreadsAndInAnyOrder) {
  const Scene scene = colours_behind_lens();
  FrameOptions options = picture_of(scene, 2);
  Renderer renderer(scene);
  options.threads = 1;
  options.geometry = false;  // first, so that no target with geometry is there yet
  const Frame first = renderer.render(Mode::exact, scene.camera, options).frame;
  options.threads = 3;
  options.geometry = true;
  (void)renderer.render(Mode::pvrr, scene.camera, options);
  const Frame again = renderer.render(Mode::exact, scene.camera, options).frame;
  EXPECT_TRUE(first.optic_id.empty());
  EXPECT_EQ(first.color, again.color);
  EXPECT_EQ(first.retraced, again.retraced);
}

TEST(ExactMode, MoreSamplesComeNearerToTheReference) {
  const Scene scene = mirror_before_room(600);
  const auto psnr = [&](Mode mode, int samples) {
    return image_error(rendered(scene, Mode::raytrace, samples).frame, rendered(scene, mode, samples).frame)
        .psnr_db;
  };
  const double one = psnr(Mode::exact, 1), four = psnr(Mode::exact, 4);
  EXPECT_GT(four, one);
  EXPECT_GT(four, psnr(Mode::pvrr, 4));
}

TEST(ExactMode, WithoutOpticItIsTheRasterPicture) {
  const Scene scene = room();
  const RenderResult exact = rendered(scene, Mode::exact);
  EXPECT_EQ(exact.frame.color, rendered(scene, Mode::pvrr).frame.color);
  EXPECT_EQ(std::count(exact.frame.retraced.begin(), exact.frame.retraced.end(), 1), 0);
}

}  // namespace
}  // namespace catoptra::render
