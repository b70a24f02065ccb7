// A living room to look at through lenses.
#pragma once

#include "examples/street/model.h"

namespace catoptra::examples {

/// The room around a person who sits at the origin, eyes at (0, 0, 1.2), and looks along +y: a table with
/// lamp, cup and books from 0.8 m on, a bookcase at 1.5 m, an easel with a letter chart at 2.6 m, window and
/// picture on the wall at 4 m. Metres, z up.
[[nodiscard]] Model make_room();

}  // namespace catoptra::examples
