// One picture in the making: the target of its samples, their mean, and the way back to the CPU.
#pragma once

#include <epoxy/gl.h>

#include <chrono>
#include <memory>
#include <vector>

#include "render/frame.h"
#include "render/src/raster_target.h"

namespace catoptra::render {

/// Kept from frame to frame, so that textures are made again only where the size changes.
class RasterPicture {
 public:
  /// Of a scene with `optic_count` optics.
  explicit RasterPicture(std::size_t optic_count);

  /// From now on every picture is summed up with those before it, until stop_sum().
  void start_sum();
  void stop_sum() { summing_ = false; }
  /// Pictures in the sum; 0 where nothing is summed.
  [[nodiscard]] int summed() const { return summing_ ? summed_ : 0; }

  /// Starts a picture of the options' size, which the pictures of a sum have in common.
  void begin(const FrameOptions& options);
  /// What holds it, and its geometry.
  [[nodiscard]] const RasterTarget& target() const { return *target_; }
  /// What it has to be drawn into, one after the other: with multisampling, geometry is drawn on its own, at
  /// the pixels' centres.
  struct Pass {
    const RasterTarget* target;
    bool geometry;
  };
  [[nodiscard]] std::vector<Pass> passes(bool geometry) const;
  /// Samples of each pixel's outlines, as many as the driver has of those asked for.
  [[nodiscard]] int multisample() const { return smooth_ ? smooth_->multisample() : 1; }
  /// Takes over what has been drawn.
  void add_sample();

  /// Sets position, surface, direction, optic_id, bounces and path of `frame` to what the target holds of
  /// them.
  void read_geometry(Frame& frame) const;

  /// The picture, or the mean of those in the sum.
  [[nodiscard]] Frame read_color() const;
  /// The same, and the geometry that the last one has left in the target, where its options ask for it.
  [[nodiscard]] Frame read_back() const;

 private:
  std::size_t optic_count_;
  FrameOptions options_;
  std::unique_ptr<RasterTarget> target_;
  std::unique_ptr<RasterTarget> smooth_;  ///< with several samples a pixel; null without multisampling
  bool summing_ = false;
  int summed_ = 0;
  GlTexture sum_;  ///< RGBA32F, of the first sum on
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
