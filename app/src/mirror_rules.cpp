#include "app/src/mirror_rules.h"

#include <algorithm>

namespace catoptra::app {
namespace {

constexpr double kMetre_mm = 1000;

double value_or(const RuleFigure& figure, const std::string& name, double otherwise) {
  const auto found = figure.values.find(name);
  return found == figure.values.end() ? otherwise : found->second;
}

ZonePart make_part(const RuleFile& rule, const RuleFigure& figure, const ZonePlacement& placement) {
  ZonePart part;
  part.figure = &figure;
  const double from = kMetre_mm * figure.values.at("from_m");
  part.to_horizon = !figure.values.contains("to_m");
  const double to = part.to_horizon ? placement.far_mm : kMetre_mm * figure.values.at("to_m");
  const std::string entity = "line " + std::to_string(figure.line) + ", figure.values";
  if (!(from < to))
    throw Error(rule.file, entity,
                "the zone begins " + std::string(part.to_horizon ? "beyond the far cut" : "beyond its end"),
                part.to_horizon ? "let evaluation.far or --far be farther" : "from_m must be less than to_m");
  const double near_width = kMetre_mm * figure.values.at("width_m");
  const double far_width = kMetre_mm * value_or(figure, "width_to_m", figure.values.at("width_m"));
  if (!(near_width > 0 && far_width > 0)) throw Error(rule.file, entity, "the zone's width must be above 0");
  if (figure.quantity == "field_across_median") {
    const double m = placement.median_left_mm;
    part.polygon = {{from, m - near_width / 2},
                    {from, m + near_width / 2},
                    {to, m + far_width / 2},
                    {to, m - far_width / 2}};
  } else {
    const double s = placement.side_left_mm, out = placement.outwards;
    part.polygon = {{from, s}, {from, s + out * near_width}, {to, s + out * far_width}, {to, s}};
  }
  return part;
}

}  // namespace

const RuleVocabulary& mirror_rule_words() {
  static const RuleVocabulary words{
      "mirror",
      {
          {"field", {"m"}, {"from_m", "width_m"}, {"to_m", "width_to_m"}},
          {"field_across_median", {"m"}, {"from_m", "width_m"}, {"to_m", "width_to_m"}},
          {"coverage_min", {"%"}},
          {"obstruction_max", {"%"}},
          {"three_readings", {"mm"}},
          {"ten_readings", {"mm"}},
          {"mean_radius_min", {"mm"}},
          {"mean_radius_max", {"mm"}},
          {"radius_difference_max", {"%"}},
          {"radius_deviation_max", {"%"}},
          {"aspheric_radius_min", {"mm"}},
          {"rectangle", {"mm"}, {"height_mm", "flat_width_mm", "radius_mm"}},
          {"upright_segment_min", {"mm"}},
          {"reflectance_min", {"%"}},
          {"magnification_min", {"1"}},
          {"horizon_angle_min", {"deg"}},
          {"road_begins_max", {"m"}},
          {"on_driver_side", {"1"}},
      },
      {},
      {"mean_radius_mm"}};
  return words;
}

std::vector<ZonePart> required_zone(const RuleFile& rule, const ZonePlacement& placement) {
  std::vector<ZonePart> parts;
  for (const RuleFigure& figure : rule.figures)
    if (figure.quantity == "field" || figure.quantity == "field_across_median")
      parts.push_back(make_part(rule, figure, placement));
  return parts;
}

bool needs_median_plane(const RuleFile& rule) {
  return std::any_of(rule.figures.begin(), rule.figures.end(),
                     [](const RuleFigure& figure) { return figure.quantity == "field_across_median"; });
}

}  // namespace catoptra::app
