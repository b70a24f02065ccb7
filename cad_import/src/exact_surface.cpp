#include "cad_import/exact_surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::cad_import {
namespace {

constexpr double kDegenerate = 1e-12;  // relative area below which du x dv has no direction

}  // namespace

glm::dvec3 ExactSurface::unit_normal(double u, double v) const {
  const SurfaceFrame f = d1(u, v);
  const glm::dvec3 n = glm::cross(f.du, f.dv);
  const double length = glm::length(n);
  const double scale = glm::dot(f.du, f.du) + glm::dot(f.dv, f.dv);
  if (length > kDegenerate * scale && length > 0) return n * (orientation() / length);
  // A pole: take the limit from a little way inside the domain.
  const ParameterDomain d = domain();
  const double step = 1e-6;
  const double u_in = u + step * (0.5 * (d.u_min + d.u_max) - u);
  const double v_in = v + step * (0.5 * (d.v_min + d.v_max) - v);
  const SurfaceFrame g = d1(u_in, v_in);
  const glm::dvec3 m = glm::cross(g.du, g.dv);
  const double m_length = glm::length(m);
  return m_length > 0 ? m * (orientation() / m_length) : glm::dvec3(0, 0, 1);
}

PrincipalCurvatures ExactSurface::principal_curvatures(double u, double v) const {
  SurfaceDerivatives s = d2(u, v);
  glm::dvec3 n = unit_normal(u, v);
  if (glm::length(glm::cross(s.du, s.dv)) <= kDegenerate * (glm::dot(s.du, s.du) + glm::dot(s.dv, s.dv))) {
    const ParameterDomain d = domain();
    s = d2(u + 1e-4 * (0.5 * (d.u_min + d.u_max) - u), v + 1e-4 * (0.5 * (d.v_min + d.v_max) - v));
  }
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
