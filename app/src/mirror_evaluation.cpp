#include "app/src/mirror_evaluation.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "app/src/mirror_vehicle.h"
#include "app/src/nearest_name.h"
#include "tessellate/optic_mesh.h"

namespace catoptra::app {
namespace {

/// Distance of a bar spherometer's feet where neither rule nor user says.
constexpr double kSpherometerBase_mm = 38;

/// Outlines are measured on a mesh of our own, whatever the scene draws with: chords within 0.005 mm of the
/// border.
constexpr double kOutlineChord_mm = 0.005;

/// The ground on which a blind zone is looked for: a lane beside the vehicle, from the ocular points on.
constexpr double kBlindLength_mm = 30000, kBlindWidth_mm = 4000;

std::size_t find_mirror(const SceneFile& scene, const std::string& name) {
  std::vector<std::string> names;
  std::vector<std::size_t> mirrors;
  for (std::size_t i = 0; i < scene.scene.optics.size(); ++i) {
    if (scene.scene.optics[i].kind != optics::OpticKind::mirror) continue;
    names.push_back(scene.scene.optics[i].name);
    mirrors.push_back(i);
    if (names.back() == name) return i;
  }
  const std::string& file = scene.scene.file;
  if (mirrors.empty()) throw Error(file, "", "the scene has no [[mirror]]");
  if (!name.empty())
    throw Error(file, "mirror '" + name + "'", "the scene has no such mirror", hint_for_unknown(name, names));
  if (mirrors.size() > 1)
    throw Error(file, "", "the scene has several mirrors",
                "choose one with --mirror: " + list_of_names(names));
  return mirrors[0];
}

optics::Optic finely_meshed(const optics::Optic& mirror, std::vector<std::string>& notes) {
  optics::Optic fine = mirror;
  tessellate::TessellationOptions options;
  options.chord_mm = kOutlineChord_mm;
  auto meshed = tessellate::tessellate_optic(mirror.faces, options);
  fine.mesh = meshed.mesh.arrays();
  for (const auto& face : meshed.unmeshed)
    notes.push_back("Face " + face.id + " could not be meshed (" + face.reason + ") and is left out.");
  return fine;
}

double luminance(const glm::vec3& rgb) {
  return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b;
}

void measure_glass(const optics::MirrorGlass& glass, const MirrorEvaluationOptions& options,
                   MirrorEvaluation& e) {
  e.glass = glass.frame();
  e.glass_low_mm = glass.low_mm();
  e.glass_high_mm = glass.high_mm();
  e.glass_outlines.assign(glass.outlines().begin(), glass.outlines().end());
  e.map = optics::map_radii(glass);
  double base = kSpherometerBase_mm;
  if (options.rule) {
    const RuleFigure* ten = find_figure(*options.rule, "ten_readings", "", {});
    const RuleFigure* three = find_figure(*options.rule, "three_readings", "", {});
    e.ten_readings = ten != nullptr;
    if (ten || three) base = *(ten ? ten : three)->value;
  }
  base = options.spherometer_base_mm.value_or(base);
  const bool partly = e.has_aspheric_part() && e.map.spherical_share > 0;
  const auto part = [&e](const optics::GlassPoint& p) { return optics::in_spherical_part(e.map, p); };
  e.readings = e.ten_readings ? optics::readings_fmvss(glass, base)
                              : optics::readings_r46(glass, base, partly ? optics::GlassPart(part) : nullptr);
  if (partly && !e.ten_readings)
    e.notes.push_back("Part of the glass is aspheric: radii are read on the arc within the spherical part.");
  if (e.readings.base_mm < base)
    e.notes.push_back("The glass is too small for the spherometer's base, which was shortened.");
}

void measure_view(const optics::MirrorGlass& glass, const MirrorEvaluationOptions& options,
                  const optics::SightOptions& sight, MirrorEvaluation& e) {
  glm::dvec3 middle{0};
  for (const glm::dvec3& eye : sight.eyes_mm) middle += eye / double(sight.eyes_mm.size());
  const glm::dvec3 eye = sight.pose.to_glass(middle);
  e.view = optics::summarize_view(glass, e.map, eye, options.object_distance_mm);
  for (const optics::GlassPoint& point : e.map.points)
    e.views.push_back(optics::mirror_view(point, eye, options.object_distance_mm));
}

/// Without a rule: the ground that the outlines span.
ZonePart around_outlines(const MirrorEvaluation& e) {
  glm::dvec2 low{1e300}, high{-1e300};
  for (const auto& outline : e.outlines)
    for (const glm::dvec2& p : outline) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  ZonePart part;
  high.x = std::min(high.x, e.vehicle.far_mm);
  if (low.x < high.x) part.polygon = {low, {low.x, high.y}, high, {high.x, low.y}};
  return part;
}

ZonePlacement placement_for(const RuleFile& rule, const SceneFile& scene, const VehicleSummary& vehicle) {
  if (needs_median_plane(rule) && !vehicle.median_left_mm)
    throw Error(scene.scene.file, "evaluation.median", rule.id + " refers to the vehicle's median plane",
                "give a point of it, or left_side and right_side");
  return {vehicle.side_left_mm.value_or(0), vehicle.mirror_left ? 1.0 : -1.0,
          vehicle.median_left_mm.value_or(0), vehicle.far_mm};
}

std::vector<optics::GroundPolygon> polygons_of(const std::vector<ZonePart>& zone) {
  std::vector<optics::GroundPolygon> polygons;
  for (const ZonePart& part : zone)
    if (!part.polygon.empty()) polygons.push_back(part.polygon);
  return polygons;
}

/// rotate_deg of a rotation: about x, then y, then z.
glm::dvec3 rotate_deg_of(const glm::dmat3& r) {
  const double y = std::asin(std::clamp(-r[0][2], -1.0, 1.0));
  if (std::abs(r[0][2]) > 1 - 1e-12)  // x and z turn about the same axis: all of it is given to z
    return glm::degrees(glm::dvec3(0, y, std::atan2(-r[1][0], r[1][1])));
  return glm::degrees(glm::dvec3(std::atan2(r[1][2], r[2][2]), y, std::atan2(r[0][1], r[0][0])));
}

std::vector<InputFile> inputs_of(const SceneFile& scene, std::size_t optic, const MirrorVehicle& vehicle,
                                 const std::optional<RuleFile>& rule) {
  std::vector<std::filesystem::path> files{scene.path};
  const auto add = [&](const auto& more) { files.insert(files.end(), more.begin(), more.end()); };
  add(scene.optic_sources[optic].files);
  add(vehicle.files);
  if (rule) files.push_back(rule->path);
  return input_files(files);
}

AimSummary aim_mirror(const SceneFile& scene, std::size_t optic, const optics::MirrorGlass& glass,
                      const optics::AimOptions& options, const std::vector<optics::GroundPolygon>& zone,
                      const optics::SightOptions& sight) {
  AimSummary summary{
      optics::solve_aim(glass, sight, zone, options), options.yaw_limit_rad, options.pitch_limit_rad, {}, {}};
  const optics::MirrorPose& pose = summary.aim.pose;
  const glm::dmat4& placement = scene.optic_sources[optic].placement;
  summary.rotate_deg = rotate_deg_of(pose.rotation * glm::dmat3(placement));
  summary.translate = pose.to_world(glm::dvec3(placement[3])) / scene.unit_mm;
  return summary;
}

std::vector<optics::EdgeMargin> margins_on_road(const optics::MirrorSight& sight,
                                                const std::vector<optics::GroundPolygon>& zone,
                                                double far_mm) {
  auto margins = optics::field_margins(sight, zone);
  std::erase_if(margins, [&](const auto& m) { return m.from_mm.x >= far_mm && m.to_mm.x >= far_mm; });
  return margins;
}

void measure_road(const optics::MirrorGlass& glass, const optics::SightOptions& options,
                  double direct_view_rad, MirrorEvaluation& e) {
  const optics::MirrorSight sight(glass, options);
  for (std::size_t eye = 0; eye < options.eyes_mm.size(); ++eye)
    e.outlines.push_back(optics::field_outline(sight, eye, e.vehicle.far_mm));
  if (!e.zone_required) e.zone = {around_outlines(e)};
  const auto zone = polygons_of(e.zone);
  if (!zone.empty()) {
    optics::RegionOptions region;
    if (!e.zone_required) region.cell_mm = 1000;
    e.field = optics::measure_field(sight, zone, region);
    if (e.zone_required) e.margins = margins_on_road(sight, zone, e.vehicle.far_mm);
    if (e.zone_required && e.has_aspheric_part() && e.map.spherical_share > 0) {
      optics::SightOptions spherical = options;
      spherical.part = [&e](const optics::GlassPoint& p) { return optics::in_spherical_part(e.map, p); };
      e.spherical_field = optics::measure_field(optics::MirrorSight(glass, spherical), zone);
    }
  }
  e.horizon_seen = (sight.state_far(-options.road.forward) & optics::kReflectedByAny) != 0;

  optics::SightOptions single = options;
  single.eyes_mm = {(options.eyes_mm.front() + options.eyes_mm.back()) * 0.5};
  const optics::MirrorSight middle(glass, single);
  e.horizon = optics::horizon_angle(middle);
  e.road_begins_mm = optics::road_begins_mm(middle, e.vehicle.median_left_mm.value_or(0), e.vehicle.far_mm);

  optics::SightOptions direct = options;
  direct.direct_limit_rad = direct_view_rad;
  const double side = e.vehicle.side_left_mm.value_or(0), out = e.vehicle.mirror_left ? 1 : -1;
  e.blind_region = {{0, side},
                    {0, side + out * kBlindWidth_mm},
                    {kBlindLength_mm, side + out * kBlindWidth_mm},
                    {kBlindLength_mm, side}};
  e.blind = optics::measure_blind_zone(optics::MirrorSight(glass, direct), e.blind_region);
}

}  // namespace

bool MirrorEvaluation::passes() const {
  return !clauses.empty() &&
         std::all_of(clauses.begin(), clauses.end(), [](const auto& c) { return c.pass; });
}

bool MirrorEvaluation::rests_on_unverified() const {
  return std::any_of(clauses.begin(), clauses.end(),
                     [](const auto& c) { return c.certainty == Certainty::unverified; });
}

MirrorEvaluation evaluate_mirror(const SceneFile& scene, const MirrorEvaluationOptions& options) {
  MirrorEvaluation e;
  const std::size_t optic = find_mirror(scene, options.mirror);
  const optics::Optic& mirror = scene.scene.optics[optic];
  e.scene = scene.scene.file;
  e.mirror = mirror.name;
  e.reflectance = luminance(mirror.reflectance);
  const optics::MirrorGlass glass(finely_meshed(mirror, e.notes), scene.scene.camera.up);
  measure_glass(glass, options, e);

  const MirrorVehicle vehicle = make_mirror_vehicle(scene, optic, glass, options);
  e.vehicle = vehicle.summary;
  e.notes.insert(e.notes.end(), vehicle.notes.begin(), vehicle.notes.end());
  e.inputs = inputs_of(scene, optic, vehicle, options.rule);
  if (options.rule) {
    e.rule_id = options.rule->id;
    e.rule_title = options.rule->title;
    e.rule_edition = options.rule->edition;
    e.rule_note = options.rule->note;
    e.zone = required_zone(*options.rule, placement_for(*options.rule, scene, e.vehicle));
    e.zone_required = !e.zone.empty();
  }
  optics::SightOptions sight;
  sight.eyes_mm = e.vehicle.eyes_mm;
  sight.road = e.vehicle.road;
  sight.vehicle = vehicle.body.get();
  sight.attached = vehicle.attached.get();
  if (options.aim) {
    if (!e.zone_required)
      throw Error(scene.scene.file, "mirror '" + e.mirror + "'", "there is no zone to aim at",
                  "give --rule with one that requires a field on the ground");
    e.aim = aim_mirror(scene, optic, glass, *options.aim, polygons_of(e.zone), sight);
    sight.pose = e.aim->aim.pose;
  }
  measure_view(glass, options, sight, e);
  measure_road(glass, sight, scene.evaluation.direct_view_rad, e);
  if (options.rule) e.clauses = judge_mirror(*options.rule, e);
  for (ZonePart& part : e.zone) part.figure = nullptr;  // the rule may go before the result does
  return e;
}

}  // namespace catoptra::app
