// Faces cut to an outline.
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <Geom2d_Circle.hxx>
#include <Geom2d_Line.hxx>
#include <TopoDS_Vertex.hxx>
#include <glm/geometric.hpp>
#include <numbers>

#include "cad_import/src/blank_parts.h"

namespace catoptra::cad_import {
namespace {

TopoDS_Edge make_edge(const OutlinePiece& piece, const Handle(Geom_BSplineSurface) & surface,
                      const TopoDS_Vertex& from, const TopoDS_Vertex& to) {
  const gp_Pnt2d a(piece.from.x, piece.from.y);
  if (piece.radius == 0) {
    const glm::dvec2 step = piece.to - piece.from;
    return BRepBuilderAPI_MakeEdge(new Geom2d_Line(a, gp_Dir2d(step.x, step.y)), surface, from, to, 0,
                                   glm::length(step));
  }
  // Arcs are quarter circles; a local x axis through `from` makes the arc's parameter begin at 0.
  const glm::dvec2 axis = piece.from - piece.centre;
  const gp_Ax22d frame(gp_Pnt2d(piece.centre.x, piece.centre.y), gp_Dir2d(axis.x, axis.y), true);
  return BRepBuilderAPI_MakeEdge(new Geom2d_Circle(frame, piece.radius), surface, from, to, 0,
                                 std::numbers::pi / 2);
}

}  // namespace

std::vector<TopoDS_Edge> outline_edges(const Handle(Geom_BSplineSurface) & surface,
                                       std::span<const OutlinePiece> pieces) {
  std::vector<TopoDS_Vertex> vertices(pieces.size());
  BRep_Builder builder;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    builder.MakeVertex(vertices[i], surface->Value(pieces[i].from.x, pieces[i].from.y), kEdgeTolerance_mm);
  std::vector<TopoDS_Edge> edges;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    edges.push_back(make_edge(pieces[i], surface, vertices[i], vertices[(i + 1) % pieces.size()]));
    BRepLib::BuildCurve3d(edges.back(), kEdgeTolerance_mm);
  }
  return edges;
}

TopoDS_Face face_inside(const Handle(Geom_BSplineSurface) & surface, std::span<const TopoDS_Edge> edges) {
  BRepBuilderAPI_MakeWire wire;
  for (const TopoDS_Edge& edge : edges) wire.Add(edge);
  BRepBuilderAPI_MakeFace face(surface, wire.Wire(), true);
  if (!face.IsDone()) throw Error("", "outline", "does not bound a face", "check it for tiny sides");
  TopoDS_Face result = face.Face();
  BRepLib::SameParameter(result, kEdgeTolerance_mm);
  return result;
}

}  // namespace catoptra::cad_import
