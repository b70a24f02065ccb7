// Which faces of a CAD file reflect.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/src/toml_table.h"
#include "cad_import/cad_model.h"

namespace catoptra::app {

/// A face by index (as `catoptra info` prints it), or by text: the name of faces, a stable id, or the name of
/// a body.
using FaceSelector = std::variant<int, std::string>;

/// An array of selectors under `key`; empty where absent. Throws catoptra::Error for anything but strings and
/// non-negative integers.
[[nodiscard]] std::vector<FaceSelector> read_face_selectors(const TomlTable& table, std::string_view key);

/// Indices in `model.faces`, ascending, each once. Throws catoptra::Error(`model.file`, selector, ...) for a
/// selector that matches nothing, with the nearest name.
[[nodiscard]] std::vector<int> select_faces(const cad_import::CadModel& model,
                                            std::span<const FaceSelector> selectors);

/// Faces of one surface as a designer sees it.
struct FaceGroup {
  std::vector<int> faces;  ///< indices in the model, ascending
  double area_mm2 = 0;
  std::string label;  ///< name of a face in it, or its id
};

/// The non-planar faces of `model` in groups: faces with the same name, and faces that meet smoothly (normals
/// within 1 degree at the middle of a shared edge). Largest first.
[[nodiscard]] std::vector<FaceGroup> curved_face_groups(const cad_import::CadModel& model);

/// What reflects where the scene does not say: the largest curved group (of groups within 1 % of it the first
/// in the file), or the largest planar face where all are planar. `warning` is filled where another group is
/// nearly as large (front and back of a glass).
struct DefaultFaces {
  std::vector<int> faces;
  std::string warning;
};
[[nodiscard]] DefaultFaces default_mirror_faces(const cad_import::CadModel& model);

}  // namespace catoptra::app
