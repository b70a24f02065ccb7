// What the commands that draw a scene have in common: reading it, its warnings, its threads.
#pragma once

#include <memory>
#include <string>

#include "app/scene_file.h"
#include "app/src/commands.h"
#include "render/renderer.h"

namespace catoptra::app {

/// Options of every command that draws a scene.
struct DrawingOptions {
  std::string scene;
  std::string resolution;  ///< empty: the scene's
  int threads = 0;         ///< 0: all
};

void add_drawing_options(CLI::App& app, DrawingOptions& options);

/// A scene that was read, and its renderer. Warnings of the scene go to the log.
class Session {
 public:
  Session(const DrawingOptions& options, const CommonOptions& common);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  SceneFile file;
  render::FrameOptions frame;  ///< size and threads are set
  Progress progress;

  [[nodiscard]] const render::Scene& scene() const { return file.scene; }
  [[nodiscard]] render::Renderer& renderer();
  /// Renders, shows progress and logs the frame's warnings.
  [[nodiscard]] render::RenderResult render(render::Mode mode, const render::FrameOptions& options);

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
  std::unique_ptr<render::Renderer> renderer_;
};

}  // namespace catoptra::app
