// Where in a pixel its samples lie: the same places in every mode.
#pragma once

#include <glm/vec2.hpp>

namespace catoptra::render {

/// Offset of sample `index` from the pixel's centre, in pixels, within (-0.5, 0.5). Sample 0 of a single-sample frame is
/// the centre; with more samples the R2 sequence is used (M. Roberts 2018, generalised golden ratio).
[[nodiscard]] inline glm::dvec2 sample_offset(int index, int samples) {
  if (samples <= 1) return {0, 0};
  const double a1 = 0.7548776662466927, a2 = 0.5698402909980532;
  const double x = 0.5 + a1 * index, y = 0.5 + a2 * index;
  return {x - static_cast<long>(x) - 0.5, y - static_cast<long>(y) - 0.5};
}

}  // namespace catoptra::render
