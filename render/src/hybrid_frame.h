// Mode `hybrid`: the primary view rasterised, exact rays only where an optic shows (design 4, limits).
#pragma once

#include "render/frame.h"
#include "render/src/optic_mask.h"
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
  const Scene& scene_;
  RasterScene& raster_;
  OpticMask mask_;
};

}  // namespace catoptra::render
