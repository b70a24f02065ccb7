#include "render/src/wrong_share.h"

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "render/src/pixel_error.h"

namespace catoptra::render {
namespace {

// Of the distance: half a pixel on a surface seen at a grazing angle is less; a thing before another is more.
constexpr double kClearly = 0.04;

bool is_wrong(const Frame& exact, const Frame& shown, std::size_t i) {
  if (exact.optic_id[i] != shown.optic_id[i]) return true;
  if (both_touch(exact, shown, i)) return false;
  const auto direction = shown_direction(exact, shown, i);
  if (!direction) return true;
  if (kArcminPerRad * angle(*direction, glm::dvec3(exact.direction[i])) > kExactTolerance_arcmin) {
    const auto px = screen_error(exact, shown, i, *direction);
    if (!px || *px > kExactTolerance_px) return true;
  }
  const glm::vec4 &met = exact.position[i], &seen = shown.position[i];
  if (met.w == 0 || seen.w == 0) return met.w != seen.w;
  const double distance = glm::distance(glm::dvec3(met), glm::dvec3(exact.surface[i]));
  return std::abs(glm::distance(glm::dvec3(seen), glm::dvec3(exact.surface[i])) - distance) >
         kClearly * distance;
}

}  // namespace

double wrong_share(const Frame& exact, const Frame& shown) {
  std::size_t pixels = 0, wrong = 0;
  for (std::size_t i = 0; i < exact.optic_id.size(); ++i) {
    if (exact.optic_id[i] < 0) continue;
    ++pixels;
    if (is_wrong(exact, shown, i)) ++wrong;
  }
  return pixels > 0 ? double(wrong) / double(pixels) : 0;
}

}  // namespace catoptra::render
