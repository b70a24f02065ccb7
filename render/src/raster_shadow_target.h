// Where shadows of a view are counted: depth and stencil, and one bit in each pixel for each light.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "render/src/gl_objects.h"

namespace catoptra::render {

/// Depth is floating point as in RasterTarget, with eight bits of stencil that are all for shadows. Bits lie
/// in layers of RGBA8, 32 in each.
class RasterShadowTarget {
 public:
  /// At least of that size, with exactly so many samples a pixel, for at least so many bits.
  void fit(glm::ivec2 size, int multisample, int bits);

  /// The lights of the first `lit_bits` bits reach everything, the others nothing; nothing is in the depth and
  /// the count is 0, within the scissor rectangle.
  void clear(int lit_bits) const;
  void bind(int layer) const;
  [[nodiscard]] const GlTexture& bits() const { return bits_; }

 private:
  glm::ivec2 size_{0};
  int multisample_ = 0, layers_ = 0;
  GlTexture bits_, depth_;
  std::vector<GlFramebuffer> framebuffers_;  ///< by layer
};

}  // namespace catoptra::render
