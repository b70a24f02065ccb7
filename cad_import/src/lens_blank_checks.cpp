// What a lens to order must satisfy before any optics, and its outline.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "cad_import/src/lens_blank_parts.h"

namespace catoptra::cad_import {
namespace {

void check_finite(const LensBlank& blank) {
  struct Value {
    const char* key;
    double value;
  };
  const std::array<Value, 12> values{{{"index", blank.index},
                                      {"sphere", blank.sphere_d},
                                      {"cylinder", blank.cylinder_d},
                                      {"axis", blank.axis_deg},
                                      {"addition", blank.addition_d},
                                      {"corridor", blank.corridor_mm},
                                      {"prism", blank.prism_d},
                                      {"prism base", blank.prism_base_deg},
                                      {"front curve", blank.front_curve_d.value_or(0)},
                                      {"conic", blank.conic},
                                      {"back conic", blank.back_conic},
                                      {"diameter", blank.diameter_mm}}};
  for (const Value& v : values)
    if (!std::isfinite(v.value)) refuse_lens(v.key, "must be a finite number");
}

void check_above_zero(const std::string& key, double value_mm) {
  if (!(std::isfinite(value_mm) && value_mm > 0))
    refuse_lens(key, number_text(value_mm) + " mm is not above 0 mm");
}

void check_prescription(const LensBlank& blank) {
  if (!(blank.index > 1))
    refuse_lens("index", number_text(blank.index) + " is not above 1",
                "the index of the material in air, for example 1.5");
  if (!(blank.axis_deg >= 0 && blank.axis_deg <= 180))
    refuse_lens("axis", number_text(blank.axis_deg) + " degrees is not between 0 and 180");
  if (blank.prism_d < 0)
    refuse_lens("prism", number_text(blank.prism_d) + " is below 0", "turn the base by 180 degrees instead");
  if (!(blank.prism_base_deg >= 0 && blank.prism_base_deg <= 360))
    refuse_lens("prism base", number_text(blank.prism_base_deg) + " degrees is not between 0 and 360");
  if (blank.prism_d > 30)
    refuse_lens("prism", number_text(blank.prism_d) + " is more than the 30 that one lens is ground with");
  if (blank.addition_d < 0) refuse_lens("addition", number_text(blank.addition_d) + " D is below 0");
}

void check_front(const LensBlank& blank) {
  const bool freeform = blank.front == LensFrontForm::freeform;
  const bool asphere = blank.front == LensFrontForm::asphere;
  if (blank.addition_d != 0 && !freeform)
    refuse_lens("addition", number_text(blank.addition_d) + " D needs a freeform front");
  if (freeform) check_above_zero("corridor", blank.corridor_mm);
  if (blank.conic != 0 && !asphere && blank.front != LensFrontForm::conic)
    refuse_lens("conic", number_text(blank.conic) + " needs a conic or aspheric front");
  if (!blank.asphere_mm.empty() && !asphere) refuse_lens("asphere", "coefficients need an aspheric front");
  for (const double a : blank.asphere_mm)
    if (!std::isfinite(a)) refuse_lens("asphere", "coefficients must be finite numbers");
}

void check_back(const LensBlank& blank) {
  if (blank.back_conic != 0 && back_form(blank) == LensBackForm::toric)
    refuse_lens("back conic", number_text(blank.back_conic) + " needs a biconic back",
                "the sections of a torus are circles");
}

void check_size(const LensBlank& blank) {
  check_above_zero("diameter", blank.diameter_mm);
  if (blank.center_thickness_mm && blank.edge_thickness_mm)
    refuse_lens("thickness", "center and edge thickness exclude each other", "give one of them");
  if (blank.center_thickness_mm) check_above_zero("center thickness", *blank.center_thickness_mm);
  if (blank.edge_thickness_mm) check_above_zero("edge thickness", *blank.edge_thickness_mm);
  if (blank.outline.empty()) return;
  check_polygon(blank.outline, "lens");
  // Even-odd rule along +x: the prescription belongs to a point of the lens.
  bool inside = false;
  for (std::size_t i = 0; i < blank.outline.size(); ++i) {
    const glm::dvec2 &a = blank.outline[i], &b = blank.outline[(i + 1) % blank.outline.size()];
    if ((a.y > 0) != (b.y > 0) && a.x - a.y * (b.x - a.x) / (b.y - a.y) > 0) inside = !inside;
  }
  if (!inside) refuse_lens("outline", "does not contain the lens's axis (0, 0)");
}

}  // namespace

void refuse_lens(const std::string& key, const std::string& reason, const std::string& hint) {
  throw Error("lens", key, reason, hint);
}

std::string number_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

void check_lens_blank(const LensBlank& blank) {
  check_finite(blank);
  check_prescription(blank);
  check_front(blank);
  check_back(blank);
  check_size(blank);
}

std::vector<OutlinePiece> lens_outline(const LensBlank& blank) {
  if (!blank.outline.empty()) return polygon_pieces(blank.outline);
  const double radius = blank.diameter_mm / 2;
  return rounded_pieces({glm::dvec2(-radius), glm::dvec2(radius)}, radius);
}

double lens_reach_mm(const LensBlank& blank) {
  if (blank.outline.empty()) return blank.diameter_mm / 2;
  double reach = 0;
  for (const glm::dvec2& corner : blank.outline) reach = std::max(reach, glm::length(corner));
  return reach;
}

}  // namespace catoptra::cad_import
