#include "render/src/pvrr_atlas.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace catoptra::render {
namespace {

AtlasLayout in_rows(std::span<const glm::ivec2> maps) {
  AtlasLayout layout{{0, 0}, std::vector<AtlasPlace>(maps.size())};
  std::vector<std::size_t> order(maps.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return maps[a].y > maps[b].y; });
  double area = 0;
  int widest = 0;
  const auto outer = [](glm::ivec2 texels) { return texels + 2 * kGuardTexels; };
  for (const glm::ivec2 texels : maps) {
    area += double(outer(texels).x) * outer(texels).y;
    widest = std::max(widest, outer(texels).x);
  }
  const int width = std::max(widest, int(std::ceil(std::sqrt(area))));
  glm::ivec2 next{0, 0};
  int row_height = 0;
  for (const std::size_t i : order) {
    const glm::ivec2 size = outer(maps[i]);
    if (next.x + size.x > width) {
      next = {0, next.y + row_height};
      row_height = 0;
    }
    layout.places[i] = {next, maps[i], kGuardTexels};
    next.x += size.x;
    row_height = std::max(row_height, size.y);
    layout.texels = glm::max(layout.texels, glm::ivec2(next.x, next.y + row_height));
  }
  return layout;
}

}  // namespace

glm::vec4 AtlasLayout::place(std::size_t map) const {
  const AtlasPlace& at = places[map];
  return {glm::vec2(at.corner + at.guard) / glm::vec2(texels), glm::vec2(at.texels) / glm::vec2(texels)};
}

AtlasLayout lay_out(std::span<const glm::ivec2> maps, int most) {
  if (maps.size() == 1) return {maps[0], {{{0, 0}, maps[0], 0}}};
  AtlasLayout layout = in_rows(maps);
  std::vector<glm::ivec2> smaller(maps.begin(), maps.end());
  while (std::max(layout.texels.x, layout.texels.y) > most) {
    for (glm::ivec2& texels : smaller) texels = glm::max(texels * 7 / 8, glm::ivec2(1));
    layout = in_rows(smaller);
  }
  return layout;
}

optics::VirtualView with_guard(optics::VirtualView view, glm::ivec2 texels, int guard) {
  if (guard == 0) return view;
  const double x = guard * (view.right_side - view.left) / texels.x,
               y = guard * (view.top - view.bottom) / texels.y;
  view.left -= x;
  view.right_side += x;
  view.bottom -= y;
  view.top += y;
  return view;
}

}  // namespace catoptra::render
