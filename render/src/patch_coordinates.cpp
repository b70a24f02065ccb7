#include "render/src/patch_coordinates.h"

#include "render/src/patch_mesh.h"

namespace catoptra::render {

std::vector<glm::dvec3> patch_coordinates_like(std::span<const glm::dvec3> reference,
                                               std::span<const optics::VertexHit> hits,
                                               std::span<const std::uint32_t> patch,
                                               std::span<const optics::VirtualView> views) {
  if (views.size() == 1) return optics::map_coordinates_like(reference, hits, views[0]);
  std::vector<std::vector<std::uint32_t>> members(views.size());
  for (std::uint32_t i = 0; i < patch.size(); ++i) members[patch[i]].push_back(i);
  std::vector<glm::dvec3> coordinates(reference.begin(), reference.end());
  for (std::size_t k = 0; k < views.size(); ++k) {
    const auto own =
        optics::map_coordinates_like(gathered(reference, members[k]), gathered(hits, members[k]), views[k]);
    for (std::size_t i = 0; i < own.size(); ++i) coordinates[members[k][i]] = own[i];
  }
  return coordinates;
}

}  // namespace catoptra::render
