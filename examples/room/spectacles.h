// What lenses are mounted in: a pair of spectacles, a reading glass.
#pragma once

#include "examples/street/model.h"

namespace catoptra::examples {

/// Where the lenses sit and how large they are, metres.
struct SpectacleSize {
  float pupil_distance = 0.064f;  ///< between the lenses' axes
  float lens_diameter = 0.048f;
};

/// Rims, bridge and temples in the wearer's frame: x to the wearer's right, +y the way he looks, z up; the
/// lenses' front vertices lie in the plane y = 0, their axes at x = -/+ half the pupil distance. Metres.
[[nodiscard]] Model make_spectacle_frame(const SpectacleSize& size);

/// The ring of a reading glass and its handle, which hangs down; axes as above, the lens's axis in the
/// middle.
[[nodiscard]] Model make_hand_lens(float lens_diameter);

}  // namespace catoptra::examples
