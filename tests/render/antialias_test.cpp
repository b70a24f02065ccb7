// Samples: the same in all modes, the same at once or accumulated; and hardware multisampling.
#include <gtest/gtest.h>

#include "tests/render/antialias_scenes.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

class EveryMode : public ::testing::TestWithParam<Mode> {};
INSTANTIATE_TEST_SUITE_P(Antialias, EveryMode, kAllModes, name_of);

void expect_same(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.color, b.color);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.surface, b.surface);
  EXPECT_EQ(a.optic_id, b.optic_id);
}

TEST_P(EveryMode, AccumulatedOneByOneItIsThePictureOfAllSamplesByteForByte) {
  for (Scene scene : {small_mirror_scene(), small_lens_scene()})
    for (const double pupil_mm : {0.0, 6.0}) {
      scene.camera.pupil_mm = pupil_mm;
      FrameOptions options = picture_of(scene, 8);
      Renderer renderer(scene);
      RenderResult so_far, at_four;
      for (int call = 1; call <= 8; ++call) {
        so_far = renderer.accumulate(GetParam(), scene.camera, options);
        ASSERT_EQ(so_far.stats.samples, call);
        if (call == 4) at_four = so_far;
      }
      expect_same(so_far.frame, Renderer(scene).render(GetParam(), scene.camera, options).frame);
      // With all samples there, another call adds none; and so does the other renderer in steps of 3.
      expect_same(so_far.frame, renderer.accumulate(GetParam(), scene.camera, options).frame);
      Renderer in_steps(scene);
      for (int call = 0; call < 2; ++call) (void)in_steps.accumulate(GetParam(), scene.camera, options, 3);
      const RenderResult last = in_steps.accumulate(GetParam(), scene.camera, options, 3);
      EXPECT_EQ(last.stats.samples, 8);
      expect_same(so_far.frame, last.frame);
      options.samples = 4;
      expect_same(at_four.frame, Renderer(scene).render(GetParam(), scene.camera, options).frame);
    }
}

/// All samples of a picture have one mode, which the first picture of one sample decides.
TEST(Antialias, AutoAccumulatesByOneModeAndSaysWhich) {
  for (const Scene& scene : {small_mirror_scene(), small_lens_scene()}) {
    const FrameOptions options = picture_of(scene, 8);
    Renderer renderer(scene);
    RenderResult so_far;
    for (int call = 1; call <= 4; ++call) {
      so_far = renderer.accumulate(Mode::automatic, scene.camera, options, 2);
      ASSERT_TRUE(so_far.choice);
      EXPECT_NE(so_far.choice->mode, Mode::automatic);
      EXPECT_EQ(so_far.stats.samples, 2 * call);
    }
    expect_same(so_far.frame, Renderer(scene).render(so_far.choice->mode, scene.camera, options).frame);
    // Moved, it may choose another; what it shows is whole again.
    Camera moved = scene.camera;
    moved.eye_mm.x += 1;
    const RenderResult anew = renderer.accumulate(Mode::automatic, moved, options, 8);
    ASSERT_TRUE(anew.choice);
    expect_same(anew.frame, Renderer(scene).render(anew.choice->mode, moved, options).frame);
    EXPECT_FALSE(renderer.accumulate(Mode::raytrace, moved, options).choice);
  }
}

/// With pictures left on the GPU pvrr was verified by a picture that was not there: a crash, in the scenes
/// where pvrr may be the fastest.
TEST(Antialias, AutoVerifiesPicturesThatAreNotReadBack) {
  for (const Scene& scene : {small_mirror_scene(), small_lens_scene()}) {
    FrameOptions options = picture_of(scene, 1, false);
    options.read_back = false;
    Renderer renderer(scene);
    RenderResult result;
    for (int i = 0; i < 12; ++i) result = renderer.render(Mode::automatic, scene.camera, options);
    ASSERT_TRUE(result.choice);
    EXPECT_EQ(result.choice->costs.size(), 4u);
  }
}

TEST_P(EveryMode, AccumulatesAnewWhereAnythingChanges) {
  const Scene scene = small_mirror_scene();
  const FrameOptions options = picture_of(scene, 64, false);
  Renderer renderer(scene);
  const auto samples = [&](const Camera& camera, const FrameOptions& with) {
    return renderer.accumulate(GetParam(), camera, with, 3).stats.samples;
  };
  EXPECT_EQ(samples(scene.camera, options), 3);
  EXPECT_EQ(samples(scene.camera, options), 6);
  Camera moved = scene.camera;
  moved.eye_mm.x += 1;
  EXPECT_EQ(samples(moved, options), 3);
  FrameOptions other = options;
  other.threads = 1;
  EXPECT_EQ(samples(moved, other), 3);
  EXPECT_EQ(samples(moved, other), 6);
  renderer.place_optic(0, glm::dmat4(1));
  EXPECT_EQ(samples(moved, other), 9) << "it is there already";
  glm::dmat4 aside(1);
  aside[3] = {1, 0, 0, 1};
  renderer.place_optic(0, aside);
  const RenderResult anew = renderer.accumulate(GetParam(), moved, other, 3);
  EXPECT_EQ(anew.stats.samples, 3);
  Renderer fresh(scene);
  fresh.place_optic(0, aside);
  EXPECT_EQ(anew.frame.color, fresh.accumulate(GetParam(), moved, other, 3).frame.color);
  (void)renderer.render(Mode::raytrace, moved, other);
  EXPECT_EQ(samples(moved, other), 3);
}

