#include "app/src/frame_timing.h"

#include <algorithm>
#include <chrono>
#include <vector>

namespace catoptra::app {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

FrameTiming time_frames(render::Renderer& renderer, render::Mode mode, const render::Camera& camera,
                        const render::FrameOptions& options, int frames, Progress& progress) {
  using Clock = std::chrono::steady_clock;
  (void)renderer.render(mode, camera, options);
  FrameTiming timing;
  std::vector<double> wall_ms;
  std::map<std::string, std::vector<double>> passes;
  for (int i = 0; i < frames; ++i) {
    progress.show(double(i) / frames, "timing " + std::string(render::mode_name(mode)));
    const auto start = Clock::now();
    const render::RenderResult result = renderer.render(mode, camera, options);
    wall_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    for (const auto& [name, ms] : result.stats.time_ms) passes[name].push_back(ms);
    timing.rays_per_frame = result.stats.rays;
  }
  progress.clear();
  timing.frames = frames;
  timing.median_ms = median(wall_ms);
  const auto [least, most] = std::minmax_element(wall_ms.begin(), wall_ms.end());
  timing.min_ms = *least;
  timing.max_ms = *most;
  for (auto& [name, ms] : passes) timing.pass_ms[name] = median(std::move(ms));
  return timing;
}

nlohmann::ordered_json time_json(const FrameTiming& timing) {
  nlohmann::ordered_json json{{"frame_median", timing.median_ms}};
  for (const auto& [name, ms] : timing.pass_ms) json[name] = ms;
  return json;
}

}  // namespace catoptra::app
