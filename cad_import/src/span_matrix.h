// One span of a B-spline as a polynomial: the matrix that turns its poles into coefficients, and the
// Bernstein basis.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "cad_import/bspline_surface.h"

namespace catoptra::cad_import {

/// (degree + 1) x (degree + 1), row = coefficient, column = pole of the span.
struct SpanMatrix {
  int size = 0;
  std::vector<double> values;
  [[nodiscard]] double at(int row, int column) const { return values[std::size_t(row) * size + column]; }
};

/// The matrix of the span whose first pole is `first_pole` in a flat knot vector. `power`: coefficients of
/// x^k, x = -1 at the span's begin and +1 at its end; else Bezier points. Source: Piegl and Tiller, 5.3 (knot
/// insertion up to full multiplicity, here by blossoming: every step is a convex combination, so no digit is
/// lost).
[[nodiscard]] SpanMatrix span_matrix(std::span<const double> flat_knots, int degree, int first_pole,
                                     bool power);

/// Bernstein polynomials of `degree` at x in [-1, 1] (or beyond) and their first and second derivatives by x.
struct BernsteinBasis {
  BernsteinBasis(int degree, double x);
  std::array<double, BSplineSurface::kMaxDegree + 1> value{}, first{}, second{};
};

}  // namespace catoptra::cad_import
