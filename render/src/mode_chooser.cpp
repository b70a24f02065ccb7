#include "render/src/mode_chooser.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>

namespace catoptra::render {
namespace {

// Sides of the small pictures, as parts of the whole's. Each is drawn twice, and the faster counts: programs
// are compiled and the memory of a size is touched the first time.
constexpr std::array<int, 4> kTrialParts{8, 8, 4, 4};
constexpr glm::ivec2 kSmallestTrial{32, 18};

// A mode is tried in a whole frame while it may be the fastest: predictions from small pictures are off by
// about so much, the first whole frame costs up to so much more than the others, and what keeps its map while
// all is at rest is faster then by up to so much (measured: docs/decisions/0014).
constexpr double kDoubt = 1.8, kFirstFrame = 1.6;
constexpr double kRestGainPvrr = 4, kRestGainExact = 2;

// The costs of all modes are found out again when the mode in use has changed its own by so much.
constexpr double kChanged = 1.6;
constexpr int kStrangeFrames = 3;

// What mode `exact` promises: docs/decisions/0009-exact-mode.md.
constexpr double kExactError_px = 0.5;

std::string text(const char* format, double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

double rest_gain(Mode mode) {
  return mode == Mode::pvrr ? kRestGainPvrr : mode == Mode::exact ? kRestGainExact : 1;
}

}  // namespace

double ModeChooser::Estimate::predicted_ms(double sample_count) const {
  const glm::dvec2 small(trials[0].x, std::min(trials[0].y, trials[1].y)),
      large(trials[2].x, std::min(trials[2].y, trials[3].y));
  // Disturbances must not turn the line upside down.
  const double per_sample =
      large.x > small.x ? std::max(0.0, (large.y - small.y) / (large.x - small.x)) : large.y / large.x;
  return large.y + per_sample * (sample_count - large.x);
}

double ModeChooser::Estimate::expected_ms(const FrameKind& kind) const {
  if (measured_ms[kind.at_rest] >= 0) return measured_ms[kind.at_rest];
  if (measured_ms[0] >= 0) return measured_ms[0];
  return predicted_ms(kind.sample_count());
}

double ModeChooser::Estimate::hoped_ms(const FrameKind& kind) const {
  if (is_measured(kind)) return measured_ms[kind.at_rest];
  if (measured_ms[kind.at_rest] >= 0) return measured_ms[kind.at_rest] / kFirstFrame;
  const double doubt = measured_ms[0] >= 0 ? 1 : kDoubt;
  return expected_ms(kind) / (kind.at_rest ? std::max(doubt, rest_gain(mode)) : doubt);
}

void ModeChooser::Estimate::add_frame(const FrameKind& kind, const FrameCost& cost) {
  double& ms = measured_ms[kind.at_rest];
  int& count = frames[kind.at_rest];
  if (ms < 0)
    ms = cost.total_ms;
  else
    ms = count < 2 ? std::min(ms, cost.total_ms) : 0.5 * (ms + cost.total_ms);
  if (cost.wrong_share < 0 || count > 0) ++count;
}

ModeChooser::ModeChooser(double max_error_px, bool has_optics, bool can_raster)
    : max_error_px_(max_error_px > 0 ? max_error_px : kExactError_px), has_optics_(has_optics) {
  if (can_raster)
    for (const Mode mode : {Mode::pvrr, Mode::exact, Mode::hybrid}) estimates_.push_back({mode, {}});
  estimates_.push_back({Mode::raytrace, {}});
}

void ModeChooser::forget() {
  for (Estimate& e : estimates_) e = {e.mode, {}};
  wrong_share_ = -1;
  moved_frames_ = strange_frames_ = 0;
  usual_ms_ = {-1, -1};
  usual_frames_ = {0, 0};
}

ModeChooser::Estimate* ModeChooser::estimate_of(Mode mode) {
  const auto found =
      std::find_if(estimates_.begin(), estimates_.end(), [&](const Estimate& e) { return e.mode == mode; });
  return found == estimates_.end() ? nullptr : &*found;
}

std::optional<ModeTrial> ModeChooser::next_trial(const FrameKind& kind) {
  if (kind.size != known_for_.size || kind.samples != known_for_.samples) forget();
  known_for_ = kind;
  if (estimates_.size() == 1) return std::nullopt;
  for (const Estimate& e : estimates_) {
    if (e.trials.size() == kTrialParts.size()) continue;
    return ModeTrial{e.mode, glm::max(kind.size / kTrialParts[e.trials.size()], kSmallestTrial)};
  }
  return std::nullopt;
}

void ModeChooser::trial_drawn(const ModeTrial& trial, const FrameCost& cost) {
  const double samples = double(trial.size.x) * trial.size.y;
  estimate_of(trial.mode)->trials.emplace_back(samples, cost.total_ms);
}

bool ModeChooser::meets_error(Mode mode) const {
  if (!has_optics_ || mode == Mode::hybrid || mode == Mode::raytrace) return true;
  if (max_error_px_ < kExactError_px) return false;
  return mode == Mode::exact || wrong_share_ <= kWrongShare;
}

bool ModeChooser::to_be_verified(Mode mode) const {
  return mode == Mode::pvrr && asks_for_verification();
}

const ModeChooser::Estimate& ModeChooser::most_hopeful(const FrameKind& kind) const {
  const Estimate* best = &estimates_.back();
  for (const Estimate& e : estimates_)
    if (meets_error(e.mode) && e.hoped_ms(kind) < best->hoped_ms(kind)) best = &e;
  return *best;
}

ModeChoice ModeChooser::choose(const FrameKind& kind) const {
  ModeChoice choice;
  if (estimates_.size() == 1) {
    choice.reason = "this machine offers no OpenGL 4.5, which the other modes need";
    choice.settled = true;
    return choice;
  }
  const Estimate& best = most_hopeful(kind);
  const bool verify = to_be_verified(best.mode);
  choice.mode = verify ? Mode::exact : best.mode;
  choice.settled = !verify && best.is_measured(kind);
  choice.reason = verify ? "to verify what pvrr shows, which would be the fastest"
                         : reason_for(best, kind, choice.settled);
  for (const Estimate& e : estimates_)
    choice.costs.push_back({e.mode, e.expected_ms(kind), e.is_measured(kind), meets_error(e.mode)});
  return choice;
}

std::string ModeChooser::reason_for(const Estimate& best, const FrameKind& kind, bool settled) const {
  std::string reason = std::string(settled ? "the fastest" : "by prediction the fastest") +
                       (has_optics_ ? text(" that keeps %.3g px", max_error_px_) : std::string()) + ": " +
                       text("%.3g ms", best.expected_ms(kind));
  for (const Estimate& e : estimates_) {
    if (e.mode == best.mode) continue;
    reason += "; " + std::string(mode_name(e.mode)) + text(" %.3g ms", e.expected_ms(kind));
    if (meets_error(e.mode)) continue;
    reason += e.mode == Mode::pvrr && wrong_share_ > kWrongShare
                  ? text(", but %.2g %% of its pixels are off", 100 * wrong_share_)
                  : ", but it does not promise that";
  }
  return reason;
}

void ModeChooser::frame_drawn(Mode mode, const FrameKind& kind, const FrameCost& cost) {
  if (cost.wrong_share >= 0) {
    wrong_share_ = cost.wrong_share;
    moved_frames_ = 0;
  } else if (!kind.at_rest) {
    ++moved_frames_;
  }
  // A frame out of all custom tells nothing of the mode; some of them in a row, that all modes have changed.
  if (cost.wrong_share < 0 && is_strange(mode, kind, cost.total_ms)) {
    if (++strange_frames_ < kStrangeFrames) return;
    const double wrong_share = wrong_share_;
    forget();
    wrong_share_ = wrong_share;
    return;
  }
  strange_frames_ = 0;
  estimate_of(mode)->add_frame(kind, cost);
}

bool ModeChooser::is_strange(Mode mode, const FrameKind& kind, double total_ms) {
  double& usual = usual_ms_[kind.at_rest];
  Mode& usual_mode = usual_mode_[kind.at_rest];
  int& frames = usual_frames_[kind.at_rest];
  if (usual < 0 || usual_mode != mode) frames = 0;
  if (frames < 2) {
    usual = frames == 0 ? total_ms : std::min(usual, total_ms);
    usual_mode = mode;
    ++frames;
    return false;
  }
  return total_ms > kChanged * usual || kChanged * total_ms < usual;
}

}  // namespace catoptra::render
