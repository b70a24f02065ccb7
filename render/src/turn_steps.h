// How far one has to go for an error of direction, along two steps that turn the direction.
#pragma once

#include <glm/vec3.hpp>

namespace catoptra::render {

/// Where an optic magnifies, against the direct view, by more than this, its picture between two pixels is
/// less than an error can be told from: near a caustic one pixel shows (nearly) one direction only. No turn
/// counts there for less than this share of the direct view's.
inline constexpr double kMostMagnification = 20;

/// The length of the step, in units of two steps at right angles that turn a direction by `by_x` and `by_y`,
/// after which it is turned by `wanted` (all across one direction, rad). Turns below `least` > 0 count as
/// that, in the direction in which they are: so there is a length on caustics too.
[[nodiscard]] double steps_to_turn(const glm::dvec3& by_x, const glm::dvec3& by_y, const glm::dvec3& wanted,
                                   double least);

}  // namespace catoptra::render
