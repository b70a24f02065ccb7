#include "render/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "cad_import/error.h"
#include "render/image_io.h"
#include "render/src/flip.h"
#include "render/src/pixel_error.h"
#include "render/src/turn_steps.h"

namespace catoptra::render {
namespace {

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
  std::vector<std::vector<double>> arcmin(scene.optics.size()), pixels(scene.optics.size()),
      visible(scene.optics.size());
  // A pixel of the direct view, at the picture's centre.
  const double least_turn_rad =
      2 * std::tan(0.5 * scene.camera.fov_rad) / reference.height / kMostMagnification;
  for (std::size_t i = 0; i < reference.color.size(); ++i) {
    const std::int32_t exact = reference.optic_id[i], shown = frame.optic_id[i];
    for (const std::int32_t id : {exact, shown})
      if (exact != shown && id >= 0 && std::size_t(id) < result.optics.size())
        ++result.optics[std::size_t(id)].outline_pixels;
    if (exact != shown || exact < 0 || std::size_t(exact) >= result.optics.size()) continue;
    if (path_of(reference, i) != path_of(frame, i)) {
      ++result.optics[std::size_t(exact)].other_path_pixels;
      continue;
    }
    if (both_touch(reference, frame, i)) {
      ++result.optics[std::size_t(exact)].touching_pixels;
      continue;
    }
    const auto direction = shown_direction(reference, frame, i);
    if (!direction) continue;
    arcmin[std::size_t(exact)].push_back(kArcminPerRad *
                                         angle(*direction, glm::dvec3(reference.direction[i])));
    const auto px = screen_error(reference, frame, i, *direction, least_turn_rad);
    if (px) pixels[std::size_t(exact)].push_back(*px);
    if (!same_surface(reference, frame, i, *direction))
      ++result.optics[std::size_t(exact)].occlusion_pixels;
    else if (px)
      visible[std::size_t(exact)].push_back(*px);
  }
  for (std::size_t k = 0; k < result.optics.size(); ++k) {
    result.optics[k].pixels = arcmin[k].size();
    result.optics[k].arcmin = quantiles(std::move(arcmin[k]));
    result.optics[k].screen_px = quantiles(std::move(pixels[k]));
    result.optics[k].visible_px = quantiles(std::move(visible[k]));
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
    if (path_of(reference, i) != path_of(frame, i)) {
      map[i] = kOtherPath_arcmin;
      continue;
    }
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
