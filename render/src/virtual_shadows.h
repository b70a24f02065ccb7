// Light volumes of virtual lights, and what casts shadows into them, as triangles (no OpenGL here).
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "optics/light_path.h"

namespace catoptra::render {

/// Three corners for each triangle, in the world, mm.
using TriangleSoup = std::vector<glm::vec3>;

/// The aperture of a virtual light: extruded away from it, its light volume.
[[nodiscard]] TriangleSoup aperture_triangles(const optics::VirtualLight& light);

/// Whose volumes, extruded away from virtual light `index`, are its shadows: what stands behind its face, cut
/// at that (the paper's CAN'T INTERSECT), and what stands before it in the light's way, projected from the
/// light before onto the face (MUST INTERSECT), through all faces on the way. `source`: of the whole list;
/// `casters`: several soups.
[[nodiscard]] TriangleSoup virtual_light_casters(std::span<const TriangleSoup> casters,
                                                 const optics::LightPlace& source,
                                                 std::span<const optics::VirtualLight> lights,
                                                 std::size_t index);

}  // namespace catoptra::render
