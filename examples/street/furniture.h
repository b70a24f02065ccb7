// What stands on a pavement: lamp posts, traffic signs, trees. Each stands on z = 0 at the origin.
#pragma once

#include <string>

#include "examples/street/model.h"

namespace catoptra::examples {

/// Six metres high, its arm reaching out towards -x.
[[nodiscard]] Model make_lamp_post();

/// A picture on one post, facing +y; `width` and `height` of the picture, `top` the height of its upper edge.
[[nodiscard]] Model make_sign(const std::string& picture, float width, float height, float top);

/// A large board on two posts, facing +y.
[[nodiscard]] Model make_board(const std::string& picture, float width, float height, float top);

/// A tree of `height` metres; `seed` sets where its alpha-tested leaf cards stand.
[[nodiscard]] Model make_tree(float height, const std::string& leaves, int seed);

}  // namespace catoptra::examples
