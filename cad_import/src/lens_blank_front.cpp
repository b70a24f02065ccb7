// Fronts of lenses: conics, even aspheres and the progressive surface.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cad_import/src/lens_blank_parts.h"

namespace catoptra::cad_import {
namespace {

constexpr int kCorridorPanels = 16;

/// Step from 0 to 1 over t in [0, 1] with four continuous derivatives (as many as the fitted spline has), its
/// integral and its derivative.
double step(double t) {
  const double t2 = t * t;
  return t2 * t2 * t * (126 + t * (-420 + t * (540 + t * (-315 + 70 * t))));
}
double step_integral(double t) {
  const double t3 = t * t * t;
  return t3 * t3 * (21 + t * (-60 + t * (67.5 + t * (-35 + 7 * t))));
}
double step_derivative(double t) {
  const double u = t * (1 - t);
  return 630 * u * u * u * u;
}

/// (y, z) moved along an arc of constant curvature from the direction (-cos, -sin) of `angle`.
glm::dvec2 along_arc(double angle, double curvature, double arc) {
  // Both quotients tend to their limits for a straight line; half angles keep their digits.
  const double half = 0.5 * curvature * arc;
  const double chord = std::abs(half) < 1e-8 ? arc : 2 * std::sin(half) / curvature;
  return {-chord * std::cos(angle + half), -chord * std::sin(angle + half)};
}

}  // namespace

LensFront::LensFront(const LensBlank& blank, double curve_d)
    : form_(blank.front), curvature_(curve_d / (1000 * (blank.index - 1))) {
  if (form_ == LensFrontForm::conic || form_ == LensFrontForm::asphere) conic_ = blank.conic;
  if (form_ == LensFrontForm::asphere) coefficients_ = blank.asphere_mm;
  if (form_ != LensFrontForm::freeform) return;
  addition_curvature_ = blank.addition_d / (1000 * (blank.index - 1));
  corridor_mm_ = blank.corridor_mm;
  corridor_.assign(1, glm::dvec2(0));
  for (int panel = 0; panel < kCorridorPanels; ++panel)
    corridor_.push_back(corridor_.back() + corridor_chord(corridor_mm_ * panel / kCorridorPanels,
                                                          corridor_mm_ * (panel + 1) / kCorridorPanels));
}

double LensFront::limit_mm() const {
  if (form_ == LensFrontForm::freeform)
    return 1 / std::max({std::abs(curvature_), std::abs(curvature_ + addition_curvature_), 1e-300});
  const double squeezed = (1 + conic_) * curvature_ * curvature_;
  return squeezed > 0 ? 1 / std::sqrt(squeezed) : std::numeric_limits<double>::infinity();
}

double LensFront::sag_mm(double x_mm, double y_mm) const {
  return form_ == LensFrontForm::freeform ? trunk_sag(x_mm, y_mm) : round_sag(x_mm * x_mm + y_mm * y_mm);
}

double LensFront::round_sag(double r2) const {
  double sum = 0;
  for (std::size_t i = coefficients_.size(); i-- > 0;) sum = (sum + coefficients_[i]) * r2;
  const double root = std::sqrt(1 - (1 + conic_) * curvature_ * curvature_ * r2);
  return curvature_ * r2 / (1 + root) + sum * r2;
}

/// From one arc length to another within the corridor. The angle of the meridian is a polynomial of the arc;
/// its sine and cosine are integrated by Gauss-Legendre with five points (Abramowitz and Stegun, table 25.4),
/// to rounding over a sixteenth of a corridor.
glm::dvec2 LensFront::corridor_chord(double from_arc_mm, double to_arc_mm) const {
  constexpr std::array<double, 5> kNode{0, -0.5384693101056831, 0.5384693101056831, -0.9061798459386640,
                                        0.9061798459386640};
  constexpr std::array<double, 5> kWeight{0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                          0.2369268850561891, 0.2369268850561891};
  const double half = 0.5 * (to_arc_mm - from_arc_mm), centre = 0.5 * (from_arc_mm + to_arc_mm);
  glm::dvec2 chord{0};
  for (std::size_t i = 0; i < kNode.size(); ++i) {
    const double t = (centre + half * kNode[i]) / corridor_mm_;
    const double angle = corridor_mm_ * (curvature_ * t + addition_curvature_ * step_integral(t));
    chord -= kWeight[i] * half * glm::dvec2(std::cos(angle), std::sin(angle));
  }
  return chord;
}

/// The meridian at an arc length from the vertex, counted downwards.
LensFront::MeridianPoint LensFront::meridian(double arc_mm) const {
  if (arc_mm <= 0) {
    const glm::dvec2 p = along_arc(0, curvature_, arc_mm);
    return {p.x, p.y, curvature_ * arc_mm, curvature_, 0};
  }
  const double near = curvature_ + addition_curvature_;
  if (arc_mm >= corridor_mm_) {
    const double angle = corridor_mm_ * (curvature_ + addition_curvature_ * step_integral(1));
    const double beyond = arc_mm - corridor_mm_;
    const glm::dvec2 p = corridor_.back() + along_arc(angle, near, beyond);
    return {p.x, p.y, angle + near * beyond, near, 0};
  }
  const double t = arc_mm / corridor_mm_;
  const int panel = std::min(static_cast<int>(t * kCorridorPanels), kCorridorPanels - 1);
  const glm::dvec2 p = corridor_[static_cast<std::size_t>(panel)] +
                       corridor_chord(corridor_mm_ * panel / kCorridorPanels, arc_mm);
  return {p.x, p.y, corridor_mm_ * (curvature_ * t + addition_curvature_ * step_integral(t)),
          curvature_ + addition_curvature_ * step(t),
          addition_curvature_ * step_derivative(t) / corridor_mm_};
}

/// The circle across the meridian at arc s lies in the plane of x and the meridian's normal N = (sin, -cos),
/// touches the meridian, and has its curvature: point = M(s) + N(s) sag(s, x). Newton finds s where its y is
/// the one asked for; dy/ds = -cos (1 - k sag) + sin dsag/ds.
double LensFront::trunk_sag(double x_mm, double y_mm) const {
  double arc = -y_mm;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const MeridianPoint m = meridian(arc);
    const double root = std::sqrt(1 - m.curvature * m.curvature * x_mm * x_mm);
    const double sag = m.curvature * x_mm * x_mm / (1 + root);
    const double sag_growth = m.growth * x_mm * x_mm / (root * (1 + root));
    const double sine = std::sin(m.angle), cosine = std::cos(m.angle);
    const double miss = m.y + sine * sag - y_mm;
    if (std::abs(miss) < 1e-13) return -(m.z - cosine * sag);
    const double slope = -cosine * (1 - m.curvature * sag) + sine * sag_growth;
    if (!(slope < 0) || !std::isfinite(miss)) break;
    const double change = miss / slope;
    arc -= change;
    if (std::abs(change) < 1e-14 * (1 + std::abs(arc))) {
      const MeridianPoint end = meridian(arc);
      const double last = std::sqrt(1 - end.curvature * end.curvature * x_mm * x_mm);
      return -(end.z - std::cos(end.angle) * end.curvature * x_mm * x_mm / (1 + last));
    }
  }
  refuse_lens(
      "front curve",
      "the progressive front does not reach (" + number_text(x_mm) + ", " + number_text(y_mm) + ") mm",
      "make the lens smaller or its curve flatter");
}

}  // namespace catoptra::cad_import
