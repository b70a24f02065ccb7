#include "render/src/view_warnings.h"

namespace catoptra::render {
namespace {

std::string vertices(std::size_t count, const optics::ViewRegions& regions) {
  return std::to_string(count) + " of " + std::to_string(regions.vertices) + " vertices";
}

}  // namespace

std::optional<std::string> region_warning(const std::string& optic, const optics::ViewRegions& regions) {
  std::string text;
  if (regions.between > 0)
    text += "what " + vertices(regions.between, regions) +
            " see stands so close to where their rays cross that the map lacks it";
  if (regions.crossed_once > 0) {
    if (!text.empty()) text += "; ";
    text += "what " + vertices(regions.crossed_once, regions) +
            " see lies where rays have crossed in one direction and not in the other, and one viewpoint does "
            "not know what hides what there";
  }
  if (text.empty()) return std::nullopt;
  return optic + ": " + text + "; mode exact finds and traces what is wrong";
}

}  // namespace catoptra::render
