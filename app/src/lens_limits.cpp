#include "app/src/lens_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

namespace catoptra::app {
namespace {

using optics::CylinderForm;
using optics::SphereCylinder;

/// Numbers that are on a limit are within it, whatever the last digits.
constexpr double kRounding = 1e-9;

constexpr double kDegrees = 180 / std::numbers::pi;

double highest_meridian_d(const SphereCylinder& power) {
  return std::max(std::abs(power.sphere_d), std::abs(power.sphere_d + power.cylinder_d));
}

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

/// One lens before one rule. Each judge_... adds the verdict on its quantity, or why there is none.
class Court {
 public:
  Court(const RuleFile& rule, const LensOrder& order, const LensReading& reading)
      : rule_(rule),
        order_(order),
        reading_(reading),
        form_(order.power.cylinder_d > 0 ? CylinderForm::plus : CylinderForm::minus),
        measured_(optics::transposed(reading.power, form_)),
        variables_{{"highest_meridian_d", highest_meridian_d(order.power)},
                   {"sphere_d", std::abs(order.power.sphere_d)},
                   {"cylinder_d", std::abs(order.power.cylinder_d)},
                   {"prism_d", glm::length(order.prism)},
                   {"addition_d", order.addition_d}} {}

  LensVerdict verdict() && {
    judge_meridians();
    judge_power("sphere", order_.power.sphere_d, measured_.sphere_d);
    judge_power("cylinder", order_.power.cylinder_d, measured_.cylinder_d);
    judge_axis();
    judge_prism();
    judge_prism_component("prism_horizontal", "horizontal prism", 0);
    judge_prism_component("prism_vertical", "vertical prism", 1);
    judge_addition();
    judge_plain("base_curve", "front curve", order_.front_curve_d, reading_.front_curve_d);
    judge_plain("center_thickness", "center thickness", order_.center_thickness_mm,
                reading_.center_thickness_mm);
    return std::move(verdict_);
  }

 private:
  [[nodiscard]] bool in_rule(std::string_view quantity) const {
    return std::any_of(rule_.figures.begin(), rule_.figures.end(),
                       [&](const RuleFigure& figure) { return figure.quantity == quantity; });
  }

  void skip(std::string_view quantity, std::string reason) {
    verdict_.not_judged.push_back({std::string(quantity), std::move(reason)});
  }

  /// Null (and told) where the rule has none for this order; null and silent where it never has one.
  const RuleFigure* figure(std::string_view quantity) {
    if (!in_rule(quantity)) return nullptr;
    const RuleFigure* found = find_figure(rule_, quantity, lens_type_name(order_.type), variables_);
    if (!found) skip(quantity, "the rule file has no figure for this order");
    return found;
  }

  void add(const RuleFigure& figure, const std::string& what, double ordered, double measured, double limit,
           const std::string& unit, double deviation) {
    LensLimit result{figure, "", ordered, measured, deviation, limit, unit, false};
    result.requirement =
        what + " within " + number(limit) + " " + unit + " of " + number(ordered) + " " + unit;
    result.pass = std::abs(deviation) <= limit + kRounding;
    verdict_.limits.push_back(std::move(result));
  }

  void add_power(const RuleFigure& figure, const std::string& what, double ordered, double measured) {
    const double limit = figure.unit == "%" ? *figure.value / 100 * std::abs(ordered) : *figure.value;
    add(figure, what, ordered, measured, limit, "D", measured - ordered);
  }

  void judge_power(const std::string& quantity, double ordered, double measured) {
    if (const RuleFigure* found = figure(quantity)) add_power(*found, quantity, ordered, measured);
  }

  /// The two principal powers, the weaker (more negative) of the order with that of the lens, and so on.
  void judge_meridians() {
    const RuleFigure* found = figure("meridian_power");
    if (!found) return;
    const auto sorted = [](const SphereCylinder& p) {
      return std::minmax({p.sphere_d, p.sphere_d + p.cylinder_d});
    };
    const std::pair<double, double> ordered = sorted(order_.power), measured = sorted(measured_);
    add_power(*found, "lower meridian", ordered.first, measured.first);
    add_power(*found, "higher meridian", ordered.second, measured.second);
  }

