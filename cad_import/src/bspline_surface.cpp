#include "cad_import/bspline_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "cad_import/error.h"
#include "cad_import/src/lanes.h"
#include "cad_import/src/span_matrix.h"

namespace catoptra::cad_import {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kMostBuckets = 64;  // per span: spans more uneven than that cost a step or two more
constexpr double kRounding = 1e-14;  // share of the domain: above the rounding of a bucket's begin

void check(const BSplineData& d) {
  const auto fail = [](const std::string& reason) { throw Error("", "B-spline surface", reason); };
  for (const int degree : {d.degree_u, d.degree_v})
    if (degree < 1 || degree > BSplineSurface::kMaxDegree) fail("degree " + std::to_string(degree));
  if (d.pole_count_u <= d.degree_u || d.pole_count_v <= d.degree_v) fail("fewer poles than its degree needs");
  const std::size_t count = std::size_t(d.pole_count_u) * d.pole_count_v;
  if (d.poles.size() != count) fail("the number of poles is not rows times columns");
  if (!d.weights.empty() && d.weights.size() != count) fail("not one weight per pole");
  if (std::ranges::any_of(d.weights, [](double w) { return !(w > 0); })) fail("a weight is not positive");
  if (d.knots_u.size() != std::size_t(d.pole_count_u + d.degree_u + 1) ||
      d.knots_v.size() != std::size_t(d.pole_count_v + d.degree_v + 1))
    fail("the number of knots is not poles + degree + 1");
}

glm::dvec3 vector(const Lanes& a) {
  return {a.xy[0], a.xy[1], a.zw[0]};
}

}  // namespace

// Homogeneous value and derivatives up to order 2 with respect to the local parameters.
struct BSplineSurface::Homogeneous {
  Lanes p, u, v, uu, uv, vv;
};

SpanAxis::SpanAxis(std::span<const double> knots, int degree, double period) : period_(period) {
  const int last = int(knots.size()) - degree - 1;
  if (!std::ranges::is_sorted(knots)) throw Error("", "B-spline", "knots fall");
  double shortest = kInfinite;
  for (int k = degree; k < last; ++k) {
    const double length = knots[k + 1] - knots[k];
    if (!(length > 0)) continue;  // a multiple knot
    breaks_.push_back(knots[k]);
    first_pole_.push_back(k - degree);
    spans_.push_back({knots[k + 1], 0.5 * (knots[k] + knots[k + 1]), 2 / length});
    shortest = std::min(shortest, length);
  }
  if (breaks_.empty()) throw Error("", "B-spline", "its knots leave no span");
  breaks_.push_back(knots[last]);
  spans_.back().upper = std::numeric_limits<double>::quiet_NaN();  // no comparison with it is true

  // Buckets shorter than the shortest span hold at most one break: then one comparison finds the span.
  const double most = kMostBuckets * double(span_count());
  const int buckets = int(std::clamp(std::ceil(2 * (end() - begin()) / shortest), 1.0, most));
  bucket_rate_ = buckets / (end() - begin());
  int s = 0;
  for (int b = 0; b < buckets; ++b) {
    // A little before the bucket's begin, as rounding may put a parameter just below it here.
    const double from_begin = (b - kRounding * buckets) / bucket_rate_;
    while (spans_[s].upper - begin() <= from_begin) ++s;
    bucket_.push_back(s);
  }
}

// Without branches that depend on t: at random parameters the processor would guess every other one wrong,
// which costs as much as the polynomials.
[[gnu::always_inline]] inline SpanAxis::Position SpanAxis::locate_inline(double t) const {
  if (period_ > 0 && !(t >= begin() && t <= end())) t -= period_ * std::floor((t - begin()) / period_);
  const double at = std::min(std::max(0.0, (t - begin()) * bucket_rate_), double(bucket_.size() - 1));
  int s = bucket_[std::size_t(std::int32_t(at))];
  s += int(t >= spans_[s].upper);
  while (t >= spans_[s].upper) ++s;  // only where a span is far shorter than the others
  const Span& span = spans_[s];
  return {s, (t - span.middle) * span.rate, span.rate};
}

SpanAxis::Position SpanAxis::locate(double t) const {
  return locate_inline(t);
}

