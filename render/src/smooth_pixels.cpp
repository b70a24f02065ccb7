#include "render/src/smooth_pixels.h"

#include <vector>

#include "render/src/sampling.h"

namespace catoptra::render {

std::size_t trace_smooth(const RayTracer& tracer, const Camera& camera, const FrameOptions& options,
                         int samples, std::span<const std::uint32_t> pixels, Frame& frame) {
  if (pixels.empty()) return 0;
  Camera of_point = camera;
  of_point.pupil_mm = 0;
  FrameOptions one = options;
  one.samples = 1;
  one.geometry = false;
  std::vector<glm::vec3> sums(pixels.size(), glm::vec3(0));
  std::size_t rays = 0;
  for (int sample = 0; sample < samples; ++sample) {
    rays += tracer.trace_pixels(sample_camera(of_point, sample, samples), one, pixels, frame);
    for (std::size_t k = 0; k < pixels.size(); ++k) sums[k] += glm::vec3(frame.color[pixels[k]]);
  }
  for (std::size_t k = 0; k < pixels.size(); ++k)
    frame.color[pixels[k]] = glm::vec4(sums[k] / float(samples), 1);
  return rays;
}

}  // namespace catoptra::render
