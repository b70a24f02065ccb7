// What the wearer of a lens sees: a wall with a square grid, by exact rays.
#pragma once

#include <string>

#include "app/src/lens_source.h"
#include "optics/lens_evaluation.h"

namespace catoptra::app {

struct LensPictureOptions {
  int width = 720, height = 540, samples = 4;
  double wall_mm = 2000;  ///< from the entrance pupil
  double grid_deg = 5;    ///< lines straight ahead and so far apart on the wall, seen without the lens
  double fov_deg = 75;    ///< vertical
};

/// The picture as PNG bytes: the eye's entrance pupil at its place behind the lens, looking straight ahead;
/// beside the lens the wall is seen without it. Up is up for the wearer, so +x of the lens is on the left.
/// Throws catoptra::Error.
[[nodiscard]] std::string lens_picture_png(const LensSource& source, const optics::WearingPosition& position,
                                           const LensPictureOptions& options = {});

}  // namespace catoptra::app
