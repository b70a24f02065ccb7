// The paints and painted pictures of the street and of the car.
#pragma once

#include <filesystem>
#include <string>

#include "examples/street/model.h"

namespace catoptra::examples {

/// Everything that the builders name. `font` is the outline font of the lettering. Throws std::runtime_error.
[[nodiscard]] Palette make_palette(const std::filesystem::path& font);

/// The text of number plate `index`, 0..5; the paint is called "plate INDEX".
[[nodiscard]] std::string plate_text(int index);

}  // namespace catoptra::examples
