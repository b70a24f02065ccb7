// The lens that a command measures: out of a CAD file, or out of a scene.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/scene_file.h"
#include "app/src/file_hash.h"
#include "app/src/mirror_faces.h"
#include "optics/lens_evaluation.h"
#include "optics/optic.h"

namespace catoptra::app {

struct LensSource {
  optics::Optic lens;
  optics::LensFrame frame;
  std::vector<InputFile> inputs;
  std::vector<std::string> warnings;
};

struct LensSourceOptions {
  std::optional<optics::Medium> medium;  ///< required for a CAD file; in place of the scene's own
  std::string name;              ///< of the scene's lens, or of a body of the CAD file; empty: the only one
  std::optional<glm::dvec3> up;  ///< of the model; left out: +y of the lens's file
  std::vector<FaceSelector> front_faces, back_faces;  ///< of a CAD file; empty: recognised
  std::optional<std::string> unit;                    ///< of a CAD file's numbers, in place of its own
  std::function<void(double, std::string_view)> progress;
};

/// Whether `file` is read as a scene: "-", or *.toml.
[[nodiscard]] bool is_scene_file(const std::filesystem::path& file);

/// Imports, recognises and meshes the lens. Throws catoptra::Error: not readable, no lens in it, no such
/// lens, several in a scene and no name.
[[nodiscard]] LensSource load_lens(const std::filesystem::path& file, const LensSourceOptions& options);

/// The lens of a model that was imported already. `medium` has to be there.
[[nodiscard]] LensSource lens_of_model(const cad_import::CadModel& model, const LensSourceOptions& options);

}  // namespace catoptra::app
