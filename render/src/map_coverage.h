// Which parts of a reflection map its optic can show: a map is a rectangle, and an optic seldom is one.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "render/src/pvrr_atlas.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::render {

/// A rectangle of texels of an atlas.
struct TexelRect {
  glm::ivec2 corner{0, 0}, size{0, 0};
};

/// The parts of the map at `place` (with its guard) that none of `mesh`'s triangles comes near: nearer than
/// 16 texels is seen, farther than 48 is not. `coordinates`: homogeneous map coordinates per vertex; `patch`:
/// the map of each vertex, of which those in `wanted` count, or empty. None where a vertex has no place in
/// the map.
[[nodiscard]] std::vector<TexelRect> unseen_parts(const tessellate::OpticArrays& mesh,
                                                  std::span<const glm::dvec3> coordinates,
                                                  std::span<const std::uint32_t> patch, std::uint32_t wanted,
                                                  const AtlasPlace& place);

}  // namespace catoptra::render
