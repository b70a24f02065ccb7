// The driver's own car, as far as its left door mirror and its interior mirror see it. Same axes as the
// street: metres, the eye 1.2 m above the origin.
#pragma once

#include "examples/street/model.h"

namespace catoptra::examples {

/// Left of the eye, the car's outer side at x = kFlank: doors, handles, windows, rear wheel. The front window
/// is open (nothing is in it), so that the eye sees the mirror through it. Mirrors do not show where the
/// windscreen begins, and the roof runs on; `to_windscreen` cuts it there, in the plane of make_cockpit(),
/// for a look ahead.
[[nodiscard]] Model make_flank(bool to_windscreen = false);
inline constexpr float kFlank = -0.53f;

/// What stands between the eye and the rear window: seats with head rests, roof, pillars and the window's
/// frame.
[[nodiscard]] Model make_cabin();

/// The shell behind a mirror's glass, in the mirror's own frame (glass towards +z, width along x, height
/// along y), for a spherical glass of `radius_m`: positive convex, negative concave, 0 plane. Nothing of it
/// lies in front of the glass's surface.
[[nodiscard]] Model make_housing(float width_m, float height_m, float radius_m);

}  // namespace catoptra::examples
