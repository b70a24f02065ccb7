// Reads CAD and mesh files.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cad_import/cad_model.h"
#include "cad_import/error.h"
#include "cad_import/triangle_mesh.h"

namespace catoptra::cad_import {

enum class FileFormat { step, iges, brep, freecad, gltf, obj, stl, ply, unknown };

/// True for the formats that hold exact surfaces.
[[nodiscard]] bool is_cad(FileFormat format);

/// Recognised from the content first, the suffix second. Throws ImportError where the file cannot be opened.
[[nodiscard]] FileFormat sniff_format(const std::filesystem::path& file);

/// The length of one `unit` in mm: "mm", "cm", "m", "in", "ft", "um" (any letter case). Nullopt for an
/// unknown unit.
[[nodiscard]] std::optional<double> unit_in_mm(std::string_view unit);

struct ImportOptions {
  /// Length unit of the file's numbers, in place of what the file says or, where it says nothing, of mm
  /// (glTF: m).
  std::optional<std::string> unit;
  double scale = 1;         ///< applied after the unit
  glm::dmat4 placement{1};  ///< applied last, mm
  glm::vec3 color{0.8f};    ///< for what has no material of its own, linear RGB
  /// Called now and then with the share done (0..1) and the stage's name; from the calling thread.
  std::function<void(double, std::string_view)> progress;
  const std::atomic<bool>* cancel = nullptr;  ///< set it from elsewhere: the import throws Cancelled
};

/// Reads STEP, IGES, BREP or a FreeCAD document (.FCStd: what its 3D view shows). Throws ImportError where
/// the file cannot be read or has no face; Cancelled.
[[nodiscard]] CadModel import_cad(const std::filesystem::path& file, const ImportOptions& options = {});

/// Reads glTF/GLB, OBJ, STL or PLY as triangles; a CAD file is imported and triangulated with the default
/// deflection. Points and lines are left out, with a warning. Throws ImportError where there is no triangle.
[[nodiscard]] TriangleMesh import_mesh(const std::filesystem::path& file, const ImportOptions& options = {});

struct TriangulationOptions {
  double chord_mm = 0.1;
  double angle_rad = 0.2;
};

/// Triangulates faces of `model` for use as surroundings (never as optics: see tessellate). An empty span of
/// `face_indices` means all. Materials carry the face's or body's colour, else `default_color`; faces that
/// the CAD kernel cannot mesh are named in the result's warnings.
[[nodiscard]] TriangleMesh triangulate(const CadModel& model, std::span<const int> face_indices,
                                       const TriangulationOptions& options = {},
                                       glm::vec3 default_color = glm::vec3(0.8f));

}  // namespace catoptra::cad_import
