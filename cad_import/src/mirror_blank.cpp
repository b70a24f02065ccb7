// The ideal shape of a mirror glass: its checks and its height field.
#include "cad_import/mirror_blank.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <string>

#include "cad_import/src/mirror_blank_parts.h"

namespace catoptra::cad_import {
namespace {

[[noreturn]] void refuse(const std::string& key, const std::string& reason, const std::string& hint = {}) {
  throw Error("mirror", key, reason, hint);
}

std::string text(double value) {
  std::string digits = std::to_string(value);
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return digits;
}

double curvature(double radius_mm) {
  return radius_mm == 0 ? 0 : 1 / radius_mm;
}

/// What the aspheric strip adds to the sphere: a function of x alone, zero with its first two derivatives at
/// the boundary. With the curvature k(x) = d(sin theta)/dx linear in x, the sine of the slope angle is the
/// quadratic s(x) = x/R + (1/R_edge - 1/R) (x - b)^2 / (2 (x_edge - b)), and dz/dx = -s / sqrt(1 - s^2).
double aspheric_addition(const AsphericPart& part, double radius_mm, double edge_x_mm, double x_mm) {
  const double b = part.boundary_mm;
  if (x_mm <= b) return 0;
  const double growth = (1 / part.edge_radius_mm - 1 / radius_mm) / (2 * (edge_x_mm - b));
  const auto slope = [](double sine) { return -sine / std::sqrt(1 - sine * sine); };
  const auto integrand = [&](double x) {
    const double sphere = x / radius_mm;
    return slope(sphere + growth * (x - b) * (x - b)) - slope(sphere);
  };
  // Gauss-Legendre with five points (Abramowitz and Stegun, table 25.4) on eight panels.
  constexpr std::array<double, 5> kNode{0, -0.5384693101056831, 0.5384693101056831, -0.9061798459386640,
                                        0.9061798459386640};
  constexpr std::array<double, 5> kWeight{0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                          0.2369268850561891, 0.2369268850561891};
  constexpr int kPanels = 8;
  const double half = (x_mm - b) / (2 * kPanels);
  double sum = 0;
  for (int panel = 0; panel < kPanels; ++panel) {
    const double centre = b + (2 * panel + 1) * half;
    for (std::size_t i = 0; i < kNode.size(); ++i) sum += kWeight[i] * integrand(centre + half * kNode[i]);
  }
  return sum * half;
}

void check_aspheric(const MirrorBlank& blank, const OutlineBox& box) {
  const AsphericPart& part = *blank.aspheric;
  if (blank.radius_h_mm != blank.radius_v_mm || blank.radius_h_mm <= 0)
    refuse("aspheric", "an aspheric strip needs a convex sphere inside", "give one positive radius");
  if (!(part.edge_radius_mm > 0 && part.edge_radius_mm < blank.radius_h_mm))
    refuse("aspheric edge radius", text(part.edge_radius_mm) + " mm is not between 0 and the radius of " +
                                       text(blank.radius_h_mm) + " mm");
  const double edge_x = aspheric_edge_mm(part, box);
  if (!(part.boundary_mm >= 0 && part.boundary_mm < edge_x))
    refuse("aspheric boundary",
           text(part.boundary_mm) + " mm is not between the pole and the edge at " + text(edge_x) + " mm");
  const double sine = edge_x / blank.radius_h_mm +
                      (1 / part.edge_radius_mm - 1 / blank.radius_h_mm) * (edge_x - part.boundary_mm) / 2;
  if (!(sine < 1)) refuse("aspheric edge radius", "the glass would turn back on itself before its edge");
}

void check_outline(const MirrorBlank& blank) {
  if (blank.outline == MirrorOutline::polygon) return check_polygon(blank.polygon, "mirror");
  if (!(std::isfinite(blank.width_mm) && blank.width_mm > 0)) refuse("width", "must be more than 0 mm");
  if (!(std::isfinite(blank.height_mm) && blank.height_mm > 0)) refuse("height", "must be more than 0 mm");
  if (blank.outline != MirrorOutline::rounded) return;
  const double most = std::min(blank.width_mm, blank.height_mm) / 2;
  if (!(blank.corner_radius_mm > 0 && blank.corner_radius_mm <= most * (1 + 1e-12)))
    refuse("corner radius", text(blank.corner_radius_mm) +
                                " mm is not between 0 and half of the smaller side, " + text(most) + " mm");
}

}  // namespace

OutlineBox outline_box(const MirrorBlank& blank) {
  if (blank.outline != MirrorOutline::polygon)
    return {{-blank.width_mm / 2, -blank.height_mm / 2}, {blank.width_mm / 2, blank.height_mm / 2}};
  return box_of(blank.polygon);
}

double aspheric_edge_mm(const AsphericPart& part, const OutlineBox& box) {
  return part.towards_minus_x ? -box.min.x : box.max.x;
}

void check_blank(const MirrorBlank& blank) {
  if (!std::isfinite(blank.radius_h_mm) || !std::isfinite(blank.radius_v_mm))
    refuse("radius", "must be finite");
  if (!(std::isfinite(blank.thickness_mm) && blank.thickness_mm > 0))
    refuse("thickness", "must be more than 0 mm");
  check_outline(blank);
  const OutlineBox box = outline_box(blank);
  const glm::dvec2 far = glm::max(glm::abs(box.min), glm::abs(box.max));
  const double h = far.x * curvature(blank.radius_h_mm), v = far.y * curvature(blank.radius_v_mm);
  if (!(h * h + v * v < 1)) {
    const double radius =
        blank.radius_h_mm == 0 ||
                (blank.radius_v_mm != 0 && std::abs(blank.radius_v_mm) < std::abs(blank.radius_h_mm))
            ? blank.radius_v_mm
            : blank.radius_h_mm;
    refuse("radius",
           text(radius) + " mm is too small for a glass that reaches " + text(std::hypot(far.x, far.y)) +
               " mm from its pole",
           "make the glass smaller or the radius larger");
  }
  if (blank.aspheric) check_aspheric(blank, box);
}

double ideal_sag_mm(const MirrorBlank& blank, const OutlineBox& box, double x_mm, double y_mm) {
  const double h = curvature(blank.radius_h_mm), v = curvature(blank.radius_v_mm);
  const double root = 1 - h * h * x_mm * x_mm - v * v * y_mm * y_mm;
  if (!(root > 0)) refuse("radius", "the surface does not reach so far from the pole");
  const double sag = -(h * x_mm * x_mm + v * y_mm * y_mm) / (1 + std::sqrt(root));
  if (!blank.aspheric) return sag;
  const double outwards = blank.aspheric->towards_minus_x ? -x_mm : x_mm;
  return sag + aspheric_addition(*blank.aspheric, blank.radius_h_mm, aspheric_edge_mm(*blank.aspheric, box),
                                 outwards);
}

double mirror_sag_mm(const MirrorBlank& blank, double x_mm, double y_mm) {
  check_blank(blank);
  return ideal_sag_mm(blank, outline_box(blank), x_mm, y_mm);
}

}  // namespace catoptra::cad_import
