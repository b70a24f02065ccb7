// Areas on the ground by what is true of each place: adaptive cells, with a bound on the error.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <map>
#include <span>
#include <vector>

namespace catoptra::optics {

/// A convex polygon on the ground, corners in either sense, mm.
using GroundPolygon = std::vector<glm::dvec2>;

/// What is true of a place: a set of bits. Called from many threads.
using GroundState = std::function<std::uint8_t(const glm::dvec2&)>;

struct RegionOptions {
  double cell_mm = 250;  ///< of the first cells; larger where there would be more than 400 a side
  double tolerance =
      5e-4;  ///< cells are split until those with more than one state make up this share of the area
  int max_splits = 9;
};

/// A cell as far as a drawing needs it: the square's corner and side, before it was cut by the region.
struct RegionCell {
  glm::dvec2 low_mm{0}, size_mm{0};
  std::uint8_t state = 0;
};

struct RegionMeasure {
  double area_mm2 = 0;
  std::map<std::uint8_t, double> area_by_state;  ///< mm2; they add up to `area_mm2`
  /// Area of the cells in which the state changes. Each is shared out by five samples; the error of any area
  /// is below this, as long as nothing hides between the samples of a cell whose five agree.
  double mixed_mm2 = 0;
  std::vector<RegionCell> cells;  ///< those with a state other than 0

  /// Area where some bit of `bits` is set (all bits: `area_of_all`).
  [[nodiscard]] double area_of_any(std::uint8_t bits) const;
  [[nodiscard]] double area_of_all(std::uint8_t bits) const;
};

/// Measures the union of `parts`, which must not overlap. The result does not depend on the number of
/// threads.
[[nodiscard]] RegionMeasure measure_region(std::span<const GroundPolygon> parts, const GroundState& state,
                                           const RegionOptions& options = {});

/// Area of a polygon (positive), mm2.
[[nodiscard]] double polygon_area_mm2(const GroundPolygon& polygon);

/// Whether a convex polygon holds a point, its border included.
[[nodiscard]] bool polygon_holds(const GroundPolygon& polygon, const glm::dvec2& point);

}  // namespace catoptra::optics
