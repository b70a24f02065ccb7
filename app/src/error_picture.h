// Errors as false colours, with a legend.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "render/frame.h"

namespace catoptra::app {

/// The scale of every error picture, so that pictures can be compared: logarithmic, blue to red.
inline constexpr double kErrorScaleMin_arcmin = 0.01, kErrorScaleMax_arcmin = 100;

/// Linear RGB of an error; beyond the scale its end colour. Colour map: turbo (Mikhailov 2019).
[[nodiscard]] glm::vec3 error_color(double arcmin);

/// `errors_arcmin` as render::error_map_arcmin returns it (below 0: no error known), over a dimmed grey copy
/// of `background`, with the scale drawn at the bottom left where the picture is large enough.
[[nodiscard]] render::Frame error_picture(const render::Frame& background,
                                          std::span<const float> errors_arcmin);

/// The pixels marked (not 0) in orange over a dimmed grey copy of `background`.
[[nodiscard]] render::Frame marked_picture(const render::Frame& background,
                                           std::span<const std::uint8_t> marked);

}  // namespace catoptra::app
