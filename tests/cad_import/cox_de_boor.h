// B-spline surfaces by the definition, in extended precision: slow, and independent of both evaluators under
// test.
#pragma once

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "cad_import/bspline_surface.h"

namespace catoptra::test {

/// Basis function i of `degree` or its derivative, by the recurrence. Source: Piegl and Tiller, eqs. 2.5
/// and 2.7.
inline long double basis(const std::vector<double>& t, int i, int degree, int derivative, long double x,
                         int span) {
  if (degree == 0) return derivative == 0 && i == span ? 1.0L : 0.0L;
  const long double left = static_cast<long double>(t[i + degree]) - t[i];
  const long double right = static_cast<long double>(t[i + degree + 1]) - t[i + 1];
  if (derivative > 0) {
    const long double a = left > 0 ? basis(t, i, degree - 1, derivative - 1, x, span) / left : 0;
    const long double b = right > 0 ? basis(t, i + 1, degree - 1, derivative - 1, x, span) / right : 0;
    return degree * (a - b);
  }
  const long double a = left > 0 ? (x - t[i]) / left * basis(t, i, degree - 1, 0, x, span) : 0;
  const long double b =
      right > 0 ? (t[i + degree + 1] - x) / right * basis(t, i + 1, degree - 1, 0, x, span) : 0;
  return a + b;
}

/// Point and derivatives of a surface without period.
inline cad_import::SurfaceDerivatives cox_de_boor(const cad_import::BSplineData& s, double u, double v) {
  using Vector = std::array<long double, 4>;
  const auto span_of = [](const std::vector<double>& t, int degree, int poles, double x) {
    int span = degree;
    while (span + 1 < poles && x >= t[span + 1]) ++span;
    while (!(t[span + 1] > t[span])) --span;
    return span;
  };
  const int su = span_of(s.knots_u, s.degree_u, s.pole_count_u, u),
            sv = span_of(s.knots_v, s.degree_v, s.pole_count_v, v);
  const auto sum = [&](int du, int dv) {
    Vector total{};
    for (int i = su - s.degree_u; i <= su; ++i) {
      const long double bu = basis(s.knots_u, i, s.degree_u, du, u, su);
      for (int j = sv - s.degree_v; j <= sv; ++j) {
        const std::size_t at = std::size_t(i) * s.pole_count_v + j;
        const long double w =
            (s.weights.empty() ? 1.0L : s.weights[at]) * bu * basis(s.knots_v, j, s.degree_v, dv, v, sv);
        for (int axis = 0; axis < 3; ++axis) total[axis] += w * s.poles[at][axis];
        total[3] += w;
      }
    }
    return total;
  };
  // Quotient rule, Piegl and Tiller, eq. 4.20.
  const Vector p = sum(0, 0), pu = sum(1, 0), pv = sum(0, 1), puu = sum(2, 0), puv = sum(1, 1),
               pvv = sum(0, 2);
  cad_import::SurfaceDerivatives d{};
  for (int axis = 0; axis < 3; ++axis) {
    const long double w = p[3], x = p[axis] / w;
    const long double xu = (pu[axis] - pu[3] * x) / w, xv = (pv[axis] - pv[3] * x) / w;
    d.point[axis] = double(x);
    d.du[axis] = double(xu);
    d.dv[axis] = double(xv);
    d.duu[axis] = double((puu[axis] - 2 * pu[3] * xu - puu[3] * x) / w);
    d.duv[axis] = double((puv[axis] - pu[3] * xv - pv[3] * xu - puv[3] * x) / w);
    d.dvv[axis] = double((pvv[axis] - 2 * pv[3] * xv - pvv[3] * x) / w);
  }
  return d;
}

}  // namespace catoptra::test
