#include "cad_import/src/span_matrix.h"

#include <cmath>

namespace catoptra::cad_import {
namespace {

// Bezier point k of the span as a combination of its poles: the blossom at (begin repeated degree - k times,
// end k times), by de Boor's recurrence run on the unit vectors.
std::vector<double> blossom_row(std::span<const double> t, int degree, int first_pole, int k) {
  const int n = degree + 1;
  const double begin = t[first_pole + degree], end = t[first_pole + degree + 1];
  std::vector<double> d(std::size_t(n) * n, 0.0);  // d[i]: combination that makes the i-th de Boor point
  for (int i = 0; i < n; ++i) d[std::size_t(i) * n + i] = 1;
  for (int r = 1; r <= degree; ++r) {
    const double x = r <= degree - k ? begin : end;
    for (int i = degree; i >= r; --i) {
      const double low = t[first_pole + i], high = t[first_pole + i + degree + 1 - r];
      const double a = (x - low) / (high - low);
      for (int c = 0; c < n; ++c) {
        double& value = d[std::size_t(i) * n + c];
        value = (1 - a) * d[std::size_t(i - 1) * n + c] + a * value;
      }
    }
  }
  return {d.end() - n, d.end()};
}

// Coefficients of x^m in the Bernstein polynomial k of `degree`, x = 2 s - 1: binomial * ((1+x)/2)^k
// ((1-x)/2)^(n-k).
std::vector<double> bernstein_in_powers(int degree, int k) {
  std::vector<double> p{1.0};
  const auto multiply = [&p](double sign) {  // by (1 + sign x) / 2
    p.push_back(0);
    for (std::size_t m = p.size() - 1; m > 0; --m) p[m] = 0.5 * (p[m] + sign * p[m - 1]);
    p[0] *= 0.5;
  };
  for (int i = 0; i < k; ++i) multiply(+1);
  for (int i = k; i < degree; ++i) multiply(-1);
  double binomial = 1;
  for (int i = 1; i <= k; ++i) binomial = binomial * (degree - k + i) / i;
  for (double& c : p) c *= binomial;
  return p;
}

}  // namespace

SpanMatrix span_matrix(std::span<const double> flat_knots, int degree, int first_pole, bool power) {
  const int n = degree + 1;
  SpanMatrix result{n, std::vector<double>(std::size_t(n) * n, 0.0)};
  for (int k = 0; k < n; ++k) {
    const std::vector<double> row = blossom_row(flat_knots, degree, first_pole, k);
    if (!power) {
      for (int c = 0; c < n; ++c) result.values[std::size_t(k) * n + c] = row[c];
      continue;
    }
    const std::vector<double> coefficient = bernstein_in_powers(degree, k);
    for (int m = 0; m < n; ++m)
      for (int c = 0; c < n; ++c) result.values[std::size_t(m) * n + c] += coefficient[m] * row[c];
  }
  return result;
}

// Degree by degree: B(n) from B(n - 1) with s = (1 + x) / 2; derivatives are differences of the two degrees
// below.
BernsteinBasis::BernsteinBasis(int degree, double x) {
  const double s = 0.5 * (1 + x), r = 0.5 * (1 - x);
  const auto raise = [s, r](const auto& from, auto& to, int n) {  // from the last, so that `to` may be `from`
    to[n] = s * from[n - 1];
    for (int k = n - 1; k > 0; --k) to[k] = r * from[k] + s * from[k - 1];
    to[0] = r * from[0];
  };
  std::array<double, BSplineSurface::kMaxDegree + 1> one_less{}, two_less{};
  two_less[0] = one_less[0] = 1;
  for (int n = 1; n <= degree - 2; ++n) raise(two_less, two_less, n);
  if (degree >= 2) raise(two_less, one_less, degree - 1);
  raise(one_less, value, degree);
  // d/dx = 1/2 d/ds; beyond a basis's own degree its entries are 0.
  const auto at = [](const auto& basis, int k) { return k >= 0 ? basis[k] : 0.0; };
  for (int k = 0; k <= degree; ++k) first[k] = 0.5 * degree * (at(one_less, k - 1) - one_less[k]);
  for (int k = 0; degree >= 2 && k <= degree; ++k)
    second[k] = 0.25 * degree * (degree - 1) * (at(two_less, k - 2) - 2 * at(two_less, k - 1) + two_less[k]);
}

}  // namespace catoptra::cad_import
