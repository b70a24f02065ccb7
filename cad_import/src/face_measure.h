// Numbers of a face: bounds, area, flatness and the identity that survives a re-import.
#pragma once

#include <TopoDS_Face.hxx>
#include <glm/vec2.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cad_import/cad_model.h"

namespace catoptra::cad_import {

/// Extremes of the trimmed surface, by a grid of samples whose best are refined, and of its border. Exact to
/// about 1e-6 of the face's size; boxes of control points would be far too wide for rational surfaces.
[[nodiscard]] BoundingBox face_bounds(const ExactSurface& surface, const FaceTrim& trim,
                                      std::span<const std::vector<glm::dvec2>> polygons);

void extend(BoundingBox& box, const glm::dvec3& point);
void extend(BoundingBox& box, const BoundingBox& other);

/// Area and its centre, as the kernel's integration gives them, in the kernel's own coordinates.
struct FaceMass {
  double area = 0;
  glm::dvec3 centre{0};
};
[[nodiscard]] FaceMass face_mass(const TopoDS_Face& face);

/// Flat within 1e-7 mm.
[[nodiscard]] bool is_planar(const TopoDS_Face& face);

[[nodiscard]] std::string_view kind_name(SurfaceKind kind);

/// Eight hexadecimal digits: FNV-1a of the kind, the area rounded to 1e-3 mm2 and the centre rounded to 1e-3
/// mm.
[[nodiscard]] std::string face_id(SurfaceKind kind, const FaceMass& mass);

}  // namespace catoptra::cad_import
