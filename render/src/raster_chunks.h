// Triangles of the surroundings in groups that lie together, so that a view can leave out or sort whole
// groups.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "cad_import/cad_model.h"
#include "render/src/raster_view.h"

namespace catoptra::render {

/// Consecutive indices of triangles, and the box that holds them, mm.
struct TriangleChunk {
  std::size_t first = 0, count = 0;  ///< in the list of indices
  cad_import::BoundingBox box;
};

/// Reorders the triangles (three entries of `indices` each) so that groups of at most `largest` of them lie
/// together in space: halves at the median of the longest side, again and again. Depends on nothing but its
/// arguments.
[[nodiscard]] std::vector<TriangleChunk> chunk_triangles(std::span<const glm::vec3> positions,
                                                         std::span<std::uint32_t> indices,
                                                         std::size_t largest);

/// What a view sees of a box. Rounding counts in favour of being seen, and of being near.
struct BoxInView {
  bool seen = false;      ///< not wholly beyond one side of the view
  double nearest_mm = 0;  ///< least distance along the direction of view, of any of its points that is seen
};
[[nodiscard]] BoxInView box_in_view(const RasterView& view, const cad_import::BoundingBox& box);

/// The same distance for the triangles themselves, whose box may hold much that they are not; infinite where
/// none is seen.
[[nodiscard]] double nearest_triangle_mm(const RasterView& view, std::span<const glm::vec3> positions,
                                         std::span<const std::uint32_t> indices);

}  // namespace catoptra::render
