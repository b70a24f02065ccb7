// A mirror glass as a solid: the surface trimmed by its outline and swept back by its thickness.
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <GProp_GProps.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <vector>

#include "cad_import/src/blank_parts.h"
#include "cad_import/src/mirror_blank_parts.h"

namespace catoptra::cad_import {
namespace {

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

/// Bicubic interpolant of the ideal surface over the outline's box, C2 everywhere.
Handle(Geom_BSplineSurface) glass_surface(const MirrorBlank& blank) {
  const OutlineBox box = outline_box(blank);
  HeightFit fit;
  fit.degree = 3;
  fit.tolerance_mm = 5e-7;  // half of what is promised: the check points may miss the worst place
  // The third derivative jumps at the aspheric boundary.
  if (blank.aspheric)
    fit.x_line = blank.aspheric->towards_minus_x ? -blank.aspheric->boundary_mm : blank.aspheric->boundary_mm;
  const FittedSurface fitted =
      fit_height_field([&](double x, double y) { return ideal_sag_mm(blank, box, x, y); }, box, fit);
  if (fitted.error_mm > fit.tolerance_mm)
    throw Error("mirror", "radius",
                "the glass is too steep at its edge for a B-spline within 1e-6 mm: " +
                    std::to_string(fitted.error_mm) + " mm",
                "make the glass smaller or the radius larger");
  return fitted.surface;
}

TopoDS_Face glass_face(const MirrorBlank& blank) {
  const Handle(Geom_BSplineSurface) surface = glass_surface(blank);
  return face_inside(surface, outline_edges(surface, outline_pieces(blank)));
}

/// The glass cut to its outline and pulled back by its thickness; checked by the kernel.
NamedSolid mirror_solid(const MirrorBlank& blank) try {
  const TopoDS_Face glass = glass_face(blank);
  BRepPrimAPI_MakePrism prism(glass, gp_Vec(0, 0, -blank.thickness_mm), true);
  NamedSolid result{"Mirror", prism.Shape(), {}};
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

}  // namespace

void write_mirror_blank(const MirrorBlank& blank, const std::filesystem::path& file) {
  check_blank(blank);
  write_named_solid(mirror_solid(blank), file);
}

}  // namespace catoptra::cad_import