TEST_P(EveryMode, ErrorFallsWithTheNumberOfSamples) {
  for (const Scene& scene : {small_mirror_scene(), small_lens_scene()}) {
    Renderer renderer(scene);
    const auto picture = [&](Mode mode, int samples) {
      return renderer.render(mode, scene.camera, picture_of(scene, samples, false)).frame;
    };
    const Frame reference = picture(Mode::raytrace, GetParam() == Mode::raytrace ? 256 : 64);
    const double e1 = rms(reference, picture(GetParam(), 1)), e4 = rms(reference, picture(GetParam(), 4));
    const Frame many = picture(GetParam(), 64);
    const double e64 = rms(reference, many);
    const ImageError error = image_error(reference, many);
    RecordProperty("psnr_db", std::to_string(error.psnr_db));
    std::printf("%s: rms %.4f %.4f %.4f, %.1f dB, FLIP %.4f\n", std::string(mode_name(GetParam())).c_str(),
                e1, e4, e64, error.psnr_db, error.flip_mean);
    EXPECT_LT(e4, e1);
    EXPECT_LT(e64, e4);
    if (GetParam() == Mode::cubemap) continue;  // which shows another place (paper, Fig. 1)
    EXPECT_LT(e64, 0.3 * e1);
    // What is left: in pvrr the parallax of its one viewpoint, in exact up to half a pixel of it, in both
    // texels; in the others half floats, and in raytrace the difference to a reference with four times as
    // many samples.
    const bool maps = GetParam() == Mode::pvrr || GetParam() == Mode::exact;
    EXPECT_GT(error.psnr_db, maps ? 35 : 50);
    EXPECT_LT(error.flip_mean, maps ? 0.02 : 0.006);
  }
}

class EveryRasterMode : public ::testing::TestWithParam<Mode> {};
INSTANTIATE_TEST_SUITE_P(Antialias, EveryRasterMode,
                         ::testing::Values(Mode::pvrr, Mode::hybrid, Mode::exact, Mode::cubemap), name_of);

double farthest_mm(const Frame& a, const Frame& b) {
  double farthest = 0;
  for (std::size_t i = 0; i < a.position.size(); ++i)
    farthest = std::max(farthest, double(glm::distance(a.position[i], b.position[i])));
  return farthest;
}

TEST_P(EveryRasterMode, MultisamplingSmoothsOutlinesAndKeepsGeometry) {
  for (const Scene& scene : {small_mirror_scene(), small_lens_scene()}) {
    Renderer renderer(scene);
    FrameOptions options = picture_of(scene);
    const Frame plain = renderer.render(GetParam(), scene.camera, options).frame;
    const Frame reference = renderer.render(Mode::raytrace, scene.camera, picture_of(scene, 64)).frame;
    options.multisample = 4;
    const RenderResult smooth = renderer.render(GetParam(), scene.camera, options);
    EXPECT_TRUE(smooth.warnings.empty());
    // Modes that trace take a pixel more or less beside the outline, whose place is then not rounded alike.
    const bool traces = GetParam() == Mode::hybrid || GetParam() == Mode::exact;
    EXPECT_LT(farthest_mm(plain, smooth.frame), traces ? 0.02 : 1e-9);
    EXPECT_EQ(plain.surface, smooth.frame.surface);
    EXPECT_EQ(plain.direction, smooth.frame.direction);
    EXPECT_EQ(plain.optic_id, smooth.frame.optic_id);
    // Colours do not depend on whether geometry was drawn too.
    options.geometry = false;
    EXPECT_EQ(smooth.frame.color, renderer.render(GetParam(), scene.camera, options).frame.color);

    // Outlines of optics: pixels beside which the optic ends.
    const auto outline = [&](std::size_t i) {
      const auto width = std::size_t(plain.width);
      if (i % width == 0 || i % width == width - 1 || i < width || i + width >= plain.color.size())
        return false;
      for (const std::size_t k : {i - 1, i + 1, i - width, i + width})
        if (plain.optic_id[k] != plain.optic_id[i]) return true;
      return false;
    };
    const double before = rms(reference, plain, outline), after = rms(reference, smooth.frame, outline);
    std::printf("%s: outline %.4f -> %.4f, all %.4f -> %.4f\n", std::string(mode_name(GetParam())).c_str(),
                before, after, rms(reference, plain), rms(reference, smooth.frame));
    // Where a lens's light is cut off within it, at the rim of its other side, hardware sees no outline.
    EXPECT_LT(after, (scene.optics[0].kind == optics::OpticKind::lens ? 0.8 : 0.7) * before);
    EXPECT_LT(rms(reference, smooth.frame), rms(reference, plain));
  }
}

TEST(Multisample, TellsWhereTheDriverHasLessAndRefusesOtherNumbers) {
  const Scene scene = small_mirror_scene();
  Renderer renderer(scene);
  FrameOptions options = picture_of(scene, 1, false);
  options.multisample = 3;
  EXPECT_THROW((void)renderer.render(Mode::pvrr, scene.camera, options), Error);
  options.multisample = 4;
  const RenderResult four = renderer.render(Mode::pvrr, scene.camera, options);
  options.multisample = 8;
  const RenderResult eight = renderer.render(Mode::pvrr, scene.camera, options);
  // Either the driver has eight, or it says so and draws with the four that OpenGL 4.5 demands.
  if (eight.warnings.empty())
    EXPECT_NE(four.frame.color, eight.frame.color);
  else
    EXPECT_EQ(four.frame.color, eight.frame.color);
}

TEST(Multisample, SeveralSamplesTakeItsPlace) {
  const Scene scene = small_mirror_scene();
  Renderer renderer(scene);
  FrameOptions options = picture_of(scene, 4, false);
  const Frame plain = renderer.render(Mode::pvrr, scene.camera, options).frame;
  options.multisample = 4;
  EXPECT_EQ(plain.color, renderer.render(Mode::pvrr, scene.camera, options).frame.color);
}

}  // namespace
}  // namespace catoptra::render
