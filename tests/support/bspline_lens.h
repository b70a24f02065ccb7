// Lenses of two B-spline faces, free of any CAD kernel: height fields with u = x and v = y.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <utility>

#include "cad_import/bspline_surface.h"
#include "tests/support/analytic_lens.h"

namespace catoptra::test {

/// The disc of radius `r` around the origin of (u, v).
class RoundTrim : public cad_import::FaceTrim {
 public:
  explicit RoundTrim(double radius) : radius_(radius) {}
  bool contains(double u, double v) const override { return std::hypot(u, v) <= radius_; }

 private:
  double radius_;
};

/// A B-spline of `degree` with `poles` a side over the square |u|, |v| <= width/2, close to the sphere
/// z = -r^2 / 2R - r^4 / 8R^3 moved by z_mm (its poles are the sphere's heights: near it, and as smooth).
/// `weights`: rational, with weights that differ by a tenth.
inline std::shared_ptr<cad_import::BSplineSurface> bspline_cap(double radius_mm, double width_mm, int poles,
                                                               double z_mm, double orientation,
                                                               int degree = 3, bool rational = false) {
  cad_import::BSplineData data;
  data.degree_u = data.degree_v = degree;
  data.pole_count_u = data.pole_count_v = poles;
  const int spans = poles - degree;
  for (int i = 0; i < poles + degree + 1; ++i)
    data.knots_u.push_back(width_mm * (double(std::clamp(i - degree, 0, spans)) / spans - 0.5));
  data.knots_v = data.knots_u;
  const auto greville = [&](int i) {  // poles here make u = x
    double sum = 0;
    for (int k = 1; k <= degree; ++k) sum += data.knots_u[std::size_t(i + k)] / degree;
    return sum;
  };
  for (int i = 0; i < poles; ++i)
    for (int j = 0; j < poles; ++j) {
      const double x = greville(i), y = greville(j), r2 = x * x + y * y,
                   c = radius_mm == 0 ? 0 : 1 / radius_mm;
      data.poles.emplace_back(x, y, z_mm - 0.5 * c * r2 - 0.125 * c * c * c * r2 * r2);
      if (rational) data.weights.push_back(1 + 0.1 * std::sin(i + 2.0 * j));
    }
  return std::make_shared<cad_import::BSplineSurface>(data, orientation);
}

/// What bspline_lens() makes: see spherical_lens() for the frame and the signs.
struct BSplineLensSpec {
  double front_radius_mm = 120, back_radius_mm = 90, thickness_mm = 3, width_mm = 70;
  int poles = 16, degree = 3;
  bool rational = false;
  double trim_radius_mm = 0;  ///< 0: square
  int per_side = 33;          ///< mesh vertices
};

inline optics::Optic bspline_lens(const BSplineLensSpec& s) {
  const auto side = [&](double radius, double z, double orientation) {
    auto optic =
        rectangular_mirror(bspline_cap(radius, s.width_mm, s.poles, z, orientation, s.degree, s.rational),
                           s.width_mm, s.width_mm, s.per_side, s.per_side);
    if (s.trim_radius_mm > 0) optic.faces[0].trim = std::make_shared<RoundTrim>(s.trim_radius_mm);
    return optic;
  };
  auto lens = side(s.front_radius_mm, 0, 1);
  auto back = side(s.back_radius_mm, -s.thickness_mm, -1);
  for (auto& triangle : back.mesh.triangles) {  // counter-clockwise as seen from -z
    std::swap(triangle.vertices[1], triangle.vertices[2]);
    std::swap(triangle.uv[1], triangle.uv[2]);
  }
  lens.name = "B-spline lens";
  lens.kind = optics::OpticKind::lens;
  lens.back = {std::move(back.faces), std::move(back.mesh)};
  lens.medium = optics::constant_medium(1.586);
  return lens;
}

}  // namespace catoptra::test
