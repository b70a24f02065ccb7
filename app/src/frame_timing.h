// How long frames take.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "app/src/progress.h"
#include "render/renderer.h"

namespace catoptra::app {

struct FrameTiming {
  int frames = 0;
  double min_ms = 0, median_ms = 0, max_ms = 0;  ///< wall clock of Renderer::render
  std::map<std::string, double> pass_ms;  ///< median over the frames of each entry of FrameStats::time_ms
  std::size_t rays_per_frame = 0;
};

/// Middle value (mean of the two middle ones). `values` must not be empty.
[[nodiscard]] double median(std::vector<double> values);

/// Renders one frame to warm up (shader compilation, first touch of memory), then `frames` that count.
[[nodiscard]] FrameTiming time_frames(render::Renderer& renderer, render::Mode mode,
                                      const render::Camera& camera, const render::FrameOptions& options,
                                      int frames, Progress& progress);

/// {"frame_median": ..., "trace": ..., "pass1": ..., ...}
[[nodiscard]] nlohmann::ordered_json time_json(const FrameTiming& timing);

}  // namespace catoptra::app
