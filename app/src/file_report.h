// What `catoptra info` says about a file: JSON and plain text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cad_import/cad_model.h"
#include "cad_import/triangle_mesh.h"

namespace catoptra::app {

/// "bspline", "plane", ...
[[nodiscard]] std::string_view surface_name(cad_import::SurfaceKind kind);

/// {"min": [x, y, z], "max": [...], "size": [...]}, or null for an empty box.
[[nodiscard]] nlohmann::ordered_json box_json(const cad_import::BoundingBox& box);

/// The layouts of docs/reports.md.
[[nodiscard]] nlohmann::ordered_json cad_json(const cad_import::CadModel& model);
[[nodiscard]] nlohmann::ordered_json mesh_json(const cad_import::TriangleMesh& mesh);

/// The same for people, from one file's JSON.
[[nodiscard]] std::string plain_text(const nlohmann::ordered_json& file);

}  // namespace catoptra::app
