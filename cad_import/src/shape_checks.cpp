#include "cad_import/src/shape_checks.h"

#include <BRepCheck_Analyzer.hxx>
#include <BRep_Tool.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <array>
#include <cstdio>
#include <glm/common.hpp>

namespace catoptra::cad_import {
namespace {

// An edge that only one face uses once leaves the shell open there (a seam is used twice by one face).
bool is_open(const TopoDS_Shape& shell) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_of;
  TopExp::MapShapesAndAncestors(shell, TopAbs_EDGE, TopAbs_FACE, faces_of);
  for (int i = 1; i <= faces_of.Extent(); ++i) {
    const TopoDS_Edge& edge = TopoDS::Edge(faces_of.FindKey(i));
    if (!BRep_Tool::Degenerated(edge) && faces_of(i).Extent() < 2) return true;
  }
  return false;
}

std::string open_shells(const KernelDocument& document) {
  int open = 0, all = 0;
  for (const KernelBody& body : document.bodies)
    for (TopExp_Explorer it(body.shape, TopAbs_SHELL); it.More(); it.Next()) {
      ++all;
      if (is_open(it.Current())) ++open;
    }
  if (open == 0) return {};
  return std::to_string(open) + " of " + std::to_string(all) + " shell(s) are open";
}

std::string invalid_faces(std::span<const TopoDS_Face> faces, const CadModel& model) {
  constexpr int kNamed = 5;
  int count = 0;
  std::string names;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    bool valid = false;
    try {
      valid = BRepCheck_Analyzer(faces[i]).IsValid();
    } catch (const Standard_Failure&) {
    }
    if (!valid && ++count <= kNamed) names += (names.empty() ? "" : ", ") + model.faces[i].id;
  }
  if (count == 0) return {};
  if (count > kNamed) names += ", ...";
  return std::to_string(count) + " face(s) are invalid (self-crossing or inconsistent boundary): " + names;
}

}  // namespace

std::vector<std::string> shape_warnings(const KernelDocument& document, std::span<const TopoDS_Face> faces,
                                        const CadModel& model) {
  std::vector<std::string> warnings;
  for (std::string warning : {open_shells(document), invalid_faces(faces, model)})
    if (!warning.empty()) warnings.push_back(std::move(warning));
  return warnings;
}

std::string size_warning(const BoundingBox& bounds) {
  constexpr double kLargestMm = 10e3, kSmallestMm = 1;  // no mirror, lens or car is outside
  const glm::dvec3 size = bounds.max - bounds.min;
  const double length = std::max({size.x, size.y, size.z});
  if (length <= kLargestMm && length >= kSmallestMm) return {};
  std::array<char, 64> text{};
  if (length > kLargestMm)
    std::snprintf(text.data(), text.size(), "%.3g m long: is the unit right?", length * 1e-3);
  else
    std::snprintf(text.data(), text.size(), "%.3g mm long: is the unit right?", length);
  return text.data();
}

}  // namespace catoptra::cad_import
