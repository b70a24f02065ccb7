// The pixels in which optics may show, for the modes that trace exact rays there.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "render/scene.h"
#include "render/src/gl_objects.h"
#include "render/src/raster_scene.h"
#include "render/src/raster_view.h"

namespace catoptra::render {

/// Kept from frame to frame; needs the same current context throughout.
class OpticMask {
 public:
  OpticMask(const Scene& scene, const RasterScene& raster);

  /// Starts an empty mask. `depth`: a depth buffer of that size, before which optics count; null: all do,
  /// hidden or not.
  void begin(glm::ivec2 size, const GlTexture* depth);
  /// Adds the optics as seen in `view`, which must be the one that RasterScene has begun last.
  void draw(const RasterView& view);
  /// row * width + column of every pixel in or beside which some draw shows an optic, ascending.
  [[nodiscard]] std::vector<std::uint32_t> pixels() const;

 private:
  const Scene& scene_;
  const RasterScene& raster_;
  GlTexture mask_;
  GlFramebuffer framebuffer_;
  glm::ivec2 size_{0};
  GlProgram program_;
};

}  // namespace catoptra::render
