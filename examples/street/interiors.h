// Houses one looks into: their windows are holes, for panes or mirrors in the scene.
#pragma once

#include "examples/street/model.h"

namespace catoptra::examples {

/// Three houses of 8 m with a shop in each, dim inside, goods behind the glass. Placed like a house: fronts
/// in y = 0, from x = 0 to -24. The hole of shop k = 0, 1, 2 runs from x = -0.5 - 8 k to -6.1 - 8 k and from
/// z = 0.5 to 2.3.
[[nodiscard]] Model make_shop_row();

/// A house of 22 m with 20 windows of 1.1 x 1.55 m and a dim room behind each; placed like a house. The hole
/// of column c = 0 .. 9 and storey s = 0, 1 runs from x = -0.55 - 2.2 c to -1.65 - 2.2 c and from z = 0.85
/// + 2.9 s to 2.40 + 2.9 s.
[[nodiscard]] Model make_window_front();

}  // namespace catoptra::examples
