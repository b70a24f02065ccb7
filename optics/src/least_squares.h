// Small linear least-squares problems by normal equations.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptra::optics {

/// Minimises sum weight (row . x - right)^2 over x. Directions that the rows leave open stay near 0: a ridge
/// of 1e-12 of the largest diagonal entry is added, far below the 1e-8 to which normal equations of scaled
/// unknowns are good.
template <int N>
class LeastSquares {
 public:
  using Vector = std::array<double, N>;

  void add(const Vector& row, double right, double weight = 1) {
    for (int i = 0; i < N; ++i) {
      const double w = weight * row[i];
      for (int j = 0; j <= i; ++j) matrix_[i][j] += w * row[j];
      right_[i] += w * right;
    }
  }

  [[nodiscard]] Vector solve() const {
    double largest = 0;
    for (int i = 0; i < N; ++i) largest = std::max(largest, matrix_[i][i]);
    if (!(largest > 0)) return Vector{};
    // Cholesky: matrix = L L^T.
    std::array<Vector, N> lower{};
    for (int i = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) {
        double sum = matrix_[i][j] + (i == j ? 1e-12 * largest : 0.0);
        for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
        lower[i][j] = i == j ? std::sqrt(std::max(sum, 1e-14 * largest)) : sum / lower[j][j];
      }
    Vector x = right_;
    for (int i = 0; i < N; ++i) {
      for (int k = 0; k < i; ++k) x[i] -= lower[i][k] * x[k];
      x[i] /= lower[i][i];
    }
    for (int i = N - 1; i >= 0; --i) {
      for (int k = i + 1; k < N; ++k) x[i] -= lower[k][i] * x[k];
      x[i] /= lower[i][i];
    }
    return x;
  }

 private:
  std::array<Vector, N> matrix_{};  // lower triangle
  Vector right_{};
};

}  // namespace catoptra::optics