BSplineSurface::BSplineSurface(const BSplineData& data, double orientation, SurfaceKind kind)
    : kind_(kind),
      degree_u_(data.degree_u),
      degree_v_(data.degree_v),
      rational_(!data.weights.empty()),
      power_basis_(std::max(data.degree_u, data.degree_v) <= kMaxPowerDegree),
      orientation_(orientation) {
  check(data);
  axis_u_ = SpanAxis(data.knots_u, degree_u_, data.period_u);
  axis_v_ = SpanAxis(data.knots_v, degree_v_, data.period_v);
  domain_ = {axis_u_.begin(), axis_u_.end(), axis_v_.begin(), axis_v_.end(), data.period_u, data.period_v};
  build_blocks(data);
}

// block = E_u * (poles of the span) * E_v^T with one small matrix E per span and direction.
void BSplineSurface::build_blocks(const BSplineData& data) {
  for (const glm::dvec3& pole : data.poles) origin_ += pole / double(data.poles.size());
  const auto matrices = [this](const SpanAxis& axis, std::span<const double> knots, int degree) {
    std::vector<SpanMatrix> result;
    for (int s = 0; s < axis.span_count(); ++s)
      result.push_back(span_matrix(knots, degree, axis.first_pole(s), power_basis_));
    return result;
  };
  const auto e_u = matrices(axis_u_, data.knots_u, degree_u_);
  const auto e_v = matrices(axis_v_, data.knots_v, degree_v_);
  const int nu = degree_u_ + 1, nv = degree_v_ + 1;
  coefficients_.reserve(e_u.size() * e_v.size() * coefficients_per_span());
  std::vector<glm::dvec4> half(coefficients_per_span());
  for (std::size_t su = 0; su < e_u.size(); ++su)
    for (std::size_t sv = 0; sv < e_v.size(); ++sv) {
      for (int i = 0; i < nu; ++i)  // half = poles * E_v^T
        for (int j = 0; j < nv; ++j) {
          glm::dvec4 sum(0);
          for (int m = 0; m < nv; ++m) {
            const std::size_t at = std::size_t(axis_u_.first_pole(int(su)) + i) * data.pole_count_v +
                                   axis_v_.first_pole(int(sv)) + m;
            const glm::dvec3 pole = data.poles[at] - origin_;
            sum += e_v[sv].at(j, m) *
                   (rational_ ? glm::dvec4(data.weights[at] * pole, data.weights[at]) : glm::dvec4(pole, 0));
          }
          half[std::size_t(i) * nv + j] = sum;
        }
      for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j) {
          glm::dvec4 sum(0);
          for (int m = 0; m < nu; ++m) sum += e_u[su].at(i, m) * half[std::size_t(m) * nv + j];
          coefficients_.push_back(sum);
        }
    }
}

// Horner over v in every row, then over u across the rows; derivatives ride along. P and Q are the degrees
// where they are known when compiling (the loops unroll and the rows run side by side), else -1. This and
// what follows is inlined up to the virtual members: results would else pass through memory from call to
// call.
template <int Order, int P, int Q>
[[gnu::always_inline]] inline BSplineSurface::Homogeneous BSplineSurface::evaluate_power(
    const glm::dvec4* block, double x, double y) const {
  const int p = P >= 0 ? P : degree_u_, q = Q >= 0 ? Q : degree_v_;
  Homogeneous h{};
  for (int i = p; i >= 0; --i) {
    const glm::dvec4* row = block + i * (q + 1);
    Lanes c(row[q]), cv, cvv;
    for (int j = q - 1; j >= 0; --j) {
      if constexpr (Order >= 2) cvv = cvv * y + cv;  // half the second derivative
      if constexpr (Order >= 1) cv = cv * y + c;
      c = c * y + Lanes(row[j]);
    }
    if constexpr (Order >= 2) {
      h.uu = h.uu * x + h.u;
      h.uv = h.uv * x + h.v;
      h.vv = h.vv * x + cvv;
    }
    if constexpr (Order >= 1) {
      h.u = h.u * x + h.p;
      h.v = h.v * x + cv;
    }
    h.p = h.p * x + c;
  }
  if constexpr (Order >= 2) {
    h.uu *= 2;
    h.vv *= 2;
  }
  return h;
}

