// The maps of an optic's patches side by side in one texture.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "optics/virtual_view.h"

namespace catoptra::render {

/// Texels around each of several maps that show the surroundings too: bilinear filtering reaches half a texel
/// beyond what is looked up, and samples lie up to half a texel beside.
inline constexpr int kGuardTexels = 2;

/// Where a map is; its texels without the guard.
struct AtlasPlace {
  glm::ivec2 corner{0, 0}, texels{16, 16};
  int guard = 0;
};

struct AtlasLayout {
  glm::ivec2 texels{16, 16};  ///< of the atlas
  std::vector<AtlasPlace> places;

  /// Map coordinates to the atlas's texture coordinates, with the map's top at 0: offset (x, y) and factor
  /// (z, w).
  [[nodiscard]] glm::vec4 place(std::size_t map) const;
};

/// A single map fills its atlas, without guard. Several are put in rows, the highest first, the width about
/// the square root of all. Where a side would be above `most`, all maps are made smaller by the same factor.
[[nodiscard]] AtlasLayout lay_out(std::span<const glm::ivec2> maps, int most = 8192);

/// The view of a map of `texels` with `guard` more texels on each side.
[[nodiscard]] optics::VirtualView with_guard(optics::VirtualView view, glm::ivec2 texels, int guard);

}  // namespace catoptra::render
