// The paints and painted pictures of the living room.
#pragma once

#include <array>
#include <filesystem>

#include "examples/street/model.h"

namespace catoptra::examples {

/// Titles on the backs of the books; the paint of title `i` is called "book I".
inline constexpr std::array kBookTitles{"ON RAYS", "CATOPTRICS", "PRISMS",  "SNELL",   "DIOPTER", "A TO ABBE",
                                        "LENSES",  "CAUSTICS",   "FRINGES", "MIRRORS", "THE EYE", "SHADOWS",
                                        "FRESNEL", "FOCUS",      "TORIC",   "VERTEX"};

/// Adds everything that the room and the spectacles name. Throws std::runtime_error where `font` is none.
void add_room_paints(Palette& palette, const std::filesystem::path& font);

}  // namespace catoptra::examples
