// Mode `exact`: exact rays in every pixel of an optic, which take their colours from the maps of mode pvrr
// where these show what the rays meet (design 2.9; docs/decisions/0009-exact-mode.md).
#pragma once

#include <cstdint>
#include <vector>

#include "render/frame.h"
#include "render/src/map_colors.h"
#include "render/src/optic_mask.h"
#include "render/src/pvrr_frame.h"
#include "render/src/raster_picture.h"
#include "render/src/ray_tracer.h"

namespace catoptra::render {

/// Keeps its memory from frame to frame; needs the same current context throughout.
class ExactFrame {
 public:
  /// Draws maps with `pvrr` and what stands around the optics with `raster`; keeps the references.
  ExactFrame(const Scene& scene, RasterScene& raster, PvrrFrame& pvrr);

  /// A pixel that, behind a lens at some wavelength, meets what no map shows is counted as retraced and
  /// shaded as in mode raytrace. The picture is put together on the CPU and so always read back. `tracer` has
  /// the optics where `pvrr` has them. Times: "trace", "pass1" and "pass2" as in mode pvrr (the latter
  /// without optics), "verify": the exact rays and their colours, "readback", "total".
  [[nodiscard]] RenderResult render(const Camera& camera, const FrameOptions& options, RasterPicture& picture,
                                    const RayTracer& tracer);

 private:
  const Scene& scene_;
  RasterScene& raster_;
  PvrrFrame& pvrr_;
  OpticMask mask_;
  MapColors maps_;
  std::vector<std::int32_t> owner_;  ///< of the pixels of the optics
};

}  // namespace catoptra::render
