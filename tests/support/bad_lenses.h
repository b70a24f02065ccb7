// Lenses that no maker would make, from the CAD kernel.
#pragma once

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gp_Cylinder.hxx>
#include <gp_Sphere.hxx>
#include <initializer_list>
#include <numbers>
#include <stdexcept>

namespace catoptra::test {

/// A round piece of a sphere around the z axis with its vertex at (0, 0, `vertex_mm`): `radius_mm` positive
/// where it is domed towards +z, as both sides of the usual meniscus are.
struct Cap {
  double radius_mm, vertex_mm, half_diameter_mm = 20;
  [[nodiscard]] double rim_mm() const {
    const double r = std::abs(radius_mm);
    const double sag = r - std::sqrt(r * r - half_diameter_mm * half_diameter_mm);
    return vertex_mm - std::copysign(sag, radius_mm);
  }
};

inline TopoDS_Face face_of(const Cap& cap) {
  const gp_Sphere sphere(gp_Ax3(gp_Pnt(0, 0, cap.vertex_mm - cap.radius_mm), gp_Dir(0, 0, 1)),
                         std::abs(cap.radius_mm));
  const double rim = std::acos(cap.half_diameter_mm / std::abs(cap.radius_mm)), pole = std::numbers::pi / 2;
  const double from = cap.radius_mm > 0 ? rim : -pole, to = cap.radius_mm > 0 ? pole : -rim;
  return BRepBuilderAPI_MakeFace(sphere, 0, 2 * std::numbers::pi, from, to);
}

inline void write_brep(const TopoDS_Shape& shape, const std::filesystem::path& file) {
  if (!BRepTools::Write(shape, file.c_str()))
    throw std::runtime_error("the test could not write " + file.string());
}

/// The caps as loose faces, in this order.
inline void write_caps(std::initializer_list<Cap> caps, const std::filesystem::path& file) {
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const Cap& cap : caps) builder.Add(compound, face_of(cap));
  write_brep(compound, file);
}

/// Front, back and the cylinder between their rims as one shell, closed by sewing whatever it encloses;
/// without the cylinder where the rims are one.
inline TopoDS_Shell sewn(const Cap& front, const Cap& back) {
  const gp_Cylinder cylinder(gp_Ax3(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), front.half_diameter_mm);
  BRepBuilderAPI_Sewing sewing(1e-4);
  for (const Cap& cap : {front, back}) sewing.Add(face_of(cap));
  if (std::abs(front.rim_mm() - back.rim_mm()) > 1e-6)
    sewing.Add(BRepBuilderAPI_MakeFace(cylinder, 0, 2 * std::numbers::pi,
                                       std::min(front.rim_mm(), back.rim_mm()),
                                       std::max(front.rim_mm(), back.rim_mm())));
  sewing.Perform();
  TopExp_Explorer shell(sewing.SewedShape(), TopAbs_SHELL);
  if (!shell.More()) throw std::runtime_error("the test could not sew its lens");
  return TopoDS::Shell(shell.Current());
}

inline void write_solid(const Cap& front, const Cap& back, const std::filesystem::path& file) {
  write_brep(BRepBuilderAPI_MakeSolid(sewn(front, back)).Solid(), file);
}

inline void write_cube(double side_mm, const std::filesystem::path& file) {
  write_brep(BRepPrimAPI_MakeBox(side_mm, side_mm, side_mm).Shape(), file);
}

}  // namespace catoptra::test
