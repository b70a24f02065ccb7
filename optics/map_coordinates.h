// PVRR step 3: texture coordinates at which each vertex shows exactly what its ray hits (paper 3.4;
// design 2.5).
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "optics/optic.h"
#include "optics/vertex_hits.h"
#include "optics/virtual_view.h"

namespace catoptra::optics {

/// How the third homogeneous coordinate is chosen, which decides what is shown *between* vertices.
enum class MapInterpolation {
  affine,      ///< q = 1, the paper's
  homography,  ///< q = denominator of the least-squares homography from the optic's tangent plane to the map
};

/// Homogeneous map coordinates (s q, t q, q), one per vertex; the vertex shows (s, t). q > 0.
/// Vertices that do not face the eye get the coordinates of their direction's projection, or (0.5, 0.5, 1).
[[nodiscard]] std::vector<glm::dvec3> map_coordinates(
    const Optic& optic, std::span<const VertexHit> hits, const VirtualView& view,
    MapInterpolation interpolation = MapInterpolation::homography);

}  // namespace catoptra::optics
