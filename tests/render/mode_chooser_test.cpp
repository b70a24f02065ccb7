// Which mode `auto` takes, for costs that are made up: no clock decides here.
#include "render/src/mode_chooser.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <utility>

namespace catoptra::render {
namespace {

/// A machine on which each mode costs a fixed time and one per sample.
struct Machine {
  std::map<Mode, glm::dvec2> costs;  ///< ms, ms per 1e6 samples
  double first = 1;                  ///< how much more the first picture of a mode costs at each size
  double wrong_share = 0.03;
  double gain_at_rest = 1;  ///< of pvrr

  [[nodiscard]] FrameCost draw(Mode mode, glm::ivec2 size, bool at_rest, bool verified) {
    const double more = drawn.emplace(mode, size.x).second ? first : 1;
    const auto ms = [&](Mode m) {
      const double gain = at_rest && m == Mode::pvrr ? gain_at_rest : 1;
      return (costs.at(m).x + costs.at(m).y * 1e-6 * size.x * size.y) / gain;
    };
    return {more * ms(mode), verified && mode == Mode::exact ? wrong_share : -1};
  }

  std::set<std::pair<Mode, int>> drawn{};
};

constexpr FrameKind kFrame{{1280, 720}, 1, false}, kStill{{1280, 720}, 1, true};

ModeChoice next_frame(ModeChooser& chooser, Machine& machine, const FrameKind& kind = kFrame) {
  while (const auto trial = chooser.next_trial(kind))
    chooser.trial_drawn(*trial, machine.draw(trial->mode, trial->size, false, false));
  const ModeChoice choice = chooser.choose(kind);
  const bool verified = chooser.asks_for_verification();
  chooser.frame_drawn(choice.mode, kind, machine.draw(choice.mode, kind.size, kind.at_rest, verified));
  return choice;
}

ModeChoice settled(ModeChooser& chooser, Machine machine, const FrameKind& kind = kFrame) {
  ModeChoice choice;
  for (int i = 0; i < 12 && !choice.settled; ++i) choice = next_frame(chooser, machine, kind);
  EXPECT_TRUE(choice.settled);
  return choice;
}

Machine slow_rays() {
  return {{{Mode::pvrr, {10, 50}},
           {Mode::exact, {12, 80}},
           {Mode::hybrid, {5, 200}},
           {Mode::raytrace, {0, 300}}}};
}

Machine slow_raster() {
  return {
      {{Mode::pvrr, {90, 50}}, {Mode::exact, {92, 80}}, {Mode::hybrid, {40, 30}}, {Mode::raytrace, {0, 60}}}};
}

TEST(ModeChooser, TakesTheFastestThatKeepsTheError) {
  ModeChooser rays(0.5, true, true), raster(0.5, true, true);
  EXPECT_EQ(settled(rays, slow_rays()).mode, Mode::exact);  // 3 % of pvrr's pixels are off
  EXPECT_EQ(settled(raster, slow_raster()).mode, Mode::raytrace);
  Machine right = slow_rays();
  right.wrong_share = 0.0005;
  ModeChooser clean(0.5, true, true);
  EXPECT_EQ(settled(clean, right).mode, Mode::pvrr);
}

TEST(ModeChooser, SaysWhichAndWhy) {
  ModeChooser chooser(0.5, true, true);
  const ModeChoice choice = settled(chooser, slow_rays());
  EXPECT_NE(choice.reason.find("the fastest that keeps 0.5 px"), std::string::npos) << choice.reason;
  EXPECT_NE(choice.reason.find("3 % of its pixels are off"), std::string::npos) << choice.reason;
  ASSERT_EQ(choice.costs.size(), 4u);
  EXPECT_FALSE(choice.costs[0].meets_error);
  EXPECT_TRUE(choice.costs[1].measured);
  EXPECT_NEAR(choice.costs[3].frame_ms, 300 * 0.9216, 0.01);  // a straight line is predicted as it is
}

TEST(ModeChooser, ErrorsBelowThatOfExactModeNeedRaysInAllPixels) {
  ModeChooser chooser(0.1, true, true);
  EXPECT_EQ(settled(chooser, slow_rays()).mode, Mode::hybrid);
}

TEST(ModeChooser, TracesWhereThereIsNoOpenGl) {
  ModeChooser chooser(0.5, true, false);
  Machine machine = slow_rays();
  const ModeChoice choice = next_frame(chooser, machine);
  EXPECT_EQ(choice.mode, Mode::raytrace);
  EXPECT_NE(choice.reason.find("OpenGL"), std::string::npos);
}

TEST(ModeChooser, WithoutOpticsNothingIsVerified) {
  ModeChooser chooser(0.5, false, true);
  EXPECT_EQ(settled(chooser, slow_rays()).mode, Mode::pvrr);
  Machine machine = slow_rays();
  for (int i = 0; i < 40; ++i) EXPECT_EQ(next_frame(chooser, machine).mode, Mode::pvrr) << i;
}

TEST(ModeChooser, VerifiesPvrrAgainWhileTheSceneMoves) {
  Machine machine = slow_rays();
  machine.wrong_share = 0;
  ModeChooser chooser(0.5, true, true);
  int verified = 0;
  for (int i = 0; i < 1 + 3 * ModeChooser::kVerifyEvery; ++i) {
    const bool asked = chooser.asks_for_verification();
    const bool exact = next_frame(chooser, machine).mode == Mode::exact;
    if (asked) verified += exact;
  }
  EXPECT_EQ(verified, 3);
  machine.wrong_share = 0.02;  // a bar comes near
  Mode last{};
  for (int i = 0; i <= ModeChooser::kVerifyEvery; ++i) last = next_frame(chooser, machine).mode;
  EXPECT_EQ(last, Mode::exact);
}

TEST(ModeChooser, TriesWhatMayBeFasterAtRest) {
  Machine machine = slow_raster();
  machine.wrong_share = 0;
  machine.gain_at_rest = 3.5;
  ModeChooser chooser(0.5, true, true);
  EXPECT_EQ(settled(chooser, machine).mode, Mode::raytrace);
  EXPECT_EQ(settled(chooser, machine, kStill).mode, Mode::pvrr);
  EXPECT_EQ(settled(chooser, machine).mode, Mode::raytrace);
}

TEST(ModeChooser, FindsTheCostsOutAgainWhenTheyChange) {
  ModeChooser chooser(0.5, true, true);
  EXPECT_EQ(settled(chooser, slow_rays()).mode, Mode::exact);
  ModeChoice choice;
  Machine slowed = slow_raster();
  for (int i = 0; i < 12; ++i) choice = next_frame(chooser, slowed);
  EXPECT_EQ(choice.mode, Mode::raytrace);
}

/// Programs are compiled and memory is touched in the first picture of each size: 3 times as dear, of which
/// neither predictions nor what is remembered may tell. (A scene of spectacles was drawn by rays for that, in
/// twice the time.)
TEST(ModeChooser, FirstPicturesDoNotCount) {
  Machine machine = slow_rays();
  machine.first = 3;
  machine.wrong_share = 0;
  ModeChooser chooser(0.5, true, true);
  const ModeChoice choice = settled(chooser, machine);
  EXPECT_EQ(choice.mode, Mode::pvrr);
  ASSERT_EQ(choice.costs.size(), 4u);
  EXPECT_NEAR(choice.costs[0].frame_ms, 10 + 50 * 0.9216, 0.01);
  EXPECT_NEAR(choice.costs[3].frame_ms, 300 * 0.9216, 0.01);
  // Nor does the first whole picture look like one out of all custom.
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(next_frame(chooser, machine).settled) << i;
}

/// A frame that was verified also draws geometry.
TEST(ModeChooser, VerifiedFramesAreNoMeasure) {
  ModeChooser chooser(0.5, true, true);
  Machine machine = slow_rays();
  while (const auto trial = chooser.next_trial(kFrame))
    chooser.trial_drawn(*trial, machine.draw(trial->mode, trial->size, false, false));
  chooser.frame_drawn(Mode::exact, kFrame, {300, 0.03});
  for (int i = 0; i < 2; ++i) chooser.frame_drawn(Mode::exact, kFrame, {90, -1});
  const ModeChoice choice = chooser.choose(kFrame);
  EXPECT_EQ(choice.mode, Mode::exact);
  EXPECT_NEAR(choice.costs[1].frame_ms, 90, 1e-9);
}

TEST(ModeChooser, AnotherResolutionIsPredictedAnew) {
  ModeChooser chooser(0.5, true, true);
  EXPECT_EQ(settled(chooser, slow_raster()).mode, Mode::raytrace);
  const FrameKind large{{5120, 2880}, 1, false};
  // 14.7 million samples: hybrid 482 ms, raytrace 885 ms.
  EXPECT_EQ(settled(chooser, slow_raster(), large).mode, Mode::hybrid);
}

}  // namespace
}  // namespace catoptra::render
