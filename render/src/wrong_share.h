// How much of what mode pvrr shows in the optics is wrong, by a picture of mode exact.
#pragma once

#include "render/frame.h"

namespace catoptra::render {

/// Of the pixels that show an optic in `exact`, the share in which `shown` (both with geometry, same size)
/// shows another optic or none, is off by more than mode exact allows (pixel_error.h), or shows what lies
/// clearly nearer or farther than what the ray meets. 0 where no optic shows.
[[nodiscard]] double wrong_share(const Frame& exact, const Frame& shown);

}  // namespace catoptra::render
