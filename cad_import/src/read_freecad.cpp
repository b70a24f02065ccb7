// A FreeCAD document: a ZIP archive of XML that says what is shown, and of one BREP entry for each shape.
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepBuilderAPI_GTransform.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <Quantity_Color.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gp_GTrsf.hxx>
#include <map>
#include <set>

#include "cad_import/src/freecad_archive.h"
#include "cad_import/src/freecad_document.h"
#include "cad_import/src/freecad_tree.h"
#include "cad_import/src/kernel_document.h"

namespace catoptra::cad_import {
namespace {

glm::dvec3 linear(const glm::dvec3& srgb) {
  const Quantity_Color color(srgb.r, srgb.g, srgb.b, Quantity_TOC_sRGB);
  return {color.Red(), color.Green(), color.Blue()};
}

/// How a matrix changes lengths, from its rotations, which are exact to rounding only.
enum class Scaling { none, uniform, distorting };

Scaling scaling_of(const glm::dmat4& m) {
  constexpr double kRounding = 1e-9;
  const glm::dmat3 linear_part(m);
  const glm::dmat3 product = glm::transpose(linear_part) * linear_part;
  const double square = product[0][0];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (std::abs(product[i][k] - (i == k ? square : 0)) > kRounding * square) return Scaling::distorting;
  const bool moves_only = std::abs(square - 1) <= kRounding && glm::determinant(linear_part) > 0;
  return moves_only ? Scaling::none : Scaling::uniform;
}

gp_Trsf similarity(const glm::dmat4& m) {
  gp_Trsf t;
  t.SetValues(m[0][0], m[1][0], m[2][0], m[3][0],  //
              m[0][1], m[1][1], m[2][1], m[3][1],  //
              m[0][2], m[1][2], m[2][2], m[3][2]);
  return t;
}

/// `shape` has no location of its own.
TopoDS_Shape put(const TopoDS_Shape& shape, const glm::dmat4& m) {
  switch (scaling_of(m)) {
    case Scaling::none:
      return shape.Located(TopLoc_Location(similarity(m)));
    case Scaling::uniform:
      return BRepBuilderAPI_Transform(shape, similarity(m), true).Shape();
    case Scaling::distorting:
      break;
  }
  gp_GTrsf t;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) t.SetValue(row + 1, column + 1, m[column][row]);
  return BRepBuilderAPI_GTransform(shape, t, true).Shape();
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, ImportProgress& progress) : archive_(file), progress_(progress) {}

  KernelDocument read() {
    progress_.stage("reading", 0.0, 0.1);
    document_ = read_freecad_document(archive_);
    FreecadScene scene = freecad_scene(document_, archive_.file());
    result_.format = "FreeCAD";
    result_.unit = "mm";  // whatever the user sees: FreeCAD keeps every length in mm
    result_.warnings = std::move(scene.warnings);
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
      const double done = double(i) / double(scene.shapes.size());
      progress_.stage("reading", 0.1 + 0.7 * done, 0.1 + 0.7 * (done + 1.0 / double(scene.shapes.size())));
      add(scene.shapes[i]);
    }
    if (result_.bodies.empty()) fail_empty();
    return std::move(result_);
  }

 private:
  /// Null where the entry is empty, as it is of objects that have no shape yet.
  const TopoDS_Shape& shape_of(const FreecadObject& object) {
    const auto [found, fresh] = shapes_.try_emplace(object.shape_entry);
    if (!fresh) return found->second;
    const std::string entry = object.shape_entry + " (\"" + object.label_or_name() + "\")";
    auto bytes = archive_.read(object.shape_entry, FreecadArchive::kMostShapeBytes);
    if (!bytes)
      throw ImportError(archive_.file(), entry, "is missing from the document",
                        "recompute and save it again in FreeCAD");
    if (bytes->empty()) return found->second;
    found->second = read_brep_shape(std::move(*bytes), archive_.file(), entry, progress_);
    return found->second;
  }

  void add(const FreecadShown& shown) {
    const FreecadObject& object = document_.objects[shown.object];
    TopoDS_Shape shape = shape_of(object);
    if (shape.IsNull() || !TopExp_Explorer(shape, TopAbs_FACE).More()) return;  // sketches, rays, axes
    // Names and colours are kept by the kernel's shape, so that one shown twice must be two.
    if (!used_.insert(object.shape_entry).second) shape = BRepBuilderAPI_Copy(shape).Shape();
    if (shown.place) shape = put(shape.Located(TopLoc_Location()), *shown.place);
    note_faces(shape, object, shown);
    std::optional<glm::dvec3> color = shown.color ? shown.color : object.color;
    if (color) color = linear(*color);
    for (KernelBody& body : split_into_bodies(shape, shown.label, color)) {
      body.placement = shape.Location();
      result_.bodies.push_back(std::move(body));
    }
  }

  /// FreeCAD calls the faces of a shape Face1, Face2, ... in the kernel's order.
  void note_faces(const TopoDS_Shape& shape, const FreecadObject& object, const FreecadShown& shown) {
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    const bool colored = !shown.color && object.face_colors.size() == std::size_t(faces.Extent());
    for (int i = 1; i <= faces.Extent(); ++i) {
      const TopoDS_TShape* key = faces(i).TShape().get();
      result_.names.try_emplace(key, shown.label + ".Face" + std::to_string(i));
      if (colored) result_.colors.try_emplace(key, linear(object.face_colors[std::size_t(i - 1)]));
    }
  }

  [[noreturn]] void fail_empty() const {
    std::string why;
    for (const std::string& warning : result_.warnings) why += "; " + warning;
    throw ImportError(
        archive_.file(), "", "no face in it" + why,
        "points, curves and meshes cannot reflect or refract; show a solid or a surface in FreeCAD");
  }

  FreecadArchive archive_;
  ImportProgress& progress_;
  FreecadDocument document_;
  KernelDocument result_;
  std::map<std::string, TopoDS_Shape> shapes_;  // by entry
  std::set<std::string> used_;                  // entries that a body was made of
};

}  // namespace

KernelDocument read_freecad(const std::filesystem::path& file, ImportProgress& progress) {
  return Reader(file, progress).read();
}

}  // namespace catoptra::cad_import
