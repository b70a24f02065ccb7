// The least-squares homography between two planes, of which PVRR needs the denominator.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <span>

namespace catoptra::optics {

/// Where on the optic (plane coordinates, centred and scaled to about 1) what place of the map is shown (any
/// unit that is the same in both axes).
struct MapSample {
  glm::dvec2 plane;
  glm::dvec2 map;
};

/// Gradient g of the denominator 1 + g . plane of the homography that maps `plane` to `map` best in the
/// least-squares sense. (0, 0) for fewer than four samples. Source: Hartley and Zisserman, Multiple View
/// Geometry, 2nd ed. 2004, 4.1.
[[nodiscard]] glm::dvec2 homography_denominator(std::span<const MapSample> samples);

}  // namespace catoptra::optics
