// Lenses with a closed form, free of any CAD kernel: two spheres (or planes) with the axis along z.
#pragma once

#include <memory>
#include <utility>

#include "optics/optic.h"
#include "tests/support/analytic_optic.h"

namespace catoptra::test {

/// Another surface moved along z, with its normal turned to -z: the back of a lens.
class BackSurface : public cad_import::ExactSurface {
 public:
  BackSurface(std::shared_ptr<const cad_import::ExactSurface> front, double z_mm)
      : front_(std::move(front)), z_(z_mm) {}

  cad_import::SurfaceKind kind() const override { return front_->kind(); }
  cad_import::ParameterDomain domain() const override { return front_->domain(); }
  double orientation() const override { return -1; }
  glm::dvec3 point(double u, double v) const override { return front_->point(u, v) + glm::dvec3(0, 0, z_); }
  cad_import::SurfaceFrame d1(double u, double v) const override {
    auto f = front_->d1(u, v);
    f.point.z += z_;
    return f;
  }
  cad_import::SurfaceDerivatives d2(double u, double v) const override {
    auto f = front_->d2(u, v);
    f.point.z += z_;
    return f;
  }

 private:
  std::shared_ptr<const cad_import::ExactSurface> front_;
  double z_;
};

/// A square lens of `width_mm` around the z axis whose sides are height fields with u = x and v = y, of
/// index 1.5 in air. Normals point out of it.
inline optics::Optic lens_of_sides(std::shared_ptr<const cad_import::ExactSurface> front,
                                   std::shared_ptr<const cad_import::ExactSurface> back, double width_mm,
                                   int per_side) {
  auto lens = rectangular_mirror(std::move(front), width_mm, width_mm, per_side, per_side);
  auto behind = rectangular_mirror(std::move(back), width_mm, width_mm, per_side, per_side);
  for (auto& triangle : behind.mesh.triangles) {  // counter-clockwise as seen from -z
    std::swap(triangle.vertices[1], triangle.vertices[2]);
    std::swap(triangle.uv[1], triangle.uv[2]);
  }
  lens.name = "test lens";
  lens.kind = optics::OpticKind::lens;
  lens.back = {std::move(behind.faces), std::move(behind.mesh)};
  lens.medium = optics::constant_medium(1.5);
  return lens;
}

/// The same between two surfaces with normals towards +z of which the back is moved down by the thickness.
inline optics::Optic lens_between(std::shared_ptr<const cad_import::ExactSurface> front,
                                  std::shared_ptr<const cad_import::ExactSurface> back, double thickness_mm,
                                  double width_mm, int per_side) {
  return lens_of_sides(std::move(front), std::make_shared<BackSurface>(std::move(back), -thickness_mm),
                       width_mm, per_side);
}

/// The same of two spheres, its front vertex at the origin and its front towards +z. Radii in mm are
/// positive where the centre of curvature lies towards -z (the side the light leaves to), 0 for a plane;
/// `per_side` vertices a side.
inline optics::Optic spherical_lens(double front_radius_mm, double back_radius_mm, double thickness_mm,
                                    double width_mm, int per_side) {
  const auto sphere = [&](double radius) {
    return std::make_shared<ConicSurface>(radius == 0 ? 0 : 1 / radius, 0, width_mm / 2, width_mm / 2);
  };
  return lens_between(sphere(front_radius_mm), sphere(back_radius_mm), thickness_mm, width_mm, per_side);
}

}  // namespace catoptra::test
