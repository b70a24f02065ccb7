// The scene file (TOML): from text to everything that a picture is made of. docs/scene-file.md describes each
// key.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/mat4x4.hpp>
#include <optional>
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

/// Where an entry of scene.surroundings came from.
struct SurroundingSource {
  std::string name;  ///< the entry's name, or its file's without suffix
  /// The file's own optics, if it is the rest (back, edge, housing) of an optic's file: indices in
  /// scene.optics.
  std::vector<std::size_t> optics;
  std::filesystem::path file = {};  ///< that it was read from; empty for the rest of an optic's file
};

/// The table [evaluation]: the vehicle around a mirror, as the rules see it. What is left out is taken from
/// the rest of the scene when it is needed.
struct EvaluationSettings {
  std::optional<glm::dvec3> forward;
  glm::dvec3 ground_mm{0};                   ///< a point of the ground
  std::vector<glm::dvec3> ocular_points_mm;  ///< two, or none
  std::optional<glm::dvec3> eye_mm;          ///< midpoint of the ocular points
  std::optional<glm::dvec3> r_point_mm;
  double ocular_spacing_mm = 65;
  std::optional<glm::dvec3> left_side_mm, right_side_mm;  ///< points of the vehicle's side planes
  std::optional<glm::dvec3> median_mm;                    ///< a point of its median plane
  std::optional<bool> driver_left;
  std::vector<std::string> vehicle;  ///< names of surroundings; empty: all of them
  double far_mm = 100000;            ///< stands for the horizon where areas are measured
  double direct_view_rad = 1.5707963267948966;
};

/// A scene and the CAD data under it.
struct SceneFile {
  render::Scene scene;
  std::filesystem::path path;              ///< of the file itself; empty where its text came from elsewhere
  std::vector<OpticSource> optic_sources;  ///< one per entry of scene.optics, in its order
  std::vector<SurroundingSource> surrounding_sources;  ///< one per entry of scene.surroundings, in its order
  EvaluationSettings evaluation;
  double unit_mm = 1;  ///< length of the file's unit
};

struct SceneReadOptions {
  /// Called from the reading thread with the share of the current file (0..1) and what is being done to which
  /// file.
  std::function<void(double, std::string_view)> progress;
};

/// Reads a scene file and every file it names; paths in it are relative to its folder. "-" reads standard
/// input, with paths relative to the current folder. Throws catoptra::Error whose entity is "line N,
/// table.key" for a key that is unknown, of the wrong type or out of range and for a file that is missing;
/// ImportError for a file that cannot be imported.
[[nodiscard]] SceneFile read_scene(const std::filesystem::path& file, const SceneReadOptions& options = {});

/// The same from text; `name` stands for the file in messages, `folder` is where its paths start.
[[nodiscard]] SceneFile read_scene_text(std::string_view text, const std::string& name,
                                        const std::filesystem::path& folder,
                                        const SceneReadOptions& options = {});

}  // namespace catoptra::app
