// A scene that Python holds, with its renderer.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "app/scene_file.h"
#include "render/renderer.h"

namespace catoptra::python {

/// Neither copied nor moved: the renderer refers to the scene.
struct SceneHandle {
  app::SceneFile file;
  render::Camera camera;                       ///< of the next picture
  std::unique_ptr<render::Renderer> renderer;  ///< made with the first picture
  std::mutex mutex;

  static std::shared_ptr<SceneHandle> read(const std::filesystem::path& path) {
    auto handle = std::make_shared<SceneHandle>();
    handle->file = app::read_scene(path);
    handle->camera = handle->file.scene.camera;
    return handle;
  }

  [[nodiscard]] std::vector<std::string> names(optics::OpticKind kind) const {
    std::vector<std::string> names;
    for (const optics::Optic& optic : file.scene.optics)
      if (optic.kind == kind) names.push_back(optic.name);
    return names;
  }
};

}  // namespace catoptra::python