  void judge_axis() {
    if (!in_rule("axis")) return;
    if (order_.power.cylinder_d == 0) return skip("axis", "no cylinder was ordered");
    const RuleFigure* found = figure("axis");
    if (!found) return;
    const double ordered = order_.power.axis_rad * kDegrees, measured = measured_.axis_rad * kDegrees;
    add(*found, "axis", ordered, measured, *found->value, "deg", std::remainder(measured - ordered, 180));
  }

  void judge_prism() {
    const RuleFigure* found = figure("prism");
    if (!found) return;
    // A place wrong by so many mm shifts the prism by Prentice's rule, most along the stronger meridian.
    const double limit =
        found->unit == "mm" ? *found->value / 10 * variables_.at("highest_meridian_d") : *found->value;
    add(*found, "prism", glm::length(order_.prism), glm::length(reading_.prism), limit, "prism dioptre",
        glm::distance(reading_.prism, order_.prism));
  }

  void judge_prism_component(const std::string& quantity, const std::string& what, int component) {
    const RuleFigure* found = figure(quantity);
    if (!found) return;
    const double limit =
        found->values.at("constant") + found->values.at("per_dioptre") * variables_.at("highest_meridian_d");
    const double ordered = order_.prism[component], measured = reading_.prism[component];
    add(*found, what, ordered, measured, limit, "prism dioptre", measured - ordered);
  }

  void judge_addition() {
    if (!in_rule("addition") || order_.addition_d == 0) return;
    const RuleFigure* found = figure("addition");
    if (!found) return;
    if (!reading_.addition_d) return skip("addition", "the near reference point was not measured");
    add(*found, "addition", order_.addition_d, *reading_.addition_d, *found->value, "D",
        *reading_.addition_d - order_.addition_d);
  }

  void judge_plain(const std::string& quantity, const std::string& what, const std::optional<double>& ordered,
                   double measured) {
    if (!in_rule(quantity)) return;
    if (!ordered) return skip(quantity, "none was ordered");
    if (const RuleFigure* found = figure(quantity))
      add(*found, what, *ordered, measured, *found->value, found->unit, measured - *ordered);
  }

  const RuleFile& rule_;
  const LensOrder& order_;
  const LensReading& reading_;
  CylinderForm form_;
  SphereCylinder measured_;
  std::map<std::string, double> variables_;
  LensVerdict verdict_;
};

}  // namespace

const RuleVocabulary& lens_rule_words() {
  static const RuleVocabulary words{
      "lens",
      {
          {"meridian_power", {"D", "%"}},
          {"sphere", {"D", "%"}},
          {"cylinder", {"D", "%"}},
          {"axis", {"deg"}},
          {"prism", {"prism dioptre", "mm"}},
          {"prism_horizontal", {"prism dioptre"}, {"constant", "per_dioptre"}},
          {"prism_vertical", {"prism dioptre"}, {"constant", "per_dioptre"}},
          {"addition", {"D"}},
          {"base_curve", {"D"}},
          {"center_thickness", {"mm"}},
      },
      {"single vision", "multifocal", "progressive"},
      {"highest_meridian_d", "sphere_d", "cylinder_d", "prism_d", "addition_d"}};
  return words;
}

std::string_view lens_type_name(LensType type) {
  switch (type) {
    case LensType::multifocal:
      return "multifocal";
    case LensType::progressive:
      return "progressive";
    default:
      return "single vision";
  }
}

bool LensVerdict::passed() const {
  return !limits.empty() && std::all_of(limits.begin(), limits.end(), [](const auto& l) { return l.pass; });
}

std::optional<Certainty> LensVerdict::certainty() const {
  std::optional<Certainty> worst;
  for (const LensLimit& limit : limits)
    worst = std::max(worst.value_or(Certainty::verified), limit.figure.certainty);
  return worst;
}

LensVerdict judge_lens(const RuleFile& rule, const LensOrder& order, const LensReading& reading) {
  return Court(rule, order, reading).verdict();
}

}  // namespace catoptra::app
