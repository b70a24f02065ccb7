#include "render/src/pixel_error.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "render/src/turn_steps.h"

namespace catoptra::render {
namespace {

/// Whether `frame` shows something at pixel `i` that lies so near to the optic that rounding alone turns the
/// direction to it by an arcminute: two points, each coordinate off by half a unit in the last place.
bool touches(const Frame& reference, const Frame& frame, std::size_t i) {
  const glm::vec4& shown = frame.position[i];
  if (shown.w == 0) return false;
  const glm::dvec3 surface(reference.surface[i]), point(shown);
  double largest = 0;
  for (int k = 0; k < 3; ++k) largest = std::max({largest, std::abs(surface[k]), std::abs(point[k])});
  const double rounding_mm = std::sqrt(3.0) * largest * std::numeric_limits<float>::epsilon();
  return glm::distance(surface, point) < rounding_mm * kArcminPerRad;
}

/// Change of a value of the reference from pixel to pixel along one axis, within the path: central where both
/// neighbours have the same, else one-sided; nullopt where neither has.
std::optional<glm::dvec3> difference(const Frame& f, const std::vector<glm::vec3>& values, std::size_t i,
                                     int x, int width, std::size_t stride) {
  const bool before = x > 0 && path_of(f, i - stride) == path_of(f, i);
  const bool after = x + 1 < width && path_of(f, i + stride) == path_of(f, i);
  if (!before && !after) return std::nullopt;
  const glm::dvec3 high(values[after ? i + stride : i]), low(values[before ? i - stride : i]);
  return (high - low) / ((before && after) ? 2.0 : 1.0);
}

/// The step of the exact point to the nearer of the two neighbours at `stride` that show the same optic and
/// not the sky: at an outline that is the one on the same surface.
std::optional<glm::dvec3> step_on_surface(const Frame& f, std::size_t i, int x, int width,
                                          std::size_t stride) {
  std::optional<glm::dvec3> nearest;
  const auto offer = [&](std::size_t j) {
    if (f.optic_id[j] != f.optic_id[i] || f.position[j].w == 0) return;
    const glm::dvec3 step = glm::dvec3(f.position[j]) - glm::dvec3(f.position[i]);
    if (!nearest || glm::length(step) < glm::length(*nearest)) nearest = step;
  };
  if (x > 0) offer(i - stride);
  if (x + 1 < width) offer(i + stride);
  return nearest;
}

}  // namespace

bool same_surface(const Frame& reference, const Frame& frame, std::size_t i, const glm::dvec3& shown) {
  const glm::vec4 &met = reference.position[i], &seen = frame.position[i];
  if (met.w == 0 || seen.w == 0) return met.w == seen.w;
  const auto stride = std::size_t(reference.width);
  const auto dx = step_on_surface(reference, i, int(i % stride), reference.width, 1);
  const auto dy = step_on_surface(reference, i, int(i / stride), reference.height, stride);
  if (!dx || !dy) return true;
  const glm::dvec3 normal = glm::cross(*dx, *dy), d(reference.direction[i]);
  const double area = glm::length(normal);
  if (!(area > 0)) return true;
  const double allowed_rad = std::max(1 / kArcminPerRad, 2 * angle(shown, d));
  const double distance = glm::distance(glm::dvec3(met), glm::dvec3(reference.surface[i]));
  const glm::dvec3 off = glm::dvec3(seen) - glm::dvec3(met);
  double largest = 0;
  for (int k = 0; k < 3; ++k)
    largest = std::max({largest, std::abs(double(met[k])), std::abs(double(seen[k]))});
  constexpr double kRoundings = 8;  // coordinates relative to eye and mesh, distances along rays, planes
  return std::abs(glm::dot(off, normal / area)) <=
         allowed_rad * distance + kRoundings * std::numeric_limits<float>::epsilon() * largest;
}

bool both_touch(const Frame& reference, const Frame& frame, std::size_t i) {
  return touches(reference, reference, i) && touches(reference, frame, i);
}

std::optional<glm::dvec3> shown_direction(const Frame& reference, const Frame& frame, std::size_t i) {
  const glm::vec4& shown = frame.position[i];
  glm::dvec3 d(shown);
  if (shown.w != 0) d -= glm::dvec3(reference.surface[i]);
  const double length = glm::length(d);
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  return d / length;
}

double angle(const glm::dvec3& a, const glm::dvec3& b) {
  return 2 * std::atan2(glm::length(a - b), glm::length(a + b));
}

std::optional<double> screen_error(const Frame& reference, const Frame& frame, std::size_t i,
                                   const glm::dvec3& shown, double least_turn_rad) {
  const int x = int(i % std::size_t(reference.width)), y = int(i / std::size_t(reference.width));
  const auto stride = std::size_t(reference.width);
  const auto dx = difference(reference, reference.direction, i, x, reference.width, 1);
  const auto dy = difference(reference, reference.direction, i, y, reference.height, stride);
  const auto sx = difference(reference, reference.surface, i, x, reference.width, 1);
  const auto sy = difference(reference, reference.surface, i, y, reference.height, stride);
  if (!dx || !dy || !sx || !sy) return std::nullopt;
  const glm::dvec3 d(reference.direction[i]);
  const glm::vec4& q = frame.position[i];
  const double nearness = q.w != 0 ? 1 / glm::length(glm::dvec3(q) - glm::dvec3(reference.surface[i])) : 0;
  const auto across = [&](const glm::dvec3& v) { return v - glm::dot(v, d) * d; };
  const glm::dvec3 jx = across(*dx + nearness * *sx), jy = across(*dy + nearness * *sy),
                   e = across(shown - d);
  if (least_turn_rad > 0) return steps_to_turn(jx, jy, e, least_turn_rad);
  const double a = glm::dot(jx, jx), b = glm::dot(jx, jy), c = glm::dot(jy, jy), determinant = a * c - b * b;
  if (!(determinant > 1e-8 * (a + c) * (a + c))) return std::nullopt;
  const double u = glm::dot(jx, e), v = glm::dot(jy, e);
  return std::hypot((c * u - b * v) / determinant, (a * v - b * u) / determinant);
}

}  // namespace catoptra::render
