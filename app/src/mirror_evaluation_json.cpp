// The JSON form of mirror_evaluation.h.
#include <glm/trigonometric.hpp>

#include "app/src/json_values.h"
#include "app/src/mirror_evaluation_writers.h"
#include "app/src/report.h"

namespace catoptra::app {
namespace {

using nlohmann::ordered_json;

ordered_json array(const glm::dvec2& v) {
  return {v.x, v.y};
}
ordered_json array(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

ordered_json polygon(const std::vector<glm::dvec2>& corners) {
  ordered_json result = ordered_json::array();
  for (const glm::dvec2& corner : corners) result.push_back(array(corner));
  return result;
}

ordered_json readings_json(const MirrorEvaluation& e) {
  ordered_json places = ordered_json::array();
  for (const optics::RadiusReading& r : e.readings.readings) {
    ordered_json place{{"xy_mm", array(r.xy_mm)}, {"along_mm", number_or_null(r.along_mm)}};
    if (!e.ten_readings) {
      place["across_mm"] = number_or_null(r.across_mm);
      place["mean_mm"] = number_or_null(r.mean_mm());
    }
    places.push_back(std::move(place));
  }
  return {{"procedure", e.ten_readings ? "FMVSS 111, ten readings" : "UN R46, three places of an arc"},
          {"arc", e.ten_readings ? ordered_json(nullptr)
                                 : ordered_json(e.readings.along_upright ? "upright" : "level")},
          {"base_mm", e.readings.base_mm},
          {"worst_difference", number_or_null(e.readings.worst_difference)},
          {"worst_deviation", number_or_null(e.readings.worst_deviation)},
          {"places", std::move(places)}};
}

ordered_json view_json(const MirrorEvaluation& e) {
  const optics::ViewSummary& v = e.view;
  return {{"eye_distance_mm", v.center.eye_distance_mm},
          {"incidence_deg", glm::degrees(v.center.incidence_rad)},
          {"tangential", v.center.tangential},
          {"sagittal", v.center.sagittal},
          {"anisotropy", v.center.anisotropy},
          {"astigmatism_d", v.center.astigmatism_d},
          {"least", v.least_magnification},
          {"mean", v.mean_magnification},
          {"greatest", v.greatest_magnification},
          {"greatest_anisotropy", v.greatest_anisotropy},
          {"greatest_astigmatism_d", v.greatest_astigmatism_d}};
}

ordered_json map_json(const MirrorEvaluation& e) {
  ordered_json points = ordered_json::array();
  for (std::size_t i = 0; i < e.map.points.size(); ++i) {
    const optics::GlassPoint& p = e.map.points[i];
    ordered_json point{{"xy_mm", array(p.xy_mm)},
                       {"radius1_mm", number_or_null(optics::radius_of_mm(p.curvatures.k1))},
                       {"radius2_mm", number_or_null(optics::radius_of_mm(p.curvatures.k2))},
                       {"spherical", optics::in_spherical_part(e.map, p)}};
    if (e.views[i]) {
      point["tangential"] = e.views[i]->tangential;
      point["sagittal"] = e.views[i]->sagittal;
      point["astigmatism_d"] = e.views[i]->astigmatism_d;
    }
    points.push_back(std::move(point));
  }
  return {
      {"step_mm", e.map.step_mm}, {"spherical_share", e.map.spherical_share}, {"points", std::move(points)}};
}

ordered_json field_json(const MirrorEvaluation& e) {
  const optics::FieldAreas& f = e.field;
  const bool required = e.zone_required;
  ordered_json zone = ordered_json::array(), margins = ordered_json::array(),
               outlines = ordered_json::array();
  for (const ZonePart& part : e.zone) zone.push_back(polygon(part.polygon));
  for (const optics::EdgeMargin& m : e.margins)
    margins.push_back({{"from_mm", array(m.from_mm)},
                       {"to_mm", array(m.to_mm)},
                       {"margin_mm", m.margin_mm},
                       {"limit_mm", m.limit_mm}});
  for (const auto& outline : e.outlines) outlines.push_back(polygon(outline));
  ordered_json result{{"required_m2", required ? ordered_json(f.zone_m2) : ordered_json(nullptr)},
                      {"covered_m2", f.covered_m2},
                      {"coverage", required ? ordered_json(f.covered_m2 / f.zone_m2) : ordered_json(nullptr)},
                      {"shown_m2", f.reflected_m2},
                      {"hidden_m2", f.obstructed_m2},
                      {"binocular_m2", f.binocular_m2},
                      {"monocular_m2", {f.monocular_m2[0], f.monocular_m2[1]}},
                      {"uncertain_m2", f.uncertain_m2},
                      {"far_mm", e.vehicle.far_mm},
                      {"horizon_shown", e.horizon_seen},
                      {"horizon_angle_deg", e.horizon ? ordered_json(glm::degrees(e.horizon->angle_rad()))
                                                      : ordered_json(nullptr)},
                      {"road_begins_mm", number_or_null(e.road_begins_mm)},
                      {"zone_mm", std::move(zone)},
                      {"margins", std::move(margins)},
                      {"outlines_mm", std::move(outlines)}};
  if (e.spherical_field) result["spherical_part_covered_m2"] = e.spherical_field->covered_m2;
  return result;
}

const char* side_plane_name(SidePlane from) {
  switch (from) {
    case SidePlane::scene:
      return "scene";
    case SidePlane::vehicle:
      return "vehicle";
    case SidePlane::mirror:
      break;
  }
  return "mirror";
}

ordered_json vehicle_json(const VehicleSummary& v) {
  ordered_json eyes = ordered_json::array();
  for (const glm::dvec3& eye : v.eyes_mm) eyes.push_back(array(eye));
  return {{"eyes_mm", std::move(eyes)},
          {"forward", array(v.road.forward)},
          {"up", array(v.road.up)},
          {"origin_mm", array(v.road.origin_mm)},
          {"mirror_side", v.mirror_left ? "left" : "right"},
          {"driver_side",
           v.driver_left ? ordered_json(*v.driver_left ? "left" : "right") : ordered_json(nullptr)},
          {"side_left_mm", number_or_null(v.side_left_mm)},
          {"side_plane_from", side_plane_name(v.side_from)},
          {"median_left_mm", number_or_null(v.median_left_mm)},
          {"obstructions", v.obstructions}};
}

ordered_json aim_json(const AimSummary& a) {
  return {{"yaw_deg", glm::degrees(a.aim.yaw_rad)},
          {"pitch_deg", glm::degrees(a.aim.pitch_rad)},
          {"limits_deg", {glm::degrees(a.yaw_limit_rad), glm::degrees(a.pitch_limit_rad)}},
          {"at_yaw_stop", a.aim.at_yaw_stop},
          {"at_pitch_stop", a.aim.at_pitch_stop},
          {"coverage_before", a.aim.coverage_before},
          {"coverage", a.aim.coverage},
          {"inside_glass_mm", number_or_null(a.aim.inside_mm)},
          {"pivot_mm", array(a.aim.pose.pivot_mm)},
          {"rotate_deg", array(a.rotate_deg)},
          {"translate", array(a.translate)}};
}

ordered_json clauses_json(const MirrorEvaluation& e) {
  ordered_json clauses = ordered_json::array();
  for (const MirrorClause& c : e.clauses)
    clauses.push_back({{"clause", c.clause},
                       {"requirement", c.requirement},
                       {"value", number_or_null(c.value)},
                       {"limit", number_or_null(c.limit)},
                       {"unit", c.unit},
                       {"pass", c.pass},
                       {"certainty", certainty_name(c.certainty)},
                       {"source", c.source},
                       {"note", c.note}});
  return clauses;
}

}  // namespace

ordered_json mirror_json(const MirrorEvaluation& e) {
  ordered_json json{
      {"scene", e.scene},
      {"mirror", e.mirror},
      {"mean_radius_mm", number_or_null(e.readings.mean_mm)},
      {"radius_mm", {{"min", number_or_null(e.map.min_mm)}, {"max", number_or_null(e.map.max_mm)}}},
      {"rule", e.rule_id.empty() ? ordered_json(nullptr) : ordered_json(e.rule_id)},
      {"rule_edition", e.rule_edition},
      {"clauses", clauses_json(e)},
      {"pass", e.clauses.empty() ? ordered_json(nullptr) : ordered_json(e.passes())},
      {"rests_on_unverified", e.rests_on_unverified()},
      {"field", field_json(e)},
      {"blind_zone",
       {{"region_mm", polygon(e.blind_region)},
        {"region_m2", e.blind.region_m2},
        {"blind_m2", e.blind.blind_m2},
        {"from_mm", e.blind.from_mm},
        {"to_mm", e.blind.to_mm}}},
      {"magnification", view_json(e)},
      {"readings", readings_json(e)},
      {"reflectance", e.reflectance},
      {"vehicle", vehicle_json(e.vehicle)}};
  if (e.aim) json["aim"] = aim_json(*e.aim);
  json["notes"] = e.notes;
  json["map"] = map_json(e);
  json["inputs"] = inputs_json(e.inputs);
  json["versions"] = versions_json();
  return json;
}

}  // namespace catoptra::app
