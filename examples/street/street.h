// The whole street. The driver's eye is 1.2 m above the origin, the car drives towards +y; x is to the right,
// z up.
#pragma once

#include "examples/street/model.h"

namespace catoptra::examples {

/// Road, pavements, houses, cars, signs, lamps and trees: 8,000 to 12,000 triangles, in metres.
[[nodiscard]] Model make_street();

}  // namespace catoptra::examples
