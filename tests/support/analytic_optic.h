// Optics with a closed form, free of any CAD kernel: conics of revolution as height fields.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "cad_import/exact_surface.h"
#include "optics/optic.h"

namespace catoptra::test {

/// z(x, y) = -c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)), u = x, v = y, normal towards +z.
/// c = 1/R > 0: convex towards +z (convex mirror seen from +z), c < 0: concave, c = 0: plane. k: 0 sphere, -1
/// paraboloid.
class ConicSurface : public cad_import::ExactSurface {
 public:
  ConicSurface(double curvature, double conic, double half_width_mm, double half_height_mm)
      : c_(curvature), k_(conic), half_width_(half_width_mm), half_height_(half_height_mm) {}

  cad_import::SurfaceKind kind() const override { return cad_import::SurfaceKind::other; }
  cad_import::ParameterDomain domain() const override {
    return {-half_width_, half_width_, -half_height_, half_height_, 0, 0};
  }
  double orientation() const override { return 1; }

  glm::dvec3 point(double u, double v) const override {
    const double r2 = u * u + v * v, root = std::sqrt(std::max(0.0, 1 - (1 + k_) * c_ * c_ * r2));
    return {u, v, -c_ * r2 / (1 + root)};
  }
  cad_import::SurfaceFrame d1(double u, double v) const override {
    const double root = std::sqrt(std::max(1e-12, 1 - (1 + k_) * c_ * c_ * (u * u + v * v)));
    return {point(u, v), {1, 0, -c_ * u / root}, {0, 1, -c_ * v / root}};
  }
  cad_import::SurfaceDerivatives d2(double u, double v) const override {
    const double e = (1 + k_) * c_ * c_, root = std::sqrt(std::max(1e-12, 1 - e * (u * u + v * v)));
    const auto f = d1(u, v);
    const double r3 = root * root * root;
    return {f.point,
            f.du,
            f.dv,
            {0, 0, -c_ * (1 / root + e * u * u / r3)},
            {0, 0, -c_ * e * u * v / r3},
            {0, 0, -c_ * (1 / root + e * v * v / r3)}};
  }

 private:
  double c_, k_, half_width_, half_height_;
};

/// z(x, y) = -(k1 u^2 + k2 v^2) / 2 with (u, v) turned by `angle_rad` from (x, y): at the origin the
/// principal curvatures are k1 and k2 (1/mm, convex towards +z positive) along the turned axes. Cylinders (k2
/// = 0) and saddles (k1 k2 < 0).
class TwoCurvatureSurface : public cad_import::ExactSurface {
 public:
  TwoCurvatureSurface(double k1, double k2, double angle_rad, double half_width_mm, double half_height_mm)
      : half_width_(half_width_mm), half_height_(half_height_mm) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    xx_ = -(k1 * c * c + k2 * s * s);
    xy_ = -(k1 - k2) * c * s;
    yy_ = -(k1 * s * s + k2 * c * c);
  }

  cad_import::SurfaceKind kind() const override { return cad_import::SurfaceKind::other; }
  cad_import::ParameterDomain domain() const override {
    return {-half_width_, half_width_, -half_height_, half_height_, 0, 0};
  }
  double orientation() const override { return 1; }
  glm::dvec3 point(double u, double v) const override {
    return {u, v, 0.5 * (xx_ * u * u + yy_ * v * v) + xy_ * u * v};
  }
  cad_import::SurfaceFrame d1(double u, double v) const override {
    return {point(u, v), {1, 0, xx_ * u + xy_ * v}, {0, 1, xy_ * u + yy_ * v}};
  }
  cad_import::SurfaceDerivatives d2(double u, double v) const override {
    const auto f = d1(u, v);
    return {f.point, f.du, f.dv, {0, 0, xx_}, {0, 0, xy_}, {0, 0, yy_}};
  }

 private:
  double half_width_, half_height_, xx_, xy_, yy_;
};

/// The rectangle |u| <= w/2, |v| <= h/2.
class RectangleTrim : public cad_import::FaceTrim {
 public:
  RectangleTrim(double half_width, double half_height) : w_(half_width), h_(half_height) {}
  bool contains(double u, double v) const override {
    return std::abs(u) <= w_ + 1e-9 && std::abs(v) <= h_ + 1e-9;
  }

 private:
  double w_, h_;
};

/// A rectangular mirror of `columns` x `rows` vertices around the origin, facing +z, on a surface with u = x,
/// v = y.
inline optics::Optic rectangular_mirror(std::shared_ptr<const cad_import::ExactSurface> surface,
                                        double width_mm, double height_mm, int columns, int rows) {
  optics::Optic optic;
  optic.name = "test mirror";
  cad_import::Face face;
  face.id = "test";
  face.surface = surface;
  face.trim = std::make_shared<RectangleTrim>(width_mm / 2, height_mm / 2);
  optic.faces.push_back(face);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const glm::dvec2 uv{width_mm * (double(i) / (columns - 1) - 0.5),
                          height_mm * (double(j) / (rows - 1) - 0.5)};
      const auto curvature = surface->principal_curvatures(uv.x, uv.y);
      optic.mesh.vertices.push_back({surface->point(uv.x, uv.y), surface->unit_normal(uv.x, uv.y),
                                     curvature.k1, curvature.k2, curvature.direction1, 0, uv});
    }
  const auto add = [&](int a, int b, int c) {
    auto& v = optic.mesh.vertices;
    optic.mesh.triangles.push_back(
        {{std::uint32_t(a), std::uint32_t(b), std::uint32_t(c)}, 0, {v[a].uv, v[b].uv, v[c].uv}});
  };
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) {
      const int a = j * columns + i;
      add(a, a + 1, a + columns + 1);
      add(a, a + columns + 1, a + columns);
    }
  return optic;
}

/// The same on a conic of revolution. radius_mm: 0 plane, > 0 convex, < 0 concave.
inline optics::Optic conic_mirror(double radius_mm, double conic, double width_mm, double height_mm,
                                  int columns, int rows) {
  auto optic = rectangular_mirror(
      std::make_shared<ConicSurface>(radius_mm == 0 ? 0 : 1 / radius_mm, conic, width_mm / 2, height_mm / 2),
      width_mm, height_mm, columns, rows);
  optic.faces[0].planar = radius_mm == 0;
  return optic;
}

}  // namespace catoptra::test
