// The trimmed region of a face as polygons in (u, v) with an index over v.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "cad_import/cad_model.h"

namespace catoptra::cad_import {

/// Corners of a loop's polygon in its direction, first not repeated. The chord's error is below `chord_uv` (u
/// and v each measured by its own unit).
[[nodiscard]] std::vector<glm::dvec2> sample_loop(const TrimLoop& loop, glm::dvec2 chord_uv);

/// Twice the signed area; above 0 for a counter-clockwise polygon.
[[nodiscard]] double signed_area2(std::span<const glm::dvec2> polygon);

/// Even-odd rule on the polygons, with one band of v per few segments, so that a test looks at a handful of
/// segments.
class PolygonTrim final : public FaceTrim {
 public:
  /// Polygon error and margin as shares of the loops' extent: 1e-5 is 2 um on a mirror of 200 mm, finer than
  /// the tolerance of most CAD files; the margin covers the polygon's own error, so that points on the true
  /// border are in.
  static constexpr double kChord = 1e-5;
  static constexpr double kMargin = 2e-5;

  /// `periods`: 0 where the surface is not periodic.
  PolygonTrim(std::span<const std::vector<glm::dvec2>> polygons, glm::dvec2 periods);

  [[nodiscard]] bool contains(double u, double v) const override;

 private:
  struct Segment {
    glm::dvec2 a, b;  // shares of the extent
  };
  [[nodiscard]] bool contains_normalized(glm::dvec2 p) const;

  glm::dvec2 low_{0}, extent_{1}, periods_{0};
  std::vector<Segment> segments_;          // band by band
  std::vector<std::uint32_t> band_begin_;  // bands + 1
  double bands_ = 1;
};

}  // namespace catoptra::cad_import
