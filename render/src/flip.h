// LDR-FLIP: how different two pictures look to someone who flips between them.
// Source: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: FLIP: A Difference Evaluator for
// Alternating Images, Proc. ACM on Computer Graphics and Interactive Techniques 3(2), 2020 (High Performance
// Graphics).
#pragma once

#include <span>
#include <vector>

#include "render/frame.h"

namespace catoptra::render {

/// Pixels per degree of visual angle: 0.7 m from a 0.7 m wide display of 3840 pixels (the paper's default).
inline constexpr double kFlipPixelsPerDegree = 67.0206;

/// FLIP of each pixel, 0 (same) to 1, row-major. Both pictures are linear RGB, clamped to [0, 1], of width *
/// height pixels.
[[nodiscard]] std::vector<float> flip_map(std::span<const glm::vec4> reference,
                                          std::span<const glm::vec4> test, int width, int height,
                                          double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace catoptra::render
