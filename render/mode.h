// The modes of rendering, and how mode `automatic` chose one of them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace catoptra::render {

/// `automatic` ("auto"): the fastest of pvrr, exact, hybrid and raytrace that meets the error asked for,
/// RenderSettings::max_error_px (docs/decisions/0014-mode-auto.md).
enum class Mode { pvrr, hybrid, exact, raytrace, cubemap, automatic };

[[nodiscard]] std::string_view mode_name(Mode mode);
[[nodiscard]] std::optional<Mode> mode_from_name(std::string_view name);

/// One of the modes that were weighed against each other.
struct ModeCost {
  Mode mode = Mode::pvrr;
  double frame_ms = 0;      ///< of the next frame: measured, or predicted from small pictures
  bool measured = false;    ///< at this resolution, in the last frames
  bool meets_error = true;  ///< if not, it cannot be chosen
};

struct ModeChoice {
  Mode mode = Mode::raytrace;
  std::string reason;           ///< one sentence for people
  std::vector<ModeCost> costs;  ///< of all that this machine can draw
  double trial_ms = 0;          ///< spent in this frame on small pictures from which costs are predicted
  bool settled = false;         ///< no other mode is left to be tried
};

}  // namespace catoptra::render
