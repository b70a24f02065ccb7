// The pixels in which optics may show, for the modes that trace exact rays there.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "render/scene.h"
#include "render/src/gl_objects.h"
#include "render/src/raster_picture.h"
#include "render/src/raster_scene.h"
#include "render/src/raster_view.h"

namespace catoptra::render {

inline constexpr std::uint8_t kOpticEdge = 1, kOpticPixel = 2;

/// row * width + column of the pixels with a mark, ascending.
[[nodiscard]] std::vector<std::uint32_t> marked_pixels(const std::vector<std::uint8_t>& marks);

/// Kept from frame to frame; needs the same current context throughout.
class OpticMask {
 public:
  OpticMask(const Scene& scene, const RasterScene& raster);

  /// Starts an empty mask. `depth`: a depth buffer of that size and `multisample` places in each pixel,
  /// before which optics count; null: all do, hidden or not.
  void begin(glm::ivec2 size, const GlTexture* depth, int multisample = 1);
  /// Draws the depth of the optics into the bound target, so that what they hide is not shaded. `view` must
  /// be the one that RasterScene has begun last.
  void hide(const RasterView& view) const;
  /// Adds the optics as seen in `view`, likewise: those that nothing is nearer than.
  void draw(const RasterView& view) const;
  /// Per pixel kOpticPixel where some draw shows an optic in it and in all pixels beside it, kOpticEdge where
  /// in it or in one beside it, else 0: rasteriser and ray tracer round differently, so that on the outline
  /// one may see the optic where the other does not. The ray tracer knows what to do with both.
  [[nodiscard]] std::vector<std::uint8_t> marks() const;
  /// row * width + column of the marked pixels that optics do not cover altogether, ascending: none without
  /// multisampling.
  [[nodiscard]] std::vector<std::uint32_t> outline() const;

 private:
  [[nodiscard]] std::vector<std::uint8_t> read() const;
  void draw_surfaces(const RasterView& view) const;

  const Scene& scene_;
  const RasterScene& raster_;
  GlTexture mask_, smooth_;  ///< the latter with several samples a pixel
  GlFramebuffer framebuffer_, smooth_framebuffer_;
  glm::ivec2 size_{0};
  int multisample_ = 1;
  GlProgram program_;
};

/// Draws everything but the optics into `picture`, which has begun, and the optics that show into `mask`.
void draw_around_optics(RasterScene& raster, OpticMask& mask, RasterPicture& picture, const Camera& camera,
                        const FrameOptions& options);

}  // namespace catoptra::render
