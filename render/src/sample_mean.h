// The mean of the samples of a picture, each drawn as a picture of its own: in all modes, at once or a few at
// a time (docs/decisions/0013-antialiasing.md).
#pragma once

#include <functional>
#include <glm/vec4.hpp>
#include <vector>

#include "render/frame.h"
#include "render/scene.h"
#include "render/src/raster_picture.h"

namespace catoptra::render {

class SampleMean {
 public:
  /// Draws one sample: a picture with one sample per pixel, by the camera of that sample.
  using DrawSample = std::function<RenderResult(const Camera& camera, const FrameOptions& options)>;

  /// Forgets all samples.
  void restart() { count_ = 0; }
  [[nodiscard]] int count() const { return count_; }

  /// Adds the next samples of `options.samples` until there are `until`. Where `on_gpu` is not null, the
  /// samples stay there and are summed there, else here; in that order either way. Between samples of the
  /// same picture camera and options must stay what they were.
  void add(const Camera& camera, const FrameOptions& options, int until, RasterPicture* on_gpu,
           const DrawSample& draw);

  /// The mean so far, of at least one sample. Geometry is that of sample 0; costs are summed up, and warnings
  /// those of the last sample. From the GPU colours are read back only where the options ask for it.
  [[nodiscard]] RenderResult mean(const FrameOptions& options, const RasterPicture* on_gpu) const;

 private:
  void take(RenderResult sample, bool with_color);

  int count_ = 0;
  RenderResult sum_;  ///< colours only of samples that are not on the GPU
};

}  // namespace catoptra::render
