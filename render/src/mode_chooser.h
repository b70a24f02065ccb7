// Mode `automatic`: which mode is the fastest that meets the error asked for, from what frames have cost
// (docs/decisions/0014-mode-auto.md). Knows nothing of how a picture is made.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "render/mode.h"

namespace catoptra::render {

/// What decides on the cost of a frame, as far as it is known beforehand.
struct FrameKind {
  glm::ivec2 size{0};
  int samples = 1;
  bool at_rest = false;  ///< nothing has moved since the last frame, and what is known of it may be kept

  [[nodiscard]] double sample_count() const { return double(size.x) * size.y * samples; }
};

/// What is known of a frame that was drawn.
struct FrameCost {
  double total_ms = 0;
  /// Mode exact: of the optics' pixels, those that pvrr shows wrong; < 0: not verified. A picture that was
  /// verified costs more than others.
  double wrong_share = -1;
};

/// A small picture that is to be drawn for its cost.
struct ModeTrial {
  Mode mode;
  glm::ivec2 size{0};
};

class ModeChooser {
 public:
  /// pvrr is taken to meet the error where at least 99.9 % of the optics' pixels do.
  static constexpr double kWrongShare = 0.001;
  /// So often, in frames that move, the pictures of pvrr are verified again.
  static constexpr int kVerifyEvery = 30;

  /// `max_error_px`: asked for. `has_optics`: without any, every mode shows the same. `can_raster`: false on
  /// a machine without OpenGL.
  ModeChooser(double max_error_px, bool has_optics, bool can_raster);

  /// Each is to be drawn, in this order, and told to trial_drawn(), before choose(): none where all that it
  /// takes is known.
  [[nodiscard]] std::optional<ModeTrial> next_trial(const FrameKind& kind);
  void trial_drawn(const ModeTrial& trial, const FrameCost& cost);

  /// Whether what pvrr shows has not been verified for long: FrameCost::wrong_share of the next frame of mode
  /// exact should be known.
  [[nodiscard]] bool asks_for_verification() const {
    return has_optics_ && (wrong_share_ < 0 || moved_frames_ >= kVerifyEvery);
  }

  [[nodiscard]] ModeChoice choose(const FrameKind& kind) const;
  /// A whole frame was drawn by the mode chosen.
  void frame_drawn(Mode mode, const FrameKind& kind, const FrameCost& cost);

  /// The optics have changed: nothing is known any more.
  void forget();

 private:
  /// The cost of one mode: what frames took, or a + b * samples from its trials.
  struct Estimate {
    Mode mode;
    std::vector<glm::dvec2> trials;             ///< samples, ms
    std::array<double, 2> measured_ms{-1, -1};  ///< of the last frames: moving, at rest; < 0: none yet
    std::array<int, 2> frames{0, 0};            ///< so many; the first touches memory and compiles
    void add_frame(const FrameKind& kind, const FrameCost& cost);
    [[nodiscard]] double predicted_ms(double sample_count) const;
    [[nodiscard]] bool is_measured(const FrameKind& kind) const { return frames[kind.at_rest] >= 2; }
    [[nodiscard]] double expected_ms(const FrameKind& kind) const;
    [[nodiscard]] double hoped_ms(const FrameKind& kind) const;
  };

  [[nodiscard]] Estimate* estimate_of(Mode mode);
  [[nodiscard]] const Estimate& most_hopeful(const FrameKind& kind) const;
  [[nodiscard]] bool meets_error(Mode mode) const;
  [[nodiscard]] bool to_be_verified(Mode mode) const;
  [[nodiscard]] std::string reason_for(const Estimate& best, const FrameKind& kind, bool settled) const;
  [[nodiscard]] bool is_strange(Mode mode, const FrameKind& kind, double total_ms);

  double max_error_px_;
  bool has_optics_;
  std::vector<Estimate> estimates_;
  FrameKind known_for_;
  double wrong_share_ = -1;  ///< of pvrr, last time it was verified; < 0: never
  int moved_frames_ = 0;     ///< since then
  int strange_frames_ = 0;   ///< in a row, that cost far more or less than when the mode was chosen
  std::array<double, 2> usual_ms_{-1, -1};  ///< of the mode drawn last: its first frames
  std::array<int, 2> usual_frames_{0, 0};
  std::array<Mode, 2> usual_mode_{Mode::automatic, Mode::automatic};
};

}  // namespace catoptra::render
