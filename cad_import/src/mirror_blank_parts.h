// The steps between a MirrorBlank and its STEP file, shared by the mirror_blank_*.cpp files.
#pragma once

#include <Geom_BSplineSurface.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <glm/vec2.hpp>
#include <span>
#include <string>
#include <vector>

#include "cad_import/mirror_blank.h"

namespace catoptra::cad_import {

struct OutlineBox {
  glm::dvec2 min, max;  // mm
};

/// Throws Error, naming the key, where `blank` cannot be made.
void check_blank(const MirrorBlank& blank);
/// Three corners or more, finite, none repeated, no two sides that cross or touch. Throws Error.
void check_polygon(std::span<const glm::dvec2> corners);

[[nodiscard]] OutlineBox outline_box(const MirrorBlank& blank);
/// Distance of the strip's outer edge from the pole.
[[nodiscard]] double aspheric_edge_mm(const AsphericPart& part, const OutlineBox& box);
/// mirror_sag_mm without the checks of the blank.
[[nodiscard]] double ideal_sag_mm(const MirrorBlank& blank, const OutlineBox& box, double x_mm, double y_mm);

/// Bicubic interpolant of the ideal surface over the outline's box with u = x and v = y in mm, C2 everywhere.
/// Throws Error where 1e-6 mm is not reached with a sensible number of poles.
[[nodiscard]] Handle(Geom_BSplineSurface) glass_surface(const MirrorBlank& blank);

/// One face of the solid with the name it has in the file.
struct NamedFace {
  TopoDS_Face face;
  std::string name;
};
struct MirrorSolid {
  TopoDS_Shape solid;
  std::vector<NamedFace> faces;
};
/// The glass cut to its outline and pulled back by its thickness; checked by the kernel. Throws Error.
[[nodiscard]] MirrorSolid mirror_solid(const MirrorBlank& blank);

}  // namespace catoptra::cad_import