template <int Order>
[[gnu::always_inline]] inline BSplineSurface::Homogeneous BSplineSurface::evaluate_bezier(
    const glm::dvec4* block, double x, double y) const {
  const BernsteinBasis bu(degree_u_, x), bv(degree_v_, y);
  Homogeneous h{};
  for (int i = 0; i <= degree_u_; ++i) {
    Lanes c, cv, cvv;
    for (int j = 0; j <= degree_v_; ++j) {
      const Lanes b(block[std::size_t(i) * (degree_v_ + 1) + j]);
      c += bv.value[j] * b;
      if constexpr (Order >= 1) cv += bv.first[j] * b;
      if constexpr (Order >= 2) cvv += bv.second[j] * b;
    }
    h.p += bu.value[i] * c;
    if constexpr (Order >= 1) {
      h.u += bu.first[i] * c;
      h.v += bu.value[i] * cv;
    }
    if constexpr (Order >= 2) {
      h.uu += bu.second[i] * c;
      h.uv += bu.first[i] * cv;
      h.vv += bu.value[i] * cvv;
    }
  }
  return h;
}

template <int Order>
[[gnu::always_inline]] inline BSplineSurface::Homogeneous BSplineSurface::evaluate_block(
    const glm::dvec4* block, double x, double y) const {
  if (!power_basis_) return evaluate_bezier<Order>(block, x, y);
  if (degree_u_ == 3 && degree_v_ == 3) return evaluate_power<Order, 3, 3>(block, x, y);
  if (degree_u_ == 2 && degree_v_ == 2) return evaluate_power<Order, 2, 2>(block, x, y);
  if (degree_u_ == 5 && degree_v_ == 5) return evaluate_power<Order, 5, 5>(block, x, y);
  return evaluate_power<Order, -1, -1>(block, x, y);
}

// Locates the span, evaluates, turns local derivatives into those by u and v, and divides by the weight
// (Piegl and Tiller, eq. 4.20).
template <int Order>
[[gnu::always_inline]] inline BSplineSurface::Homogeneous BSplineSurface::evaluate(double u, double v) const {
  const SpanAxis::Position pu = axis_u_.locate_inline(u), pv = axis_v_.locate_inline(v);
  const glm::dvec4* block = coefficients_.data() +
                            (std::size_t(pu.span) * axis_v_.span_count() + pv.span) * coefficients_per_span();
  Homogeneous h = evaluate_block<Order>(block, pu.local, pv.local);
  if constexpr (Order >= 1) {
    h.u *= pu.rate;
    h.v *= pv.rate;
  }
  if constexpr (Order >= 2) {
    h.uu *= pu.rate * pu.rate;
    h.uv *= pu.rate * pv.rate;
    h.vv *= pv.rate * pv.rate;
  }
  if (!rational_) return h;
  const double inverse = 1 / h.p.w();
  h.p *= inverse;
  if constexpr (Order >= 1) {
    const double wu = h.u.w(), wv = h.v.w();
    h.u = (h.u - wu * h.p) * inverse;
    h.v = (h.v - wv * h.p) * inverse;
    if constexpr (Order >= 2) {
      h.uv = (h.uv - wu * h.v - wv * h.u - h.uv.w() * h.p) * inverse;
      h.uu = (h.uu - 2 * wu * h.u - h.uu.w() * h.p) * inverse;
      h.vv = (h.vv - 2 * wv * h.v - h.vv.w() * h.p) * inverse;
    }
  }
  return h;
}

glm::dvec3 BSplineSurface::point(double u, double v) const {
  return origin_ + vector(evaluate<0>(u, v).p);
}

SurfaceFrame BSplineSurface::d1(double u, double v) const {
  const Homogeneous h = evaluate<1>(u, v);
  return {origin_ + vector(h.p), vector(h.u), vector(h.v)};
}

SurfaceDerivatives BSplineSurface::d2(double u, double v) const {
  const Homogeneous h = evaluate<2>(u, v);
  return {origin_ + vector(h.p), vector(h.u), vector(h.v), vector(h.uu), vector(h.uv), vector(h.vv)};
}

}  // namespace catoptra::cad_import
