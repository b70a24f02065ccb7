// What the makers of mirror glasses and lenses share: outlines, B-splines through height fields, faces cut to
// an outline, and STEP files that appear whole or not at all.
#pragma once

#include <Geom_BSplineSurface.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cad_import/error.h"

namespace catoptra::cad_import {

/// How far an edge's space curve may leave its faces, and the tolerance of its vertices.
inline constexpr double kEdgeTolerance_mm = 1e-7;

struct OutlineBox {
  glm::dvec2 min{0}, max{0};  // mm
};

/// One piece of an outline, counter-clockwise: a straight side, or a quarter circle about `centre` where
/// radius > 0.
struct OutlinePiece {
  glm::dvec2 from{0}, to{0};
  glm::dvec2 centre{0};
  double radius = 0;
};

/// Three corners or more, finite, none repeated, no two sides that cross or touch. Throws Error that names
/// `subject` ("mirror").
void check_polygon(std::span<const glm::dvec2> corners, const std::string& subject);
/// Smallest box around the corners, at least one.
[[nodiscard]] OutlineBox box_of(std::span<const glm::dvec2> corners);
/// Straight sides between the corners, given in either sense.
[[nodiscard]] std::vector<OutlinePiece> polygon_pieces(std::vector<glm::dvec2> corners);
/// The box with its corners rounded; a radius of half the smaller side makes round ends.
[[nodiscard]] std::vector<OutlinePiece> rounded_pieces(const OutlineBox& box, double radius);

/// Height z above (x, y), mm.
using HeightField = std::function<double(double, double)>;

struct HeightFit {
  int degree = 3;
  double tolerance_mm = 5e-7;
  std::optional<double> x_line;  ///< where a derivative of the field jumps along x: a knot is put there
  /// Where the tolerance holds; left out: in the whole box.
  std::function<bool(double, double)> inside;
};

struct FittedSurface {
  Handle(Geom_BSplineSurface) surface;  ///< u = x and v = y in mm
  double error_mm = 0;                  ///< above the tolerance where no sensible number of poles reaches it
};

/// Interpolant of `field` over `box`, with continuous derivatives up to degree - 1 (x_line included).
[[nodiscard]] FittedSurface fit_height_field(const HeightField& field, const OutlineBox& box,
                                             const HeightFit& fit);

/// The outline's pieces as edges on `surface` (u = x, v = y) that share their vertices, with space curves
/// whose parameter is the pieces' own: length along a side, angle along an arc.
[[nodiscard]] std::vector<TopoDS_Edge> outline_edges(const Handle(Geom_BSplineSurface) & surface,
                                                     std::span<const OutlinePiece> pieces);
/// The part of `surface` inside the edges, which run counter-clockwise.
[[nodiscard]] TopoDS_Face face_inside(const Handle(Geom_BSplineSurface) & surface,
                                      std::span<const TopoDS_Edge> edges);

/// One face of a solid with the name it has in the file.
struct NamedFace {
  TopoDS_Face face;
  std::string name;
};
struct NamedSolid {
  std::string name;
  TopoDS_Shape solid;
  std::vector<NamedFace> faces;
};

/// Writes `solid` as STEP in mm under another name in the same folder, reads it again, checks that it is one
/// valid solid with its face names, and only then renames it. Throws Error.
void write_named_solid(const NamedSolid& solid, const std::filesystem::path& file);

}  // namespace catoptra::cad_import
