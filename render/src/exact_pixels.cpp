#include "render/src/exact_pixels.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "render/src/pixel_error.h"

namespace catoptra::render {
namespace {

/// What float coordinates leave uncertain of a difference of two points, mm.
double rounding_mm(const glm::dvec3& a, const glm::dvec3& b) {
  double largest = 0;
  for (int k = 0; k < 3; ++k) largest = std::max({largest, std::abs(a[k]), std::abs(b[k])});
  constexpr double kRoundings = 8;  // coordinates relative to eye and mesh, distances along rays, planes
  return kRoundings * std::numeric_limits<float>::epsilon() * largest;
}

/// Both are sky, or the point shown lies in the plane of the triangle that the ray meets. `turned_arcmin`:
/// how far the direction to it is off, which was found to be allowed.
bool same_surface(const ExactPixels& exact, const Frame& shown, std::size_t i, double turned_arcmin) {
  const glm::vec4 &met = exact.frame.position[i], &seen = shown.position[i];
  if (met.w == 0 || seen.w == 0) return met.w == seen.w;
  const glm::dvec3 point(met), other(seen);
  const double allowed_rad = std::max(kExactTolerance_arcmin, turned_arcmin) / kArcminPerRad;
  const double allowed_mm =
      allowed_rad * glm::distance(point, glm::dvec3(exact.frame.surface[i])) + rounding_mm(point, other);
  return std::abs(glm::dot(other - point, glm::dvec3(exact.normal[i]))) <= allowed_mm;
}

}  // namespace

void ExactPixels::reset(int width, int height) {
  frame.width = width;
  frame.height = height;
  const std::size_t count = std::size_t(width) * std::size_t(height);
  frame.position.resize(count);
  frame.surface.resize(count);
  frame.direction.resize(count);
  normal.resize(count);
  frame.optic_id.assign(count, -1);
  frame.bounces.assign(count, 0);
  frame.path.assign(count, 0);
}

bool agrees(const ExactPixels& exact, const Frame& shown, std::size_t i) {
  if (exact.frame.optic_id[i] != shown.optic_id[i]) return false;
  if (exact.frame.optic_id[i] < 0) return true;
  if (path_of(exact.frame, i) != path_of(shown, i)) return false;
  if (both_touch(exact.frame, shown, i)) return true;
  const auto direction = shown_direction(exact.frame, shown, i);
  if (!direction) return false;
  const double arcmin = kArcminPerRad * angle(*direction, glm::dvec3(exact.frame.direction[i]));
  if (!(arcmin <= kExactTolerance_arcmin)) {
    const auto px = screen_error(exact.frame, shown, i, *direction);
    if (!px || !(*px <= kExactTolerance_px)) return false;
  }
  return same_surface(exact, shown, i, arcmin);
}

}  // namespace catoptra::render
