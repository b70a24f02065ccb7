// The steps between a MirrorBlank and its solid, shared by the mirror_blank*.cpp files.
#pragma once

#include "cad_import/mirror_blank.h"
#include "cad_import/src/blank_parts.h"

namespace catoptra::cad_import {

/// Throws Error, naming the key, where `blank` cannot be made.
void check_blank(const MirrorBlank& blank);

[[nodiscard]] OutlineBox outline_box(const MirrorBlank& blank);
/// Distance of the strip's outer edge from the pole.
[[nodiscard]] double aspheric_edge_mm(const AsphericPart& part, const OutlineBox& box);
/// mirror_sag_mm without the checks of the blank.
[[nodiscard]] double ideal_sag_mm(const MirrorBlank& blank, const OutlineBox& box, double x_mm, double y_mm);

}  // namespace catoptra::cad_import
