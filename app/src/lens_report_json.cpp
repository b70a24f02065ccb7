// The JSON form of lens_report.h.
#include <numbers>

#include "app/src/json_values.h"
#include "app/src/lens_report_writers.h"
#include "app/src/report.h"

namespace catoptra::app {
namespace {

using nlohmann::ordered_json;
using optics::LensPathEnd;

constexpr double kDegrees = 180 / std::numbers::pi;

ordered_json pair(const glm::dvec2& v) {
  return {v.x, v.y};
}

ordered_json reference_json(const LensReport& report) {
  const PrismBase prism = prism_base(report.reference_prism);
  return {{"sphere_d", report.reference.sphere_d},
          {"cylinder_d", report.reference.cylinder_d},
          {"axis_deg", report.reference.axis_rad * kDegrees},
          {"prism_d", prism.prism},
          {"prism_base_deg", prism.base_rad * kDegrees},
          {"prism_h", report.reference_prism.x},
          {"prism_v", report.reference_prism.y}};
}

/// Every key is there at every point. Distortion is defined along lines of sight alone.
ordered_json point_json(const LensReportPoint& point, bool worn) {
  const optics::LensPoint& m = point.measured;
  const bool met = m.end != LensPathEnd::missed, passed = m.end == LensPathEnd::passed;
  const auto where = [](bool known, double value) {
    return known ? ordered_json(value) : ordered_json(nullptr);
  };
  const bool has_gaze = met || point.asked_by_gaze, has_place = met || !point.asked_by_gaze;
  return {{"gaze_h_deg", where(has_gaze, m.gaze_rad.x * kDegrees)},
          {"gaze_v_deg", where(has_gaze, m.gaze_rad.y * kDegrees)},
          {"x_mm", where(has_place, m.point_mm.x)},
          {"y_mm", where(has_place, m.point_mm.y)},
          {"end", path_end_name(m.end)},
          {"sphere_d", where(passed, point.power.sphere_d)},
          {"cylinder_d", where(passed, point.power.cylinder_d)},
          {"axis_deg", where(passed, point.power.axis_rad * kDegrees)},
          {"mean_power_error_d", where(passed, m.mean_power_error_d)},
          {"oblique_astigmatism_d", where(passed, m.oblique_astigmatism_d)},
          {"tangential_d", where(passed, m.tangential_d)},
          {"sagittal_d", where(passed, m.sagittal_d)},
          {"prism_h", where(passed, m.prism.x)},
          {"prism_v", where(passed, m.prism.y)},
          {"base_out", where(passed, point.base_out)},
          {"object_h_deg", where(passed, m.object_rad.x * kDegrees)},
          {"object_v_deg", where(passed, m.object_rad.y * kDegrees)},
          {"distortion", where(passed && worn, m.distortion)},
          {"tca_d", where(passed, m.transverse_colour)}};
}

ordered_json power_json(const optics::SphereCylinder& power) {
  return {{"sphere_d", power.sphere_d},
          {"cylinder_d", power.cylinder_d},
          {"axis_deg", power.axis_rad * kDegrees}};
}

ordered_json addition_json(const LensAddition& addition) {
  return {{"addition_d", addition.addition_d},
          {"side", addition.at.on_front ? "front" : "back"},
          {"distance_point_mm", pair(addition.at.distance_mm)},
          {"near_point_mm", pair(addition.at.near_mm)},
          {"distance", power_json(addition.distance)},
          {"near", power_json(addition.near)}};
}

ordered_json position_json(const optics::EvaluationOptions& options) {
  const optics::WearingPosition& p = options.position;
  return {{"rotation_centre_mm", p.rotation_centre_mm},
          {"vertex_distance_mm", p.vertex_distance_mm},
          {"panto_deg", p.pantoscopic_rad * kDegrees},
          {"wrap_deg", p.wrap_rad * kDegrees},
          {"eye", p.eye == optics::Eye::right ? "right" : "left"},
          {"object_distance_mm", number_or_null(options.object_distance_mm)}};
}

ordered_json limit_json(const LensLimit& limit) {
  ordered_json json{{"clause", limit.figure.clause},
                    {"quantity", limit.figure.quantity},
                    {"requirement", limit.requirement},
                    {"ordered", limit.ordered},
                    {"value", limit.measured},
                    {"deviation", limit.deviation},
                    {"limit", limit.limit},
                    {"unit", limit.unit},
                    {"pass", limit.pass},
                    {"certainty", certainty_name(limit.figure.certainty)},
                    {"source", limit.figure.source}};
  if (!limit.figure.note.empty()) json["note"] = limit.figure.note;
  return json;
}

void add_verdict(const LensReport& report, ordered_json& json) {
  ordered_json limits = ordered_json::array(), not_judged = ordered_json::array();
  if (report.verdict) {
    for (const LensLimit& limit : report.verdict->limits) limits.push_back(limit_json(limit));
    for (const NotJudged& n : report.verdict->not_judged)
      not_judged.push_back({{"quantity", n.quantity}, {"reason", n.reason}});
  }
  json["limits"] = std::move(limits);
  if (!report.verdict) return;
  json["limits_not_judged"] = std::move(not_judged);
  const RuleFile& rule = *report.options.rule;
  const auto certainty = report.verdict->certainty();
  json["rule"] = {
      {"id", rule.id},
      {"title", rule.title},
      {"edition", rule.edition},
      {"date", rule.date},
      {"file", rule.file},
      {"source", rule.source},
      {"note", rule.note},
      {"lens_type", lens_type_name(report.options.order->type)},
      {"pass", report.verdict->passed()},
      {"certainty", certainty ? ordered_json(certainty_name(*certainty)) : ordered_json(nullptr)}};
}

}  // namespace

ordered_json lens_report_json(const LensReport& report) {
  const optics::EvaluationOptions& options = report.options.evaluation;
  const bool worn = options.mode == optics::EvaluationMode::as_worn;
  ordered_json json{{"lens", report.lens},
                    {"material", report.material},
                    {"wavelength_nm", options.wavelength_nm},
                    {"mode", worn ? "as-worn" : "lensmeter"},
                    {"index", report.index},
                    {"index_around", report.index_around},
                    {"dispersion", report.dispersion},
                    {"material_certainty", report.material_unverified ? "unverified" : "verified"},
                    {"cylinder", report.options.cylinder == optics::CylinderForm::plus ? "plus" : "minus"},
                    {"center_thickness_mm", report.center_thickness_mm},
                    {"front_curve_d", pair(report.front_curve_d)},
                    {"back_curve_d", pair(report.back_curve_d)},
                    {"position", position_json(options)},
                    {"reference", reference_json(report)},
                    {"spectacle_magnification", report.spectacle_magnification}};
  if (report.addition) json["addition"] = addition_json(*report.addition);
  ordered_json points = ordered_json::array();
  for (const LensReportPoint& point : report.points) points.push_back(point_json(point, worn));
  json["points"] = std::move(points);
  add_verdict(report, json);
  json["inputs"] = inputs_json(report.inputs);
  json["warnings"] = report.warnings;
  json["versions"] = versions_json();
  return json;
}

}  // namespace catoptra::app
