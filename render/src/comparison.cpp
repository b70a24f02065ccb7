#include "render/comparison.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>

#include "cad_import/error.h"
#include "render/image_io.h"
#include "render/src/flip.h"

namespace catoptra::render {
namespace {

constexpr double kArcminPerRad = 60 * 180 / std::numbers::pi;

void check_sizes(const Frame& reference, const Frame& frame) {
  if (reference.width == frame.width && reference.height == frame.height &&
      reference.color.size() == frame.color.size())
    return;
  throw Error("", "comparison",
              "the pictures have different sizes: " + std::to_string(reference.width) + " x " +
                  std::to_string(reference.height) + " and " + std::to_string(frame.width) + " x " +
                  std::to_string(frame.height));
}

void check_geometry(const Frame& frame, const char* which) {
  const std::size_t n = frame.color.size();
  if (frame.position.size() == n && frame.surface.size() == n && frame.direction.size() == n &&
      frame.optic_id.size() == n)
    return;
  throw Error("", "comparison", std::string("the ") + which + " has no geometry",
              "render it with FrameOptions::geometry");
}

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

/// Both pictures show what touches the optic: see OpticError::touching_pixels.
bool both_touch(const Frame& reference, const Frame& frame, std::size_t i) {
  return touches(reference, reference, i) && touches(reference, frame, i);
}

/// Unit direction from the exact last surface point to what `frame` shows at pixel `i`; nullopt where it
/// shows nothing there.
std::optional<glm::dvec3> shown_direction(const Frame& reference, const Frame& frame, std::size_t i) {
  const glm::vec4& shown = frame.position[i];
  glm::dvec3 d(shown);
  if (shown.w != 0) d -= glm::dvec3(reference.surface[i]);
  const double length = glm::length(d);
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  return d / length;
}

/// Angle between unit vectors, accurate for small ones too.
double angle(const glm::dvec3& a, const glm::dvec3& b) {
  return 2 * std::atan2(glm::length(a - b), glm::length(a + b));
}

/// Change of a value of the reference from pixel to pixel along one axis, within the optic: central where
/// both neighbours show it, else one-sided; nullopt where neither does.
std::optional<glm::dvec3> difference(const Frame& f, const std::vector<glm::vec3>& values, std::size_t i,
                                     int x, int width, std::size_t stride) {
  const bool before = x > 0 && f.optic_id[i - stride] == f.optic_id[i];
  const bool after = x + 1 < width && f.optic_id[i + stride] == f.optic_id[i];
  if (!before && !after) return std::nullopt;
  const glm::dvec3 high(values[after ? i + stride : i]), low(values[before ? i - stride : i]);
  return (high - low) / ((before && after) ? 2.0 : 1.0);
}

/// How far, in pixels, from pixel `i` the exact picture shows what `frame` shows at `i`: the step p with
///   (I - d d^T) (S + S' p + s (d + d' p) - Q) = 0,
/// S and d the exact ray, ' their derivative by pixel, Q the point shown at distance s (for a direction s is
/// infinite). Nullopt on a caustic, where the derivative is singular, and where it cannot be taken.
std::optional<double> screen_error(const Frame& reference, const Frame& frame, std::size_t i,
                                   const glm::dvec3& shown) {
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
  const double a = glm::dot(jx, jx), b = glm::dot(jx, jy), c = glm::dot(jy, jy), determinant = a * c - b * b;
  if (!(determinant > 1e-8 * (a + c) * (a + c))) return std::nullopt;
  const double u = glm::dot(jx, e), v = glm::dot(jy, e);
  return std::hypot((c * u - b * v) / determinant, (a * v - b * u) / determinant);
}

/// Nearest-rank quantiles.
ErrorQuantiles quantiles(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * double(values.size())));
    return values[std::max<std::size_t>(rank, 1) - 1];
  };
  return {at(0.5), at(0.99), at(0.999), values.back()};
}

/// Peak signal-to-noise ratio of values in [0, 1]; infinite where nothing differs.
double psnr_db(double squared_error_sum, std::size_t count) {
  if (squared_error_sum <= 0) return std::numeric_limits<double>::infinity();
  return 10 * std::log10(double(count) / squared_error_sum);
}

}  // namespace

Comparison compare(const Frame& reference, const Frame& frame, const Scene& scene) {
  check_sizes(reference, frame);
  check_geometry(reference, "reference");
  check_geometry(frame, "picture");
  Comparison result;
  result.optics.resize(scene.optics.size());
  std::vector<std::vector<double>> arcmin(scene.optics.size()), pixels(scene.optics.size());
  for (std::size_t i = 0; i < reference.color.size(); ++i) {
    const std::int32_t exact = reference.optic_id[i], shown = frame.optic_id[i];
    for (const std::int32_t id : {exact, shown})
      if (exact != shown && id >= 0 && std::size_t(id) < result.optics.size())
        ++result.optics[std::size_t(id)].outline_pixels;
    if (exact != shown || exact < 0 || std::size_t(exact) >= result.optics.size()) continue;
    if (both_touch(reference, frame, i)) {
      ++result.optics[std::size_t(exact)].touching_pixels;
      continue;
    }
    const auto direction = shown_direction(reference, frame, i);
    if (!direction) continue;
    arcmin[std::size_t(exact)].push_back(kArcminPerRad *
                                         angle(*direction, glm::dvec3(reference.direction[i])));
    if (const auto px = screen_error(reference, frame, i, *direction))
      pixels[std::size_t(exact)].push_back(*px);
  }
  for (std::size_t k = 0; k < result.optics.size(); ++k) {
    result.optics[k].pixels = arcmin[k].size();
    result.optics[k].arcmin = quantiles(std::move(arcmin[k]));
    result.optics[k].screen_px = quantiles(std::move(pixels[k]));
  }
  result.image = image_error(reference, frame);
  return result;
}

std::vector<float> error_map_arcmin(const Frame& reference, const Frame& frame) {
  check_sizes(reference, frame);
  check_geometry(reference, "reference");
  check_geometry(frame, "picture");
  std::vector<float> map(reference.color.size(), -1);
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (reference.optic_id[i] < 0 || reference.optic_id[i] != frame.optic_id[i]) continue;
    if (both_touch(reference, frame, i)) continue;
    if (const auto direction = shown_direction(reference, frame, i))
      map[i] = float(kArcminPerRad * angle(*direction, glm::dvec3(reference.direction[i])));
  }
  return map;
}

ImageError image_error(const Frame& reference, const Frame& frame) {
  check_sizes(reference, frame);
  double encoded = 0, linear = 0;
  for (std::size_t i = 0; i < reference.color.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const float a = std::clamp(reference.color[i][k], 0.0f, 1.0f),
                  b = std::clamp(frame.color[i][k], 0.0f, 1.0f);
      const double e = double(linear_to_srgb(a)) - double(linear_to_srgb(b)), l = double(a) - double(b);
      encoded += e * e;
      linear += l * l;
    }
  const std::size_t values = 3 * reference.color.size();
  const std::vector<float> flip = flip_map(reference.color, frame.color, reference.width, reference.height);
  const double sum = std::accumulate(flip.begin(), flip.end(), 0.0);
  return {psnr_db(encoded, values), psnr_db(linear, values), flip.empty() ? 0 : sum / double(flip.size())};
}

}  // namespace catoptra::render
