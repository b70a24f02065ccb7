// Mode `hybrid`: the primary view rasterised, exact rays only where an optic shows (design 4, limits).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/frame.h"
#include "render/src/raster_picture.h"
#include "render/src/raster_scene.h"
#include "render/src/ray_tracer.h"

namespace catoptra::render {

/// Keeps the mask of the optics' pixels from frame to frame; needs the same current context throughout.
class HybridFrame {
 public:
  HybridFrame(const Scene& scene, RasterScene& raster);

  /// The picture is put together on the CPU and so always read back. `tracer` has the optics where `raster`
  /// has them. Times: "raster", "readback", "trace", "total".
  [[nodiscard]] RenderResult render(const Camera& camera, const FrameOptions& options, RasterPicture& picture,
                                    const RayTracer& tracer);

 private:
  void begin_mask(const RasterTarget& target);
  void draw_mask(const RasterView& view);
  /// row * width + column of every pixel in or beside which some sample shows an optic, ascending.
  [[nodiscard]] std::vector<std::uint32_t> masked_pixels() const;

  const Scene& scene_;
  RasterScene& raster_;
  GlTexture mask_;
  GlFramebuffer mask_framebuffer_;
  glm::ivec2 mask_size_{0};
  GlProgram mask_program_;
};

}  // namespace catoptra::render
