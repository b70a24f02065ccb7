#include "app/src/frame_timing.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "app/src/report.h"

namespace catoptra::app {
namespace {

/// Mode automatic tries each mode in at most a few frames before it settles.
constexpr int kMostWarmUpFrames = 12;

}  // namespace

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double FrameTiming::median_ms() const {
  return median(frame_ms);
}

FrameTiming time_frames(render::Renderer& renderer, render::Mode mode, render::Camera camera,
                        const render::FrameOptions& options, int frames, Progress& progress,
                        const MoveScene& move) {
  using Clock = std::chrono::steady_clock;
  if (move) move(0, renderer, camera);
  for (int i = 0; i < kMostWarmUpFrames; ++i) {
    const render::RenderResult result = renderer.render(mode, camera, options);
    if (!result.choice || result.choice->settled) break;
  }
  FrameTiming timing;
  timing.frames = frames;
  for (int i = 0; i < frames; ++i) {
    progress.show(double(i) / frames, "timing " + std::string(render::mode_name(mode)));
    if (move) move(i + 1, renderer, camera);
    const auto start = Clock::now();
    const render::RenderResult result = renderer.render(mode, camera, options);
    timing.frame_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    for (const auto& [name, ms] : result.stats.time_ms) timing.pass_ms[name].push_back(ms);
    timing.rays_per_frame = result.stats.rays;
    timing.vertices = 0;
    for (const render::OpticStats& optic : result.stats.optics) timing.vertices += optic.vertices;
    timing.maps = maps_json(result.stats);
    timing.maps_pruned = result.stats.maps_pruned;
    timing.shadows = shadows_json(result.stats);
    timing.choice = result.choice;
  }
  progress.clear();
  return timing;
}

nlohmann::ordered_json pass_json(const FrameTiming& timing) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, ms] : timing.pass_ms) json[name] = median(ms);
  return json;
}

nlohmann::ordered_json time_json(const FrameTiming& timing) {
  nlohmann::ordered_json json{{"frame_median", timing.median_ms()}};
  json.update(pass_json(timing));
  return json;
}

}  // namespace catoptra::app
