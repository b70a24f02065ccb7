// Textures that a view is drawn into: colour, depth and, where asked for, geometry.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "render/src/gl_objects.h"

namespace catoptra::render {

/// Colour RGBA16F (linear radiance), reversed depth 32F; with geometry also world position and detail
/// (RGBA32F), see raster_surface.frag.glsl and raster_optic.glsl. Colour can be sampled linearly, geometry
/// only to the nearest texel.
class RasterTarget {
 public:
  /// Throws catoptra::Error where the size is beyond what the driver can draw.
  /// With `multisample` above 1, colour and depth have so many samples a pixel, and there is no geometry.
  RasterTarget(glm::ivec2 size, bool geometry, int multisample = 1);

  /// The target again if it has that size, that number of samples and (at least) that geometry, else a new
  /// one.
  static void fit(std::unique_ptr<RasterTarget>& target, glm::ivec2 size, bool geometry, int multisample = 1);

  /// Draws go into colour alone, or with geometry; both with the same depth buffer.
  void bind(bool geometry) const;

  /// The mean of each pixel's samples becomes the colour of `target`, which has the same size and one sample.
  /// With `depth` also the depth of one of the samples.
  void resolve_into(const RasterTarget& target, bool depth = false) const;

  [[nodiscard]] glm::ivec2 size() const { return size_; }
  [[nodiscard]] int multisample() const { return multisample_; }
  [[nodiscard]] const GlTexture& color() const { return color_; }
  [[nodiscard]] const GlTexture& position() const { return position_; }
  [[nodiscard]] const GlTexture& detail() const { return detail_; }
  [[nodiscard]] const GlTexture& depth() const { return depth_; }

 private:
  glm::ivec2 size_;
  int multisample_ = 1;
  GlTexture color_, position_, detail_, depth_;
  GlFramebuffer color_only_, with_geometry_;
};

/// RGBA float content of level 0 of a texture of `size`, row 0 first.
[[nodiscard]] std::vector<glm::vec4> read_texture(const GlTexture& texture, glm::ivec2 size);

}  // namespace catoptra::render
