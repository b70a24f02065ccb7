// The denominators q of the map coordinates: what decides the picture between the vertices.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "optics/vertex_hits.h"
#include "optics/virtual_view.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::optics {

/// What an optic shows, vertex by vertex.
struct MapProblem {
  const tessellate::OpticArrays& mesh;  ///< of the mirror, or of the side of a lens that is entered
  std::span<const VertexHit> hits;
  const VirtualView& view;
  std::span<const std::size_t> facing;  ///< vertices that face the eye
};

/// Homogeneous map coordinates with w > 0 of what the vertex shows.
[[nodiscard]] glm::dvec3 shown_at_vertex(const VertexHit& hit, const VirtualView& view);

/// One denominator > 0 per entry of `facing`, of the homography from the tangent plane at the optic's centre.
[[nodiscard]] std::vector<double> homography_denominators(const MapProblem& problem);

/// One denominator > 0 per entry of `facing`, from the exact derivatives of what the optic shows along its
/// edges.
[[nodiscard]] std::vector<double> fitted_denominators(const MapProblem& problem);

}  // namespace catoptra::optics
