// optics::map_coordinates_like where every vertex has the view of its patch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "optics/map_coordinates.h"

namespace catoptra::render {

/// `patch`: per vertex, the view that its coordinates belong to.
[[nodiscard]] std::vector<glm::dvec3> patch_coordinates_like(std::span<const glm::dvec3> reference,
                                                             std::span<const optics::VertexHit> hits,
                                                             std::span<const std::uint32_t> patch,
                                                             std::span<const optics::VirtualView> views);

}  // namespace catoptra::render
