// Whether a picture shows what the exact rays meet: the residual of mode exact (design 2.9).
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "render/frame.h"

namespace catoptra::render {

/// How far off a pixel may be and count as right: the larger of the two.
inline constexpr double kExactTolerance_arcmin = 1.0;  ///< at the optic, 1 arcmin: visual acuity 1.0
inline constexpr double kExactTolerance_px = 0.5;

/// The exact rays of the pixels where optics show, and what they meet, but not its colour.
struct ExactPixels {
  /// Geometry alone: position, surface and direction are set where optic_id is an optic's.
  Frame frame;
  std::vector<glm::vec3> normal;  ///< unit, of the triangle met; where position.w = 1

  /// No optic anywhere. Keeps its memory from picture to picture.
  void reset(int width, int height);
};

/// Whether pixel `i` of `shown` (with geometry) is right: shows the same optic, what it shows lies on the
/// exact ray within the tolerance, and nothing before or behind it does. The latter is asked of the surface
/// that the ray meets: what is shown must lie in its plane, within the tolerance's length there. So what a
/// nearer thing hides is found, and what a hole reveals, though it may lie on the ray. True also where
/// neither shows an optic. On a caustic, where a pixel has no size at the optic, the tolerance in arcmin
/// counts alone.
[[nodiscard]] bool agrees(const ExactPixels& exact, const Frame& shown, std::size_t i);

}  // namespace catoptra::render
