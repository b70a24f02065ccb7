// How many triangles lie one behind the other as a light sees them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>

#include "render/src/shadow_volume.h"

namespace catoptra::render {

/// No ray from the light meets more of the triangles `list` than this. An upper bound: exact for few
/// triangles, else from a tree of cells that is no finer than it has to be. `light` as in
/// make_shadow_volume().
[[nodiscard]] std::size_t most_overlaps(const ShadowCasters& casters, std::span<const std::uint32_t> list,
                                        const glm::dvec4& light);

}  // namespace catoptra::render
