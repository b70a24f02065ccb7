// What the readers of CAD files hand over: the kernel's placed shapes with what the file says about them.
#pragma once

#include <TopLoc_Location.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_TShape.hxx>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "cad_import/src/import_progress.h"

namespace catoptra::cad_import {

/// One solid, one shell outside any solid, or the loose faces of a part.
struct KernelBody {
  std::string name;
  std::optional<glm::dvec3> color;  // linear RGB
  bool solid = false;
  TopLoc_Location placement;  // within the assembly; already part of the shape's own location
  TopoDS_Shape shape;
};

/// Lengths are mm as the kernel converted them from the file's unit.
struct KernelDocument {
  std::string format;
  std::string unit = "unknown";       // as recognised
  std::optional<double> unit_mm = 1;  // what the kernel multiplied the file's numbers by, where we know
  std::vector<KernelBody> bodies;
  // Keyed by the shape without location and orientation, so that all instances share them.
  std::unordered_map<const TopoDS_TShape*, std::string> names;
  std::unordered_map<const TopoDS_TShape*, glm::dvec3> colors;
  std::vector<std::string> warnings;
};

/// Each throws ImportError where the file cannot be read, and Cancelled. A KernelSession must live.
[[nodiscard]] KernelDocument read_step(const std::filesystem::path& file, ImportProgress& progress);
[[nodiscard]] KernelDocument read_iges(const std::filesystem::path& file, ImportProgress& progress);
[[nodiscard]] KernelDocument read_brep(const std::filesystem::path& file, ImportProgress& progress);
[[nodiscard]] KernelDocument read_freecad(const std::filesystem::path& file, ImportProgress& progress);

/// Reads one shape from text or binary BREP. Throws ImportError naming `file` and `entry` (empty: the file is
/// the shape), and Cancelled.
[[nodiscard]] TopoDS_Shape read_brep_shape(std::string bytes, const std::string& file,
                                           const std::string& entry, ImportProgress& progress);

/// Splits a part into bodies: its solids, its shells outside solids, its loose faces together.
[[nodiscard]] std::vector<KernelBody> split_into_bodies(const TopoDS_Shape& part, const std::string& name,
                                                        const std::optional<glm::dvec3>& color);

}  // namespace catoptra::cad_import
