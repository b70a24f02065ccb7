// A lens as a solid: two B-spline faces in the same outline and the walls between them.
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Standard_Failure.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Wire.hxx>
#include <glm/geometric.hpp>
#include <numbers>

#include "cad_import/import.h"
#include "cad_import/src/kernel_document.h"
#include "cad_import/src/lens_blank_parts.h"
#include "cad_import/src/model_builder.h"

namespace catoptra::cad_import {
namespace {

/// The B-spline of degree 5 through one side. 2e-8 mm on spans of half a millimetre and more keep the error
/// of second derivatives below 3e-6 / mm, 0.003 D at an index of 2.
Handle(Geom_BSplineSurface)
    fitted_side(const HeightField& height, const LensBlank& blank, const std::string& side) {
  std::vector<glm::dvec2> corners;
  for (const OutlinePiece& piece : lens_outline(blank)) corners.push_back(piece.from);
  OutlineBox box = box_of(corners);
  const double reach = lens_reach_mm(blank), margin = 0.01 * reach;
  if (blank.outline.empty()) box = {glm::dvec2(-reach), glm::dvec2(reach)};
  box.min -= margin;
  box.max += margin;
  HeightFit fit;
  fit.degree = 5;
  fit.tolerance_mm = 2e-8;
  fit.inside = [reach](double x, double y) { return x * x + y * y <= reach * reach; };
  const FittedSurface fitted = fit_height_field(height, box, fit);
  // At a rim that stands almost upright a tenth of the usual precision of CAD does.
  if (fitted.error_mm > 1e-6)
    refuse_lens(side,
                "is too steep at the rim for a B-spline: off by " + number_text(fitted.error_mm) + " mm",
                "make the lens smaller or the curve flatter");
  return fitted.surface;
}

/// An edge of a front or back, seen on the quarter cylinder around `piece`, whose u is the angle from the
/// piece's begin and v the height. The edge's parameter is that angle too: u(t) = t has the Greville points
/// of the space curve's knots as its poles, v(t) the curve's own heights.
Handle(Geom2d_Curve) on_cylinder(const TopoDS_Edge& edge) {
  double first = 0, last = 0;
  const Handle(Geom_Curve) space = BRep_Tool::Curve(edge, first, last);
  const Handle(Geom_BSplineCurve) curve =
      GeomConvert::CurveToBSplineCurve(new Geom_TrimmedCurve(space, first, last));
  TColgp_Array1OfPnt2d poles(1, curve->NbPoles());
  const TColStd_Array1OfReal& flat = curve->KnotSequence();
  for (int i = 1; i <= curve->NbPoles(); ++i) {
    double greville = 0;
    for (int k = 1; k <= curve->Degree(); ++k) greville += flat(i + k) / curve->Degree();
    poles(i) = gp_Pnt2d(greville, curve->Pole(i).Z());
  }
  return new Geom2d_BSplineCurve(poles, curve->Knots(), curve->Multiplicities(), curve->Degree());
}

TopoDS_Face plane_wall(const OutlinePiece& piece, const TopoDS_Wire& wire) {
  const glm::dvec2 along = glm::normalize(piece.to - piece.from);
  const gp_Ax3 frame(gp_Pnt(piece.from.x, piece.from.y, 0), gp_Dir(along.y, -along.x, 0),
                     gp_Dir(along.x, along.y, 0));
  BRep_Builder builder;
  TopoDS_Face face;
  builder.MakeFace(face, new Geom_Plane(frame), kEdgeTolerance_mm);
  builder.Add(face, wire);
  return face;
}

/// The edges around one wall: back, up at the piece's end, front, down at its begin.
struct WallEdges {
  TopoDS_Edge back, end, front, begin;
};

TopoDS_Face cylinder_wall(const OutlinePiece& piece, const WallEdges& edges, const TopoDS_Wire& wire) {
  const glm::dvec2 axis = piece.from - piece.centre;
  const gp_Ax3 frame(gp_Pnt(piece.centre.x, piece.centre.y, 0), gp_Dir(0, 0, 1), gp_Dir(axis.x, axis.y, 0));
  const Handle(Geom_Surface) surface = new Geom_CylindricalSurface(frame, piece.radius);
  BRep_Builder builder;
  const auto upright = [&](const TopoDS_Edge& edge, double angle) {
    const double bottom = BRep_Tool::Pnt(TopExp::FirstVertex(edge)).Z();
    builder.UpdateEdge(edge, new Geom2d_Line(gp_Pnt2d(angle, bottom), gp_Dir2d(0, 1)), surface, {},
                       kEdgeTolerance_mm);
  };
  upright(edges.begin, 0);
  upright(edges.end, std::numbers::pi / 2);
  for (const TopoDS_Edge& edge : {edges.back, edges.front})
    builder.UpdateEdge(edge, on_cylinder(edge), surface, {}, kEdgeTolerance_mm);
  TopoDS_Face face;
  builder.MakeFace(face, surface, {}, kEdgeTolerance_mm);
  builder.Add(face, wire);
  return face;
}

/// Counter-clockwise as seen from outside.
TopoDS_Wire wire_around(const WallEdges& edges) {
  BRep_Builder builder;
  TopoDS_Wire wire;
  builder.MakeWire(wire);
  builder.Add(wire, edges.back);
  builder.Add(wire, edges.end);
  builder.Add(wire, edges.front.Reversed());
  builder.Add(wire, edges.begin.Reversed());
  wire.Closed(true);
  return wire;
}

std::vector<NamedFace> lens_faces(const LensShape& shape) {
  const LensBlank& blank = shape.blank();
  const std::vector<OutlinePiece> pieces = lens_outline(blank);
  const auto front = fitted_side([&](double x, double y) { return shape.front_z_mm(x, y); }, blank, "front");
  const auto back = fitted_side([&](double x, double y) { return shape.back_z_mm(x, y); }, blank, "back");
  const std::vector<TopoDS_Edge> front_edges = outline_edges(front, pieces);
  const std::vector<TopoDS_Edge> back_edges = outline_edges(back, pieces);
  std::vector<TopoDS_Edge> uprights;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    uprights.push_back(
        BRepBuilderAPI_MakeEdge(TopExp::FirstVertex(back_edges[i]), TopExp::FirstVertex(front_edges[i])));
  std::vector<NamedFace> faces{{face_inside(front, front_edges), "front"},
                               {TopoDS::Face(face_inside(back, back_edges).Reversed()), "back"}};
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const WallEdges edges{back_edges[i], uprights[(i + 1) % pieces.size()], front_edges[i], uprights[i]};
    const TopoDS_Wire wire = wire_around(edges);
    faces.push_back(
        {pieces[i].radius > 0 ? cylinder_wall(pieces[i], edges, wire) : plane_wall(pieces[i], wire), "rim"});
  }
  return faces;
}

NamedSolid lens_solid(const LensShape& shape) try {
  NamedSolid lens{"Lens", {}, lens_faces(shape)};
  BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  for (const NamedFace& named : lens.faces) builder.Add(shell, named.face);
  shell.Closed(true);
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  BRepLib::OrientClosedSolid(solid);
  BRepLib::SameParameter(solid, kEdgeTolerance_mm, true);
  if (!BRepCheck_Analyzer(solid).IsValid())
    refuse_lens("solid", "the kernel finds the solid invalid", "check the outline for tiny sides");
  lens.solid = solid;
  return lens;
} catch (const Standard_Failure& failure) {
  refuse_lens("solid", std::string("the kernel failed: ") + failure.GetMessageString());
}

}  // namespace

CadModel lens_model(const LensShape& shape) try {
  // No KernelSession: nothing here reads or writes a file, and lenses are made on many threads at once.
  const NamedSolid lens = lens_solid(shape);
  KernelDocument document;
  document.format = "made";
  document.unit = "mm";
  document.bodies = split_into_bodies(lens.solid, lens.name, std::nullopt);
  for (const NamedFace& named : lens.faces) document.names[named.face.TShape().get()] = named.name;
  const ImportOptions options;
  const Handle(ImportProgress) progress = new ImportProgress(options, "lens");
  return build_model(document, "lens", glm::dmat4(1), *progress);
} catch (const Standard_Failure& failure) {
  refuse_lens("solid", std::string("the kernel failed: ") + failure.GetMessageString());
}

void write_lens(const LensShape& shape, const std::filesystem::path& file) {
  write_named_solid(lens_solid(shape), file);
}

}  // namespace catoptra::cad_import
