// What the driver sees of the own car looking ahead. Same axes as the street.
#pragma once

#include "examples/street/model.h"

namespace catoptra::examples {

/// The left flank, dashboard, steering wheel, bonnet, pillars, header and doors from inside. The windscreen's
/// opening lies in the plane through (x, 1.02, 0.94) and (x, 0.40, 1.41).
[[nodiscard]] Model make_cockpit();

}  // namespace catoptra::examples
