#include "render/src/sample_mean.h"

#include <utility>

#include "render/src/sampling.h"

namespace catoptra::render {
namespace {

FrameOptions options_of_sample(const Camera& camera, const FrameOptions& options, int index, bool on_gpu) {
  FrameOptions of_sample = options;
  of_sample.samples = of_sample.multisample = 1;
  of_sample.geometry = options.geometry && index == 0;
  if (on_gpu) of_sample.read_back = of_sample.geometry && options.read_back;
  // Within a picture nothing changes but the eye's place in its pupil; and where that does, what the last
  // sample has left must not count.
  of_sample.reuse_static = !(camera.pupil_mm > 0) && (options.reuse_static || index > 0);
  return of_sample;
}

void add_costs(const FrameStats& of_sample, FrameStats& sum) {
  for (std::size_t i = 0; i < sum.optics.size(); ++i) {
    const OpticStats& from = of_sample.optics[i];
    OpticStats& to = sum.optics[i];
    to.rays += from.rays;
    to.scene_rays += from.scene_rays;
    to.refinement_rays += from.refinement_rays;
    to.shown_pixels += from.shown_pixels;
    to.retraced_pixels += from.retraced_pixels;
  }
  for (const auto& [step, ms] : of_sample.time_ms) sum.time_ms[step] += ms;
  sum.rays += of_sample.rays;
}

}  // namespace

void SampleMean::add(const Camera& camera, const FrameOptions& options, int until, RasterPicture* on_gpu,
                     const DrawSample& draw) {
  if (on_gpu && count_ == 0) on_gpu->start_sum();
  for (; count_ < until; ++count_) {
    const Camera seen = sample_camera(camera, count_, options.samples);
    take(draw(seen, options_of_sample(camera, options, count_, on_gpu)), !on_gpu);
  }
}

void SampleMean::take(RenderResult sample, bool with_color) {
  if (count_ == 0) {
    sum_ = std::move(sample);
    if (!with_color) sum_.frame.color.clear();
    return;
  }
  if (with_color)
    for (std::size_t i = 0; i < sum_.frame.color.size(); ++i) sum_.frame.color[i] += sample.frame.color[i];
  for (std::size_t i = 0; i < sum_.frame.retraced.size(); ++i)
    sum_.frame.retraced[i] |= sample.frame.retraced[i];
  add_costs(sample.stats, sum_.stats);
  sum_.warnings = std::move(sample.warnings);
}

RenderResult SampleMean::mean(const FrameOptions& options, const RasterPicture* on_gpu) const {
  RenderResult result = sum_;
  result.stats.samples = count_;
  if (!on_gpu) {
    const float share = 1 / float(count_);
    for (glm::vec4& pixel : result.frame.color) pixel = glm::vec4(share * glm::vec3(pixel), 1);
    return result;
  }
  if (!options.read_back) return result;
  Frame read;
  const double ms = gl_time_ms([&] { read = on_gpu->read_color(); });
  result.frame.width = read.width;
  result.frame.height = read.height;
  result.frame.color = std::move(read.color);
  result.stats.time_ms["readback"] += ms;
  result.stats.time_ms["total"] += ms;
  return result;
}

}  // namespace catoptra::render
