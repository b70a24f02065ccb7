// Faces made by hand: closed-form surfaces with borders of lines and arcs in (u, v).
#pragma once

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "cad_import/cad_model.h"
#include "tests/support/analytic_optic.h"

namespace catoptra::test {

using SurfacePtr = std::shared_ptr<const cad_import::ExactSurface>;

/// A curve in (u, v) given as a function of t in [0, 1].
class FunctionCurve : public cad_import::TrimCurve {
 public:
  FunctionCurve(SurfacePtr surface, std::function<glm::dvec2(double)> uv)
      : surface_(std::move(surface)), uv_(std::move(uv)) {}
  glm::dvec2 uv(double t) const override { return uv_(t); }
  glm::dvec3 point(double t) const override {
    const glm::dvec2 p = uv_(t);
    return surface_->point(p.x, p.y);
  }

 private:
  SurfacePtr surface_;
  std::function<glm::dvec2(double)> uv_;
};

inline cad_import::EdgeUse edge(const SurfacePtr& surface, int number, int start, int end,
                                std::function<glm::dvec2(double)> uv) {
  cad_import::EdgeUse use;
  use.edge = number;
  use.start_vertex = start;
  use.end_vertex = end;
  use.curve = std::make_shared<FunctionCurve>(surface, std::move(uv));
  return use;
}

inline cad_import::EdgeUse line(const SurfacePtr& surface, int number, int start, int end, glm::dvec2 a,
                                glm::dvec2 b) {
  return edge(surface, number, start, end, [a, b](double t) { return (1 - t) * a + t * b; });
}

/// The same edge as the other face sees it: backwards.
inline cad_import::EdgeUse backwards(const cad_import::EdgeUse& use, const SurfacePtr& surface,
                                     std::function<glm::dvec2(double)> uv) {
  cad_import::EdgeUse other = edge(surface, use.edge, use.end_vertex, use.start_vertex, std::move(uv));
  other.reversed = !use.reversed;
  return other;
}

/// A closed polygon of straight lines in (u, v); edges and vertices are numbered from `first_number` on.
inline cad_import::TrimLoop polygon_loop(const SurfacePtr& surface, const std::vector<glm::dvec2>& corners,
                                         int first_number) {
  cad_import::TrimLoop loop;
  const int n = static_cast<int>(corners.size());
  for (int k = 0; k < n; ++k)
    loop.edges.push_back(line(surface, first_number + k, first_number + k, first_number + (k + 1) % n,
                              corners[static_cast<std::size_t>(k)],
                              corners[static_cast<std::size_t>((k + 1) % n)]));
  return loop;
}

/// A circle as one closed edge; clockwise for a hole.
inline cad_import::TrimLoop circle_loop(const SurfacePtr& surface, glm::dvec2 centre, double radius,
                                        int number, bool hole) {
  const double sense = hole ? -1 : 1;
  cad_import::TrimLoop loop;
  loop.outer = !hole;
  loop.edges.push_back(edge(surface, number, number, number, [=](double t) {
    const double a = sense * 2 * std::numbers::pi * t;
    return centre + radius * glm::dvec2(std::cos(a), std::sin(a));
  }));
  return loop;
}

/// |u| <= w / 2, |v| <= h / 2 with corners rounded to `radius`.
inline cad_import::TrimLoop rounded_loop(const SurfacePtr& surface, double width, double height,
                                         double radius, int first_number) {
  const double x = width / 2 - radius, y = height / 2 - radius;
  const std::vector<glm::dvec2> centre{{x, -y}, {x, y}, {-x, y}, {-x, -y}};
  cad_import::TrimLoop loop;
  const auto on_arc = [=](int corner, double t) {
    const double a = (corner - 1 + t) * std::numbers::pi / 2;
    return centre[static_cast<std::size_t>(corner)] + radius * glm::dvec2(std::cos(a), std::sin(a));
  };
  for (int corner = 0; corner < 4; ++corner) {
    const int n = first_number + 2 * corner, last = first_number + 7;
    loop.edges.push_back(
        line(surface, n, corner == 0 ? last : n - 1, n, on_arc((corner + 3) % 4, 1), on_arc(corner, 0)));
    loop.edges.push_back(edge(surface, n + 1, n, n + 1, [=](double t) { return on_arc(corner, t); }));
  }
  return loop;
}

inline cad_import::Face make_face(SurfacePtr surface, std::vector<cad_import::TrimLoop> loops) {
  cad_import::Face face;
  face.id = "test";
  face.surface = std::move(surface);
  face.loops = std::move(loops);
  return face;
}

/// Longitude u in [0, 2 pi], latitude v in [-pi / 2, pi / 2] on a sphere around the origin; normal outwards.
class SphereSurface : public cad_import::ExactSurface {
 public:
  explicit SphereSurface(double radius) : radius_(radius) {}
  cad_import::SurfaceKind kind() const override { return cad_import::SurfaceKind::sphere; }
  cad_import::ParameterDomain domain() const override {
    const double pi = std::numbers::pi;
    return {0, 2 * pi, -pi / 2, pi / 2, 2 * pi, 0};
  }
  double orientation() const override { return 1; }
  glm::dvec3 point(double u, double v) const override { return radius_ * out(u, v); }
  cad_import::SurfaceFrame d1(double u, double v) const override {
    const auto d = d2(u, v);
    return {d.point, d.du, d.dv};
  }
  cad_import::SurfaceDerivatives d2(double u, double v) const override {
    const double cu = std::cos(u), su = std::sin(u), cv = std::cos(v), sv = std::sin(v);
    return {radius_ * out(u, v),
            radius_ * glm::dvec3(-su * cv, cu * cv, 0),
            radius_ * glm::dvec3(-cu * sv, -su * sv, cv),
            radius_ * glm::dvec3(-cu * cv, -su * cv, 0),
            radius_ * glm::dvec3(su * sv, -cu * sv, 0),
            radius_ * glm::dvec3(-cu * cv, -su * cv, -sv)};
  }

 private:
  static glm::dvec3 out(double u, double v) {
    return {std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v)};
  }
  double radius_;
};

/// Angle u in [0, 2 pi], height v in [0, h] on a cylinder about z; normal outwards, or inwards where
/// `inside_out`.
class CylinderSurface : public cad_import::ExactSurface {
 public:
  CylinderSurface(double radius, double height, bool inside_out = false)
      : radius_(radius), height_(height), orientation_(inside_out ? -1 : 1) {}
  cad_import::SurfaceKind kind() const override { return cad_import::SurfaceKind::cylinder; }
  cad_import::ParameterDomain domain() const override {
    return {0, 2 * std::numbers::pi, 0, height_, 2 * std::numbers::pi, 0};
  }
  double orientation() const override { return orientation_; }
  glm::dvec3 point(double u, double v) const override {
    return {radius_ * std::cos(u), radius_ * std::sin(u), v};
  }
  cad_import::SurfaceFrame d1(double u, double v) const override {
    return {point(u, v), {-radius_ * std::sin(u), radius_ * std::cos(u), 0}, {0, 0, 1}};
  }
  cad_import::SurfaceDerivatives d2(double u, double v) const override {
    const auto f = d1(u, v);
    return {f.point, f.du, f.dv, {-radius_ * std::cos(u), -radius_ * std::sin(u), 0}, {}, {}};
  }

 private:
  double radius_, height_, orientation_;
};

}  // namespace catoptra::test
