// B-spline and Bezier surfaces, rational or not, by their own evaluator.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "cad_import/exact_surface.h"

namespace catoptra::cad_import {

/// A B-spline surface as files describe it. Source: Piegl and Tiller, The NURBS Book, 3.4 and 4.4.
struct BSplineData {
  int degree_u = 0, degree_v = 0;
  int pole_count_u = 0, pole_count_v = 0;
  std::vector<double> knots_u,
      knots_v;  ///< flat (multiplicities written out): pole count + degree + 1 values, rising
  std::vector<glm::dvec3> poles;      ///< mm, pole (i, j) at i * pole_count_v + j
  std::vector<double> weights;        ///< one per pole, > 0; empty where the surface is not rational
  double period_u = 0, period_v = 0;  ///< > 0: a parameter is first brought into the domain by whole periods
};

/// Piecewise polynomial form of one parameter: the spans and the rule that finds the span of a parameter.
class SpanAxis {
 public:
  SpanAxis() = default;
  /// `knots`: flat; `degree` >= 1. Throws Error where the knots fall or leave no span.
  SpanAxis(std::span<const double> knots, int degree, double period);

  [[nodiscard]] double begin() const { return breaks_.front(); }
  [[nodiscard]] double end() const { return breaks_.back(); }
  [[nodiscard]] double period() const { return period_; }
  [[nodiscard]] int span_count() const { return int(breaks_.size()) - 1; }
  /// Index of the first pole that span `s` depends on.
  [[nodiscard]] int first_pole(int s) const { return first_pole_[s]; }
  [[nodiscard]] double span_begin(int s) const { return breaks_[s]; }
  [[nodiscard]] double span_end(int s) const { return breaks_[s + 1]; }

  /// Span and local parameter, -1 at the span's begin and +1 at its end; d local / d t is `rate`.
  struct Position {
    int span;
    double local;
    double rate;
  };
  /// Outside [begin, end] the end spans continue (after whole periods are taken off where there is a period).
  [[nodiscard]] Position locate(double t) const;

 private:
  struct Span {
    double upper;         // where the next one begins; not a number for the last
    double middle, rate;  // centre, 2 / length
  };
  friend class BSplineSurface;
  [[nodiscard]] Position locate_inline(double t) const;

  std::vector<double> breaks_;  // distinct knots within the domain
  std::vector<Span> spans_;
  std::vector<int> first_pole_;       // per span
  std::vector<std::int32_t> bucket_;  // even buckets over the domain -> the span a little before their begin
  double bucket_rate_ = 0;
  double period_ = 0;
};

/// The surface in model coordinates. Set-up turns every span into one block of polynomial coefficients, so
/// that an evaluation is a span look-up and two nested Horner schemes (design: limits of de Boor are its
/// repeated divisions).
///
/// Layout, open for evaluation of many points at once: block of span (su, sv) at `(su * span_count_v + sv) *
/// coefficients_per_span()`; within it coefficient (i, j) of local_u^i local_v^j at i * (degree_v + 1) + j,
/// each four doubles x, y, z, w. Rational: homogeneous (w x, w y, w z, w); else w is 0. x, y, z are relative
/// to origin(). Above degree kMaxPowerDegree the block holds Bezier points instead (power form would lose
/// digits).
class BSplineSurface final : public ExactSurface {
 public:
  static constexpr int kMaxPowerDegree = 5;
  static constexpr int kMaxDegree = 25;

  /// `orientation`: see ExactSurface. `kind`: bezier or bspline. Throws Error where counts, degrees or
  /// weights do not fit.
  BSplineSurface(const BSplineData& data, double orientation, SurfaceKind kind = SurfaceKind::bspline);

  [[nodiscard]] SurfaceKind kind() const override { return kind_; }
  [[nodiscard]] ParameterDomain domain() const override { return domain_; }
  [[nodiscard]] double orientation() const override { return orientation_; }
  [[nodiscard]] glm::dvec3 point(double u, double v) const override;
  [[nodiscard]] SurfaceFrame d1(double u, double v) const override;
  [[nodiscard]] SurfaceDerivatives d2(double u, double v) const override;
  [[nodiscard]] const BSplineSurface* as_bspline() const override { return this; }

  /// The same surface whose domain starts elsewhere (periodic directions only).
  void set_domain(const ParameterDomain& domain) { domain_ = domain; }

  [[nodiscard]] int degree_u() const { return degree_u_; }
  [[nodiscard]] int degree_v() const { return degree_v_; }
  [[nodiscard]] bool rational() const { return rational_; }
  [[nodiscard]] bool power_basis() const { return power_basis_; }
  [[nodiscard]] const SpanAxis& axis_u() const { return axis_u_; }
  [[nodiscard]] const SpanAxis& axis_v() const { return axis_v_; }
  [[nodiscard]] std::size_t coefficients_per_span() const {
    return std::size_t(degree_u_ + 1) * (degree_v_ + 1);
  }
  [[nodiscard]] std::span<const glm::dvec4> coefficients() const { return coefficients_; }
  [[nodiscard]] const glm::dvec3& origin() const { return origin_; }

 private:
  struct Homogeneous;
  template <int Order, int P, int Q>
  [[nodiscard]] Homogeneous evaluate_power(const glm::dvec4* block, double x, double y) const;
  template <int Order>
  [[nodiscard]] Homogeneous evaluate_bezier(const glm::dvec4* block, double x, double y) const;
  template <int Order>
  [[nodiscard]] Homogeneous evaluate_block(const glm::dvec4* block, double x, double y) const;
  template <int Order>
  [[nodiscard]] Homogeneous evaluate(double u, double v) const;
  void build_blocks(const BSplineData& data);

  SurfaceKind kind_;
  int degree_u_, degree_v_;
  bool rational_, power_basis_;
  double orientation_;
  SpanAxis axis_u_, axis_v_;
  ParameterDomain domain_;
  glm::dvec3 origin_{0};
  std::vector<glm::dvec4> coefficients_;
};

}  // namespace catoptra::cad_import
