// The scene file (TOML): from text to everything that a picture is made of. docs/scene-file.md describes each
// key.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/mat4x4.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cad_import/cad_model.h"
#include "render/scene.h"

namespace catoptra::app {

/// Where an optic of the scene came from, for benchmarks that mesh it again and for reports.
struct OpticSource {
  cad_import::CadModel model;  ///< the whole file, placed in the scene, mm
  std::vector<int> faces;      ///< indices in model.faces of the reflecting ones, or of a lens's front
  std::vector<std::filesystem::path> files;  ///< that the optic was read from
  glm::dmat4 placement{1};                   ///< of the (first) file in the scene, mm
};

/// A scene and the CAD data under it.
struct SceneFile {
  render::Scene scene;
  std::vector<OpticSource> optic_sources;  ///< one per entry of scene.optics, in its order
};

struct SceneReadOptions {
  /// Called from the reading thread with the share of the current file (0..1) and what is being done to which
  /// file.
  std::function<void(double, std::string_view)> progress;
};

/// Reads a scene file and every file it names; paths in it are relative to its folder. "-" reads standard
/// input, with paths relative to the current folder. Throws catoptra::Error whose entity is "line N,
/// table.key" for a key that is unknown, of the wrong type or out of range and for a file that is missing;
/// ImportError for a file that cannot be imported. A scene that holds
/// [[planar]] is checked in full and then refused: this version cannot show it.
[[nodiscard]] SceneFile read_scene(const std::filesystem::path& file, const SceneReadOptions& options = {});

/// The same from text; `name` stands for the file in messages, `folder` is where its paths start.
[[nodiscard]] SceneFile read_scene_text(std::string_view text, const std::string& name,
                                        const std::filesystem::path& folder,
                                        const SceneReadOptions& options = {});

}  // namespace catoptra::app
