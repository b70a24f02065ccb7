#include "render/src/patch_mesh.h"

#include <limits>

namespace catoptra::render {
namespace {

using tessellate::OpticArrays;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Appends patch `patch` to `cut`, and to `new_triangle` where the whole mesh's triangles have gone.
void append_patch(const OpticArrays& whole, std::span<const std::uint32_t> patch_of_triangle,
                  std::uint32_t patch, PatchMesh& cut, std::vector<std::uint32_t>& new_triangle) {
  std::vector<std::uint32_t> number(whole.vertices.size(), kNone);
  for (std::size_t t = 0; t < whole.triangles.size(); ++t)
    if (patch_of_triangle[t] == patch)
      for (const std::uint32_t v : whole.triangles[t].vertices) number[v] = 0;
  OpticArrays alone;
  const auto base = static_cast<std::uint32_t>(cut.mesh.vertices.size());
  for (std::uint32_t v = 0; v < whole.vertices.size(); ++v) {
    if (number[v] == kNone) continue;
    number[v] = static_cast<std::uint32_t>(alone.vertices.size());
    alone.vertices.push_back(whole.vertices[v]);
    cut.mesh.vertices.push_back(whole.vertices[v]);
    cut.source.push_back(v);
    cut.patch.push_back(patch);
  }
  const std::size_t first_triangle = cut.mesh.triangles.size();
  for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
    if (patch_of_triangle[t] != patch) continue;
    new_triangle[t] = static_cast<std::uint32_t>(cut.mesh.triangles.size());
    tessellate::OpticTriangle own = whole.triangles[t], of_all = own;
    for (std::size_t k = 0; k < 3; ++k) {
      own.vertices[k] = number[own.vertices[k]];
      of_all.vertices[k] = base + own.vertices[k];
    }
    alone.triangles.push_back(own);
    cut.mesh.triangles.push_back(of_all);
  }
  cut.ranges.push_back({base, alone.vertices.size(), first_triangle, alone.triangles.size()});
  cut.patches.push_back(std::move(alone));
}

}  // namespace

PatchMesh cut_into_patches(const OpticArrays& whole, std::span<const std::uint32_t> patch_of_triangle,
                           std::size_t count) {
  PatchMesh cut;
  std::vector<std::uint32_t> new_triangle(whole.triangles.size(), kNone);
  for (std::uint32_t patch = 0; patch < count; ++patch)
    append_patch(whole, patch_of_triangle, patch, cut, new_triangle);
  for (tessellate::OpticBorder border : whole.borders) {
    border.triangle = new_triangle[border.triangle];
    cut.mesh.borders.push_back(border);
  }
  return cut;
}

}  // namespace catoptra::render
