#include "app/src/session.h"

#include <spdlog/spdlog.h>
#include <tbb/global_control.h>

#include <optional>
#include <utility>

#include "app/src/optic_view.h"

namespace catoptra::app {

/// Bounds every parallel loop of the process, meshing and the libraries' own included.
struct Session::Threads {
  std::optional<tbb::global_control> limit;
};

void add_drawing_options(CLI::App& app, DrawingOptions& options) {
  app.add_option("SCENE", options.scene, "Scene file (TOML); - reads standard input")->required();
  app.add_option("--resolution", options.resolution, "Size of the picture in pixels, in place of the scene's")
      ->option_text("W,H");
  app.add_option("--threads", options.threads, "CPU threads; 0: all")
      ->check(CLI::Range(0, 4096))
      ->option_text("N");
}

Session::Session(const DrawingOptions& options, const CommonOptions& common)
    : progress(!common.no_progress), threads_(std::make_unique<Threads>()) {
  if (options.threads > 0)
    threads_->limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(options.threads));
  std::optional<glm::ivec2> size;
  if (!options.resolution.empty()) size = parse_resolution(options.resolution);
  SceneReadOptions reading;
  reading.progress = [this](double share, std::string_view what) { progress.show(share, what); };
  file = read_scene(options.scene, reading);
  progress.clear();
  if (size) file.scene.camera.resolution = *size;
  for (std::string& warning : optic_view_warnings(file.scene))
    file.scene.warnings.push_back(std::move(warning));
  for (const std::string& warning : file.scene.warnings) spdlog::warn(warning);
  frame.width = file.scene.camera.resolution.x;
  frame.height = file.scene.camera.resolution.y;
  frame.threads = std::size_t(options.threads);
}

Session::~Session() = default;

render::Renderer& Session::renderer() {
  if (!renderer_) renderer_ = std::make_unique<render::Renderer>(file.scene);
  return *renderer_;
}

render::RenderResult Session::render(render::Mode mode, const render::FrameOptions& options) {
  progress.show(-1, "rendering " + std::string(render::mode_name(mode)));
  render::RenderResult result = renderer().render(mode, file.scene.camera, options);
  progress.clear();
  for (const std::string& warning : result.warnings) spdlog::warn(warning);
  if (result.choice)
    spdlog::info("mode auto: {}, {}", render::mode_name(result.choice->mode), result.choice->reason);
  return result;
}

}  // namespace catoptra::app
