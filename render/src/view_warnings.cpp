#include "render/src/view_warnings.h"

namespace catoptra::render {
namespace {

std::string vertices(std::size_t count, const optics::ViewRegions& regions) {
  return std::to_string(count) + " of " + std::to_string(regions.vertices) + " vertices";
}

}  // namespace

std::optional<std::string> region_warning(const std::string& optic, const optics::ViewRegions& regions) {
  std::string where;
  if (regions.close > 0)
    where += "what " + vertices(regions.close, regions) + " see stands close to where their rays cross";
  if (regions.crossed_once > 0)
    where += std::string(where.empty() ? "" : "; ") + "what " + vertices(regions.crossed_once, regions) +
             " see lies where rays have crossed in one direction and not in the other";
  if (where.empty()) return std::nullopt;
  return optic + ": " + where +
         "; what hides what is not right there (mode exact finds and traces what is wrong)";
}

}  // namespace catoptra::render
