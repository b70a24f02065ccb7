// What stands before a dressing mirror.
#pragma once

#include "examples/street/model.h"

namespace catoptra::examples {

/// A small table with a flask, a lipstick and a card of letters before a mirror whose middle is the origin
/// and which faces +y; z up, metres. All of it stands 0.10 to 0.25 m before the glass: inside the focal
/// length of a mirror of R 600 mm. The lipstick is nearest to the glass.
[[nodiscard]] Model make_dressing_table();

}  // namespace catoptra::examples
