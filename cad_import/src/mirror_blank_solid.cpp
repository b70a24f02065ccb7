// A mirror glass as a solid: the surface trimmed by its outline and swept back by its thickness.
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Circle.hxx>
#include <Geom2d_Line.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "cad_import/src/mirror_blank_parts.h"

namespace catoptra::cad_import {
namespace {

/// How far an edge's space curve may leave the glass, and the tolerance of its vertices.
constexpr double kEdgeTolerance_mm = 1e-7;

/// One piece of the outline, counter-clockwise: a straight side, or an arc about `centre` where radius > 0.
struct OutlinePiece {
  glm::dvec2 from, to;
  glm::dvec2 centre{0};
  double radius = 0;
};

std::vector<OutlinePiece> polygon_pieces(std::vector<glm::dvec2> corners) {
  double twice_area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    twice_area += a.x * b.y - a.y * b.x;
  }
  if (twice_area < 0) corners = {corners.rbegin(), corners.rend()};
  std::vector<OutlinePiece> pieces;
  for (std::size_t i = 0; i < corners.size(); ++i)
    pieces.push_back({corners[i], corners[(i + 1) % corners.size()], {}, 0});
  return pieces;
}

std::vector<OutlinePiece> rounded_pieces(const OutlineBox& box, double radius) {
  const glm::dvec2 in_min = box.min + radius, in_max = glm::max(box.max - radius, in_min);
  const glm::dvec2 centres[4]{{in_max.x, in_min.y}, in_max, {in_min.x, in_max.y}, in_min};
  const glm::dvec2 directions[4]{{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
  std::vector<OutlinePiece> pieces;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec2 begin = centres[i] + radius * directions[i];
    const glm::dvec2 end = centres[i] + radius * directions[(i + 1) % 4];
    pieces.push_back({begin, end, centres[i], radius});
    const glm::dvec2 next = centres[(i + 1) % 4] + radius * directions[(i + 1) % 4];
    if (glm::length(next - end) > 1e-6) pieces.push_back({end, next, {}, 0});
  }
  return pieces;
}

std::vector<OutlinePiece> outline_pieces(const MirrorBlank& blank) {
  const OutlineBox box = outline_box(blank);
  switch (blank.outline) {
    case MirrorOutline::rounded:
      return rounded_pieces(box, blank.corner_radius_mm);
    case MirrorOutline::polygon:
      return polygon_pieces(blank.polygon);
    case MirrorOutline::rectangle:
      break;
  }
  return polygon_pieces({box.min, {box.max.x, box.min.y}, box.max, {box.min.x, box.max.y}});
}

TopoDS_Edge make_edge(const OutlinePiece& piece, const Handle(Geom_BSplineSurface) & surface,
                      const TopoDS_Vertex& from, const TopoDS_Vertex& to) {
  const gp_Pnt2d a(piece.from.x, piece.from.y);
  if (piece.radius == 0) {
    const glm::dvec2 step = piece.to - piece.from;
    return BRepBuilderAPI_MakeEdge(new Geom2d_Line(a, gp_Dir2d(step.x, step.y)), surface, from, to, 0,
                                   glm::length(step));
  }
  // The corners are quarter circles; a local x axis through `from` makes the arc's parameter begin at 0.
  const glm::dvec2 axis = piece.from - piece.centre;
  const gp_Ax22d frame(gp_Pnt2d(piece.centre.x, piece.centre.y), gp_Dir2d(axis.x, axis.y), true);
  return BRepBuilderAPI_MakeEdge(new Geom2d_Circle(frame, piece.radius), surface, from, to, 0,
                                 std::numbers::pi / 2);
}

TopoDS_Face glass_face(const MirrorBlank& blank) {
  const Handle(Geom_BSplineSurface) surface = glass_surface(blank);
  const std::vector<OutlinePiece> pieces = outline_pieces(blank);
  std::vector<TopoDS_Vertex> vertices(pieces.size());
  BRep_Builder builder;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    builder.MakeVertex(vertices[i], surface->Value(pieces[i].from.x, pieces[i].from.y), kEdgeTolerance_mm);
  BRepBuilderAPI_MakeWire wire;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    wire.Add(make_edge(pieces[i], surface, vertices[i], vertices[(i + 1) % pieces.size()]));
  BRepBuilderAPI_MakeFace face(surface, wire.Wire(), true);
  if (!face.IsDone()) throw Error("mirror", "Glass", "the outline does not bound a face");
  TopoDS_Face result = face.Face();
  BRepLib::BuildCurves3d(result, kEdgeTolerance_mm);
  BRepLib::SameParameter(result, kEdgeTolerance_mm);
  return result;
}

}  // namespace

MirrorSolid mirror_solid(const MirrorBlank& blank) try {
  const TopoDS_Face glass = glass_face(blank);
  BRepPrimAPI_MakePrism prism(glass, gp_Vec(0, 0, -blank.thickness_mm), true);
  MirrorSolid result{prism.Shape(), {}};
  GProp_GProps volume;
  BRepGProp::VolumeProperties(result.solid, volume);
  if (volume.Mass() < 0) result.solid.Reverse();
  if (result.solid.ShapeType() != TopAbs_SOLID || !BRepCheck_Analyzer(result.solid).IsValid())
    throw Error("mirror", "solid", "the kernel finds the solid invalid", "check the outline for tiny sides");

  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(result.solid, TopAbs_FACE, faces);
  const TopoDS_Shape front = prism.FirstShape(), back = prism.LastShape();
  for (int i = 1; i <= faces.Extent(); ++i) {
    const TopoDS_Shape& face = faces(i);
    const char* name = face.IsSame(front) ? "Glass" : face.IsSame(back) ? "Back" : "Edge";
    result.faces.push_back({TopoDS::Face(face), name});
  }
  return result;
} catch (const Standard_Failure& failure) {
  throw Error("mirror", "solid", std::string("the kernel failed: ") + failure.GetMessageString());
}

}  // namespace catoptra::cad_import
