// Triangles for the surroundings, by the kernel's own mesher.
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <tuple>

#include "cad_import/import.h"
#include "cad_import/src/affine_map.h"
#include "cad_import/src/face_measure.h"
#include "cad_import/src/kernel_session.h"
#include "cad_import/src/model_builder.h"

namespace catoptra::cad_import {
namespace {

class Triangulator {
 public:
  Triangulator(const CadModel& model, const TriangulationOptions& options, glm::vec3 default_color)
      : model_(model),
        kernel_(*static_cast<const KernelShapes*>(model.kernel_shapes.get())),
        options_(options),
        default_color_(default_color) {
    mesh_.file = model.file;
    mesh_.format = model.format;
  }

  TriangleMesh run(const std::vector<int>& faces) {
    mesh_with_kernel(faces);
    for (const int face : faces)
      if (!add(face)) unmeshed_.push_back(face);
    report();
    if (mesh_.materials.empty()) mesh_.materials.push_back({});
    return std::move(mesh_);
  }

 private:
  // All faces in one go, so that neighbours share the points of their edges.
  void mesh_with_kernel(const std::vector<int>& faces) const {
    TopoDS_Compound compound;
    BRep_Builder builder;
    builder.MakeCompound(compound);
    for (const int face : faces) builder.Add(compound, kernel_.faces[std::size_t(face)]);
    BRepTools::Clean(
        compound);  // what an earlier call left would make the result depend on the order of calls
    const double scale = AffineMap(kernel_.placement).scale();
    BRepMesh_IncrementalMesh(compound, options_.chord_mm / scale, false, options_.angle_rad, false);
  }

  bool add(int index) {
    const Face& face = model_.faces[std::size_t(index)];
    const TopoDS_Face& shape = kernel_.faces[std::size_t(index)];
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(shape, location);
    if (triangulation.IsNull() || triangulation->NbTriangles() == 0) return false;
    const AffineMap map(kernel_.placement * to_glm(location.Transformation()));
    const auto base = std::uint32_t(mesh_.positions.size());
    for (int i = 1; i <= triangulation->NbNodes(); ++i) {
      const glm::dvec3 p = map.point(triangulation->Node(i).XYZ());
      extend(mesh_.bounds, p);
      mesh_.positions.emplace_back(p);
      mesh_.texture_coordinates.emplace_back(0.0f);
      const gp_Pnt2d uv = triangulation->UVNode(i);
      mesh_.normals.emplace_back(face.surface->unit_normal(uv.X(), uv.Y()));
    }
    // The kernel's triangles run counter-clockwise about du x dv.
    const bool turn = face.surface->orientation() < 0;
    const std::uint32_t material = material_of(face);
    for (int i = 1; i <= triangulation->NbTriangles(); ++i) {
      int a = 0, b = 0, c = 0;
      triangulation->Triangle(i).Get(a, b, c);
      if (turn) std::swap(b, c);
      mesh_.triangles.emplace_back(base + std::uint32_t(a - 1), base + std::uint32_t(b - 1),
                                   base + std::uint32_t(c - 1));
      mesh_.triangle_material.push_back(material);
    }
    return true;
  }

  std::uint32_t material_of(const Face& face) {
    const glm::vec3 color = face.color ? glm::vec3(*face.color) : default_color_;
    const auto key = std::tuple(color.r, color.g, color.b);
    const auto [it, fresh] = material_of_color_.try_emplace(key, std::uint32_t(mesh_.materials.size()));
    if (fresh) {
      Material material;
      material.name = model_.bodies[std::size_t(face.body)].name;
      material.base_color = color;
      mesh_.materials.push_back(std::move(material));
    }
    return it->second;
  }

  void report() {
    if (unmeshed_.empty()) return;
    std::string names;
    for (const int face : unmeshed_)
      names.append(names.empty() ? "" : ", ").append(model_.faces[std::size_t(face)].id);
    mesh_.warnings.push_back(std::to_string(unmeshed_.size()) + " face(s) could not be meshed: " + names);
  }

  const CadModel& model_;
  const KernelShapes& kernel_;
  TriangulationOptions options_;
  glm::vec3 default_color_;
  std::map<std::tuple<float, float, float>, std::uint32_t> material_of_color_;
  std::vector<int> unmeshed_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh triangulate(const CadModel& model, std::span<const int> face_indices,
                         const TriangulationOptions& options, glm::vec3 default_color) {
  if (!model.kernel_shapes)
    throw ImportError(model.file, "", "was not read from a CAD file, so that it cannot be meshed");
  if (!(options.chord_mm > 0) || !(options.angle_rad > 0))
    throw ImportError(model.file, "", "chord and angle of a triangulation must be above 0");
  std::vector<int> faces(face_indices.begin(), face_indices.end());
  if (faces.empty()) {
    faces.resize(model.faces.size());
    std::iota(faces.begin(), faces.end(), 0);
  }
  for (const int face : faces)
    if (face < 0 || face >= int(model.faces.size()))
      throw ImportError(model.file, "face " + std::to_string(face), "is not in the model");
  const KernelSession session;
  try {
    return Triangulator(model, options, default_color).run(faces);
  } catch (const Standard_Failure& failure) {
    throw ImportError(model.file, "",
                      std::string("the CAD kernel failed to mesh it: ") + failure.GetMessageString());
  }
}

}  // namespace catoptra::cad_import
