#include "cad_import/exact_surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace catoptra::cad_import {
namespace {

constexpr double kDegenerate = 1e-12;  // relative area below which du x dv has no direction
constexpr double kInside = 1e-4;       // share of the way to the domain's centre at which a limit is taken

glm::dvec2 to_centre(const ParameterDomain& d, double u, double v) {
  return {0.5 * (d.u_min + d.u_max) - u, 0.5 * (d.v_min + d.v_max) - v};
}

bool is_degenerate(const SurfaceDerivatives& s) {
  return glm::length(glm::cross(s.du, s.dv)) <= kDegenerate * (glm::dot(s.du, s.du) + glm::dot(s.dv, s.dv));
}

}  // namespace

glm::dvec3 ExactSurface::unit_normal(double u, double v) const {
  const SurfaceFrame f = d1(u, v);
  const glm::dvec3 n = glm::cross(f.du, f.dv);
  const double length = glm::length(n);
  const double scale = glm::dot(f.du, f.du) + glm::dot(f.dv, f.dv);
  if (length > kDegenerate * scale && length > 0) return n * (orientation() / length);
  // A pole. The limit of du x dv on the way to the domain's centre is its derivative along that way.
  const glm::dvec2 way = to_centre(domain(), u, v);
  const SurfaceDerivatives s = d2(u, v);
  const glm::dvec3 limit = way.x * (glm::cross(s.duu, s.dv) + glm::cross(s.du, s.duv)) +
                           way.y * (glm::cross(s.duv, s.dv) + glm::cross(s.du, s.dvv));
  if (glm::length(limit) > kDegenerate * scale) return glm::normalize(limit) * orientation();
  // Degenerate to second order (the tip of a collapsed patch): from a little way inside.
  const SurfaceFrame g = d1(u + kInside * way.x, v + kInside * way.y);
  const glm::dvec3 m = glm::cross(g.du, g.dv);
  const double m_length = glm::length(m);
  return m_length > 0 ? m * (orientation() / m_length) : glm::dvec3(0, 0, 1);
}

PrincipalCurvatures ExactSurface::principal_curvatures(double u, double v) const {
  SurfaceDerivatives s = d2(u, v);
  if (is_degenerate(s)) {
    const glm::dvec2 way = to_centre(domain(), u, v);
    u += kInside * way.x;
    v += kInside * way.y;
    s = d2(u, v);
    if (is_degenerate(s)) return {};  // a surface without area
  }
  const glm::dvec3 n = unit_normal(u, v);
  // Orthonormal tangent frame: e1 along du.
  const glm::dvec3 e1 = glm::normalize(s.du);
  const glm::dvec3 e2 = glm::cross(n, e1);
  // First fundamental form in (e1, e2): du = a e1, dv = b e1 + c e2. Second form with the sign of the header.
  const double a = glm::dot(s.du, e1), b = glm::dot(s.dv, e1), c = glm::dot(s.dv, e2);
  const double l = -glm::dot(s.duu, n), m = -glm::dot(s.duv, n), k = -glm::dot(s.dvv, n);
  // Shape operator in the orthonormal frame.
  const double s11 = l / (a * a);
  const double s12 = (m - s11 * a * b) / (a * c);
  const double s22 = (k - s11 * b * b - 2 * s12 * b * c) / (c * c);
  const double mean = 0.5 * (s11 + s22);
  const double half = 0.5 * (s11 - s22);
  const double root = std::hypot(half, s12);
  const double angle = root > 0 ? 0.5 * std::atan2(s12, half) : 0.0;
  const glm::dvec3 direction1 = std::cos(angle) * e1 + std::sin(angle) * e2;
  return {mean + root, mean - root, direction1, glm::cross(n, direction1)};
}

}  // namespace catoptra::cad_import
