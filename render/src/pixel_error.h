// How far what a pixel shows is from its exact ray: the measures of the comparison and of mode exact.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <numbers>
#include <optional>

#include "render/frame.h"

namespace catoptra::render {

/// How far off a pixel of mode exact may be and count as right: the larger of the two.
inline constexpr double kExactTolerance_arcmin = 1.0;  ///< at the optic, 1 arcmin: visual acuity 1.0
inline constexpr double kExactTolerance_px = 0.5;

inline constexpr double kArcminPerRad = 60 * 180 / std::numbers::pi;

// `reference` has the exact rays, surface point and direction, where its `optic_id` is an optic's; `frame` is
// the picture that is judged; `i` a pixel that shows the same path in both.

/// Both pictures show what touches the optic: see OpticError::touching_pixels.
[[nodiscard]] bool both_touch(const Frame& reference, const Frame& frame, std::size_t i);

/// Unit direction from the exact last surface point to what `frame` shows at pixel `i`; nullopt where it
/// shows nothing there.
[[nodiscard]] std::optional<glm::dvec3> shown_direction(const Frame& reference, const Frame& frame,
                                                        std::size_t i);

/// Angle between unit vectors, rad, accurate for small ones too.
[[nodiscard]] double angle(const glm::dvec3& a, const glm::dvec3& b);

/// How far, in pixels, from pixel `i` the exact picture shows what `frame` shows at `i`: the step p with
///   (I - d d^T) (S + S' p + s (d + d' p) - Q) = 0,
/// S and d the exact ray, ' their derivative by pixel, Q the point shown at distance s (for a direction s is
/// infinite). Nullopt where the derivative cannot be taken. Turns per pixel below `least_turn_rad` count as
/// that; 0: nullopt on caustics, where the derivative is singular.
[[nodiscard]] std::optional<double> screen_error(const Frame& reference, const Frame& frame, std::size_t i,
                                                 const glm::dvec3& shown, double least_turn_rad = 0);

/// Whether `frame` shows at pixel `i`, in the direction `shown`, the surface that the exact ray meets: what
/// it shows lies in that surface's tangent plane, which the neighbours' exact points tell, to an arcminute or
/// twice what the direction is off (a surface may bend between the two points). True where the neighbours
/// tell nothing.
[[nodiscard]] bool same_surface(const Frame& reference, const Frame& frame, std::size_t i,
                                const glm::dvec3& shown);

}  // namespace catoptra::render
