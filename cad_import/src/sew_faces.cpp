#include "cad_import/src/sew_faces.h"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <cmath>

namespace catoptra::cad_import {
namespace {

// Share of the body's diagonal: 2 um on a mirror of 200 mm, as fine as the trimming of faces is kept. Files
// whose neighbours are further apart than that would need a curve that lies on neither surface.
constexpr double kGapShare = 1e-5;

std::vector<TopoDS_Shape> faces_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Shape> faces;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) faces.push_back(it.Current());
  return faces;
}

bool has_free_edge(const TopoDS_Shape& shape) {
  TopTools_IndexedDataMapOfShapeListOfShape users;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, users);
  for (int i = 1; i <= users.Extent(); ++i)
    if (users(i).Extent() < 2) return true;
  return false;
}

double diagonal_mm(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  return std::sqrt(box.SquareExtent());
}

/// Sews the faces of one body, which must live on.
class BodySewing {
 public:
  explicit BodySewing(const TopoDS_Shape& body)
      : faces_(faces_of(body)), sewing_(kGapShare * diagonal_mm(body)) {
    for (const TopoDS_Shape& face : faces_) sewing_.Add(face);
    sewing_.Perform();
    for (const TopoDS_Shape& face : faces_) before_[sewn(face).TShape().get()] = face;
    const TopoDS_Shape& result = sewing_.SewedShape();
    for (TopExp_Explorer it(result, TopAbs_SHELL); it.More(); it.Next()) note_oriented(it.Current());
    for (TopExp_Explorer it(result, TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next())
      after_[it.Current().TShape().get()] = it.Current().Oriented(before(it.Current()).Orientation());
  }

  /// In the order of the body's own faces. One that the kernel dropped stays as it was.
  [[nodiscard]] std::vector<std::pair<TopoDS_Shape, TopoDS_Shape>> before_and_after() const {
    std::vector<std::pair<TopoDS_Shape, TopoDS_Shape>> pairs;
    for (const TopoDS_Shape& face : faces_) {
      const auto found = after_.find(sewn(face).TShape().get());
      pairs.emplace_back(face, found == after_.end() ? face : found->second);
    }
    return pairs;
  }

 private:
  TopoDS_Shape sewn(const TopoDS_Shape& face) const {
    return sewing_.IsModified(face) ? sewing_.Modified(face) : face;
  }
  const TopoDS_Shape& before(const TopoDS_Shape& face) const {
    const auto found = before_.find(face.TShape().get());
    return found == before_.end() ? face : found->second;
  }

  // Within a shell the faces agree on a side, but which one is the kernel's choice: the file's majority has
  // it.
  void note_oriented(const TopoDS_Shape& shell) {
    const std::vector<TopoDS_Shape> faces = faces_of(shell);
    std::size_t turned = 0;
    for (const TopoDS_Shape& face : faces)
      if (face.Orientation() != before(face).Orientation()) ++turned;
    const bool turn_back = 2 * turned > faces.size();
    for (const TopoDS_Shape& face : faces)
      after_[face.TShape().get()] = turn_back ? TopoDS_Shape(face.Reversed()) : face;
  }

  std::vector<TopoDS_Shape> faces_;
  BRepBuilderAPI_Sewing sewing_;
  std::unordered_map<const TopoDS_TShape*, TopoDS_Shape> before_, after_;  // by the sewn face
};

template <class Map>
void copy_entry(Map& map, const TopoDS_Shape& from, const TopoDS_Shape& to) {
  const auto found = map.find(from.TShape().get());
  if (found == map.end()) return;
  const auto value = found->second;
  map.try_emplace(to.TShape().get(), value);
}

}  // namespace

void sew_loose_faces(KernelDocument& document) {
  for (KernelBody& body : document.bodies) {
    if (body.solid || body.shape.ShapeType() != TopAbs_COMPOUND || !has_free_edge(body.shape)) continue;
    try {
      TopoDS_Compound joined;
      BRep_Builder builder;
      builder.MakeCompound(joined);
      for (const auto& [before, after] : BodySewing(body.shape).before_and_after()) {
        builder.Add(joined, after);
        copy_entry(document.names, before, after);
        copy_entry(document.colors, before, after);
      }
      body.shape = joined;
    } catch (const Standard_Failure& failure) {
      document.warnings.push_back("faces that touch could not be joined: " +
                                  std::string(failure.GetMessageString()));
    }
  }
}

}  // namespace catoptra::cad_import
