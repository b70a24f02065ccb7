// One picture in the making: the target of its samples, their mean, and the way back to the CPU.
#pragma once

#include <epoxy/gl.h>

#include <chrono>
#include <memory>

#include "render/frame.h"
#include "render/src/raster_target.h"

namespace catoptra::render {

/// Kept from frame to frame, so that textures are made again only where the size changes.
class RasterPicture {
 public:
  /// Of a scene with `optic_count` optics.
  explicit RasterPicture(std::size_t optic_count);

  /// Starts a picture of the options' size, with no sample yet.
  void begin(const FrameOptions& options);
  /// What the samples are drawn into.
  [[nodiscard]] const RasterTarget& target() const { return *target_; }
  /// Takes over what the target holds as one of options.samples equally weighted samples.
  void add_sample();

  /// Sets position, surface, direction, optic_id, bounces and path of `frame` to what the target holds of
  /// them.
  void read_geometry(Frame& frame) const;

  /// The mean of the samples.
  [[nodiscard]] Frame read_color() const;
  /// The mean of the samples, and the geometry that sample 0 has left in the target, where the options ask
  /// for it.
  [[nodiscard]] Frame read_back() const;

 private:
  std::size_t optic_count_;
  FrameOptions options_;
  std::unique_ptr<RasterTarget> target_;
  GlTexture sum_;  ///< RGBA32F, only with several samples
  GlFramebuffer sum_framebuffer_;
  glm::ivec2 sum_size_{0};
  GlVertexArray nothing_;
  GlProgram accumulate_;
};

/// Wall-clock time of a piece of drawing, ms. The GPU is waited for, so that the time is its own.
template <typename Work>
[[nodiscard]] double gl_time_ms(Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  glFinish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace catoptra::render
