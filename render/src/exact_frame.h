// Mode `exact`: the picture of mode pvrr, every pixel of an optic verified, and traced where it is wrong
// (design 2.9).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/frame.h"
#include "render/src/exact_pixels.h"
#include "render/src/optic_mask.h"
#include "render/src/pvrr_frame.h"
#include "render/src/raster_picture.h"
#include "render/src/ray_tracer.h"

namespace catoptra::render {

/// Keeps its memory from frame to frame; needs the same current context throughout.
class ExactFrame {
 public:
  /// Draws with `pvrr`, and keeps the references.
  ExactFrame(const Scene& scene, const RasterScene& raster, PvrrFrame& pvrr);

  /// Every pixel is verified, behind a lens at the reference, shortest and longest wavelength; one that is
  /// wrong (see agrees()) is traced at all wavelengths. With several samples that holds for each. The picture
  /// is put together on the CPU and so always read back. `tracer` has the optics where `pvrr` has them.
  /// Overlays are left out. Times: those of mode pvrr, "verify", "retrace".
  [[nodiscard]] RenderResult render(const Camera& camera, const FrameOptions& options, RasterPicture& picture,
                                    const RayTracer& tracer);

 private:
  struct Verification;
  void verify_sample(Verification& v, int sample, const RasterView& view);
  [[nodiscard]] std::vector<std::uint32_t> wrong_outline(const Verification& v);
  void compare_pixels(Verification& v, std::span<const std::uint32_t> pixels);

  const Scene& scene_;
  PvrrFrame& pvrr_;
  OpticMask mask_;
  Frame shown_;  ///< geometry of the sample in hand
  ExactPixels exact_;
};

}  // namespace catoptra::render
