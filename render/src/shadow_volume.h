// Shadow volumes of triangle meshes (Crow 1977; Bergeron 1986 for meshes that are not closed): no OpenGL
// here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "cad_import/cad_model.h"

namespace catoptra::render {

/// Triangles that cast shadows, corners at the same place being one vertex. Body by body: those of a body
/// hang together by common vertices, which decides nothing but what can be left out of a view as a whole.
struct ShadowCasters {
  struct Edge {
    std::uint32_t a, b;  ///< a < b
  };
  /// Of a triangle's side from corner k to corner k + 1.
  struct Side {
    std::uint32_t edge;
    std::int32_t sense;  ///< 1: it runs from a to b, -1: from b to a
  };
  struct Triangle {
    std::uint32_t corners[3];
    Side sides[3];
  };
  struct Body {
    std::size_t first, count;  ///< triangles
    cad_import::BoundingBox box;
    /// 1 where the body is closed and its triangles run anticlockwise as seen from outside, -1 where all run
    /// clockwise, 0 for any other body.
    int outside = 0;
  };
  std::vector<glm::vec3> positions;  ///< mm
  std::vector<Edge> edges;
  std::vector<Triangle> triangles;
  std::vector<Body> bodies;
};

/// Of three corners for each triangle, in either sense. Triangles without area in the numbers given are left
/// out.
[[nodiscard]] ShadowCasters make_shadow_casters(std::span<const glm::vec3> corners);

/// The volume in which triangles cast shadows: a closed surface that every way from a point to far outside
/// crosses outwards more often than inwards, by one for each triangle between the point and the light. All
/// triangles are turned to face the light, and each edge counts as often as the triangles at it do not
/// cancel, so it makes no difference whether a mesh is closed, in which sense its triangles run, or how many
/// of them share an edge. Of closed bodies that the light is not inside of (as far as their box tells) the
/// triangles turned to the light do alone, with half the volume: a ray that leaves such a body has entered
/// it.
struct ShadowVolume {
  /// Some triangles of one body.
  struct Part {
    std::size_t first;       ///< in `indices`: first the sides and the far cap, ...
    std::size_t side_count;  ///< ... so many, ...
    std::size_t cap_count;   ///< ... then the near cap: the triangles themselves
    cad_import::BoundingBox box;
  };
  /// Parts that cover no point more often than `most` (at most kMostOverlaps).
  struct Batch {
    std::size_t first, count;  ///< parts
    std::size_t most;
  };
  /// Triangles, their outer side anticlockwise. 2 i is caster vertex i, 2 i + 1 the same vertex moved away
  /// from the light to infinity.
  std::vector<std::uint32_t> indices;
  std::vector<Part> parts;
  std::vector<Batch> batches;
  std::size_t silhouette_edges = 0;  ///< counted as often as they are there
};

/// Eight stencil bits tell so many overlapping volumes from none.
inline constexpr std::size_t kMostOverlaps = 255;

/// `light`: (position, 1), or (direction towards the light, 0), in the frame of the casters. Triangles seen
/// edge-on from the light cast nothing.
[[nodiscard]] ShadowVolume make_shadow_volume(const ShadowCasters& casters, const glm::dvec4& light);

}  // namespace catoptra::render
