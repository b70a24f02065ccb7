#include "cad_import/polygon.h"

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <Standard_Failure.hxx>
#include <algorithm>
#include <gp_Pln.hxx>
#include <glm/geometric.hpp>
#include <string>

#include "cad_import/import.h"
#include "cad_import/src/kernel_document.h"
#include "cad_import/src/model_builder.h"

namespace catoptra::cad_import {
namespace {

constexpr double kFlatness = 1e-6;  // of the polygon's size

[[noreturn]] void refuse(const std::string& what, const std::string& hint) {
  throw Error("", "corners", what, hint);
}

/// Twice the area, along the normal (Newell's method).
glm::dvec3 area_vector(std::span<const glm::dvec3> corners) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  return sum;
}

gp_Pnt point(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

void check_corners(std::span<const glm::dvec3> corners, const glm::dvec3& area) {
  double size = 0;
  for (const glm::dvec3& corner : corners) size = std::max(size, glm::distance(corner, corners[0]));
  if (!(glm::length(area) > kFlatness * size * size))
    refuse("the corners lie on one line or point", "give at least three corners that span a plane");
  const glm::dvec3 normal = glm::normalize(area);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (std::abs(glm::dot(corners[i] - corners[0], normal)) > kFlatness * size)
      refuse("corner " + std::to_string(i + 1) + " does not lie in the plane of the others",
             "a planar optic is flat: move the corner, or make two of it");
    if (glm::distance(corners[i], corners[(i + 1) % corners.size()]) < kFlatness * size)
      refuse("corner " + std::to_string(i + 1) + " is the same as the next", "leave one of them out");
  }
}

}  // namespace

CadModel polygon_model(std::span<const glm::dvec3> corners_mm) try {
  if (corners_mm.size() < 3) refuse("fewer than three corners", "give at least three");
  const glm::dvec3 area = area_vector(corners_mm);
  check_corners(corners_mm, area);
  BRepBuilderAPI_MakePolygon polygon;
  for (const glm::dvec3& corner : corners_mm) polygon.Add(point(corner));
  polygon.Close();
  const gp_Pln plane(point(corners_mm[0]), gp_Dir(area.x, area.y, area.z));
  BRepBuilderAPI_MakeFace face(plane, polygon.Wire());
  if (!face.IsDone() || !BRepCheck_Analyzer(face.Face()).IsValid())
    refuse("the outline crosses itself", "give the corners in their order along the outline");
  KernelDocument document;
  document.format = "made";
  document.unit = "mm";
  document.bodies = split_into_bodies(face.Face(), "polygon", std::nullopt);
  document.names[face.Face().TShape().get()] = "Polygon";
  const ImportOptions options;
  const Handle(ImportProgress) progress = new ImportProgress(options, "polygon");
  return build_model(document, "polygon", glm::dmat4(1), *progress);
} catch (const Standard_Failure& failure) {
  refuse(std::string("the kernel failed: ") + failure.GetMessageString(), "check the corners");
}

}  // namespace catoptra::cad_import
