// What the readers of a scene file's tables share.
#pragma once

#include <filesystem>
#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "app/scene_file.h"
#include "app/src/toml_table.h"
#include "cad_import/import.h"
#include "tessellate/optic_mesh.h"

namespace catoptra::app {

struct SceneContext {
  std::string name;              ///< the scene file, as messages call it
  std::filesystem::path folder;  ///< where relative paths start
  double unit_mm = 1;            ///< length of the scene file's unit
  const SceneReadOptions& options;
};

/// The keys that every entry with a file takes: file, translate, rotate_deg, scale, unit.
struct FileEntry {
  std::filesystem::path path;
  glm::dmat4 placement{1};  ///< mm; rotations about x, then y, then z, then the translation
  double scale = 1;
  std::optional<std::string> unit;  ///< of the file's numbers
  [[nodiscard]] bool operator==(const FileEntry&) const = default;
};

/// Reads translate, rotate_deg, scale and unit, and the path under `key`, which must exist.
[[nodiscard]] FileEntry read_file_entry(const TomlTable& table, const SceneContext& context,
                                        std::string_view key = "file");

/// The path under `key`, made absolute; throws where it is absent or no file is there.
[[nodiscard]] std::filesystem::path read_path(const TomlTable& table, const SceneContext& context,
                                              std::string_view key);

[[nodiscard]] cad_import::ImportOptions import_options(const FileEntry& entry, const SceneContext& context);

/// `reflectance`: a number, [r, g, b] or the name of a coating. Nullopt where absent.
[[nodiscard]] std::optional<glm::vec3> read_reflectance(const TomlTable& table);

/// `vertices` and `grid` of an optic, which exclude each other; else the scene's chord and angle.
[[nodiscard]] tessellate::TessellationOptions tessellation_options(const TomlTable& table,
                                                                   const render::RenderSettings& settings);

/// The file's name without suffix, with a number where an optic is called that already.
[[nodiscard]] std::string default_optic_name(const std::vector<optics::Optic>& optics,
                                             const std::filesystem::path& path);

/// Adds what an optic's file holds besides its `optical` faces - back, edge, rim, housing - to the
/// surroundings; `color` where the file has none.
void add_remaining_faces(const cad_import::CadModel& model, std::span<const int> optical, glm::vec3 color,
                         render::Scene& scene);

// One function per table of the file. Each takes the root table, reads what is there and checks it.
[[nodiscard]] render::Camera read_camera(const TomlTable& root, const SceneContext& context);
[[nodiscard]] render::Environment read_environment(const TomlTable& root, const SceneContext& context);
[[nodiscard]] std::vector<render::Light> read_lights(const TomlTable& root, const SceneContext& context);
[[nodiscard]] render::RenderSettings read_render_settings(const TomlTable& root);
[[nodiscard]] EvaluationSettings read_evaluation(const TomlTable& root, const SceneContext& context);
void read_surroundings(const TomlTable& root, const SceneContext& context, SceneFile& result);
void read_mirrors(const TomlTable& root, const SceneContext& context, SceneFile& result);
void read_lenses(const TomlTable& root, const SceneContext& context, SceneFile& result);
void read_planars(const TomlTable& root, const SceneContext& context, SceneFile& result);

}  // namespace catoptra::app
