// How long frames take.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/src/progress.h"
#include "render/renderer.h"

namespace catoptra::app {

struct FrameTiming {
  int frames = 0;
  std::vector<double> frame_ms;                        ///< wall clock of Renderer::render, one per frame
  std::map<std::string, std::vector<double>> pass_ms;  ///< each entry of FrameStats::time_ms, one per frame
  std::size_t rays_per_frame = 0;
  std::size_t vertices = 0;                  ///< of all optics' meshes as drawn last
  nlohmann::ordered_json maps;               ///< maps_json() of the last frame
  std::size_t maps_pruned = 0;               ///< of the last frame
  nlohmann::ordered_json shadows;            ///< shadows_json() of the last frame
  std::optional<render::ModeChoice> choice;  ///< mode automatic: of the last frame

  [[nodiscard]] double median_ms() const;
};

/// Middle value (mean of the two middle ones). `values` must not be empty.
[[nodiscard]] double median(std::vector<double> values);

/// Renders one frame to warm up (shader compilation, first touch of memory; mode automatic: some, until it
/// has settled on a mode), then `frames` that count. `move`, if any, is called before each of them, with a
/// number that counts up, and may change camera and optics; its time does not count.
using MoveScene = std::function<void(int frame, render::Renderer& renderer, render::Camera& camera)>;
[[nodiscard]] FrameTiming time_frames(render::Renderer& renderer, render::Mode mode, render::Camera camera,
                                      const render::FrameOptions& options, int frames, Progress& progress,
                                      const MoveScene& move = {});

/// Medians: {"trace": ..., "pass1": ..., ...}
[[nodiscard]] nlohmann::ordered_json pass_json(const FrameTiming& timing);

/// The same after the whole frame's: {"frame_median": ..., "trace": ..., "pass1": ..., ...}
[[nodiscard]] nlohmann::ordered_json time_json(const FrameTiming& timing);

}  // namespace catoptra::app
