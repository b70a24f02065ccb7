// The mesh of an optic cut into patches (paper 4.1; design 2.8): every patch has vertices of its own, also
// where patches touch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tessellate/optic_arrays.h"

namespace catoptra::render {

/// Vertices and triangles of one patch follow each other.
struct PatchRange {
  std::size_t first_vertex = 0, vertices = 0, first_triangle = 0, triangles = 0;
};

/// A vertex on a border between patches is repeated once for each patch that touches it, at the same place:
/// it has one ray and one hit, and map coordinates in each. For tessellate::RefinedMesh such a border is a
/// crease, whose edges are split at both sides or at none.
struct PatchMesh {
  tessellate::OpticArrays mesh;
  std::vector<std::uint32_t> source;  ///< per vertex, its number in the whole mesh
  std::vector<std::uint32_t> patch;   ///< per vertex
  std::vector<PatchRange> ranges;     ///< per patch
  std::vector<tessellate::OpticArrays>
      patches;  ///< each alone, with vertices numbered from 0, without borders
};

/// Cuts `whole` by the patch of each triangle (0 .. `count` - 1, each of which has one at least). Within a
/// patch vertices and triangles keep their order.
[[nodiscard]] PatchMesh cut_into_patches(const tessellate::OpticArrays& whole,
                                         std::span<const std::uint32_t> patch_of_triangle, std::size_t count);

/// `values` of the whole mesh's vertices, one per vertex of the patches.
template <typename T>
[[nodiscard]] std::vector<T> gathered(std::span<const T> values, std::span<const std::uint32_t> source) {
  std::vector<T> result;
  result.reserve(source.size());
  for (const std::uint32_t i : source) result.push_back(values[i]);
  return result;
}

}  // namespace catoptra::render
