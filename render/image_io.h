// Pictures on disk: PNG (sRGB) and EXR (linear, with layers), read and written through OpenImageIO.
#pragma once

#include <filesystem>

#include "render/frame.h"

namespace catoptra::render {

/// Writes `frame` by the suffix: .png (8-bit sRGB, colours clamped) or .exr (linear half colour; with
/// `with_geometry` also float layers position.XYZ and position.W, surface.XYZ, direction.XYZ and optic.ID).
/// Written to a temporary name beside the target and renamed. Throws catoptra::Error.
void write_image(const Frame& frame, const std::filesystem::path& file, bool with_geometry = false);

/// Reads colour (to linear) and, from an EXR with the layers above, the geometry. Throws catoptra::Error.
[[nodiscard]] Frame read_image(const std::filesystem::path& file);

/// sRGB transfer curve of one channel, both ways. Source: IEC 61966-2-1.
[[nodiscard]] float linear_to_srgb(float linear);
[[nodiscard]] float srgb_to_linear(float srgb);

}  // namespace catoptra::render
