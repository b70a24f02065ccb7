#include "app/src/mirror_vehicle.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "app/src/nearest_name.h"

namespace catoptra::app {
namespace {

/// Height of the ocular points above the R point. Source: UN R46, as quoted in public source code.
constexpr double kOcularHeight_mm = 635;

/// The body counts from here on behind the mirror's rearmost place: housings end before.
constexpr double kBehindMirror_mm = 100;

bool belongs_to(const SurroundingSource& source, std::size_t optic) {
  return std::find(source.optics.begin(), source.optics.end(), optic) != source.optics.end();
}

glm::dvec3 forward_of(const SceneFile& scene) {
  if (scene.evaluation.forward) return *scene.evaluation.forward;
  const glm::dvec3 up = glm::normalize(scene.scene.camera.up);
  return std::abs(up.y) > 0.7 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
}

glm::dvec3 eye_of(const SceneFile& scene, const MirrorEvaluationOptions& options) {
  const EvaluationSettings& settings = scene.evaluation;
  if (options.eye_mm) return *options.eye_mm;
  if (!settings.ocular_points_mm.empty())
    return (settings.ocular_points_mm[0] + settings.ocular_points_mm[1]) * 0.5;
  if (settings.r_point_mm)
    return *settings.r_point_mm + kOcularHeight_mm * glm::normalize(scene.scene.camera.up);
  return settings.eye_mm.value_or(scene.scene.camera.eye_mm);
}

std::vector<glm::dvec3> ocular_points(const SceneFile& scene, const MirrorEvaluationOptions& options,
                                      const glm::dvec3& middle, const glm::dvec3& left) {
  const EvaluationSettings& settings = scene.evaluation;
  if (!options.eye_mm && !settings.ocular_points_mm.empty()) {
    auto points = settings.ocular_points_mm;
    if (glm::dot(points[0], left) < glm::dot(points[1], left)) std::swap(points[0], points[1]);
    return points;
  }
  if (settings.ocular_spacing_mm == 0) return {middle};
  return {middle + settings.ocular_spacing_mm / 2 * left, middle - settings.ocular_spacing_mm / 2 * left};
}

/// Which surroundings are in the way: those named, else all; the rest of the mirror's own file always.
std::vector<std::size_t> body_of(const SceneFile& scene, std::size_t optic) {
  std::vector<std::string> names;
  for (const SurroundingSource& source : scene.surrounding_sources)
    if (!source.name.empty()) names.push_back(source.name);
  for (const std::string& wanted : scene.evaluation.vehicle)
    if (std::find(names.begin(), names.end(), wanted) == names.end())
      throw Error(scene.scene.file, "evaluation.vehicle", "no surrounding is called '" + wanted + "'",
                  hint_for_unknown(wanted, names));
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < scene.surrounding_sources.size(); ++i) {
    const SurroundingSource& source = scene.surrounding_sources[i];
    const auto& named = scene.evaluation.vehicle;
    if (named.empty() || belongs_to(source, optic) ||
        std::find(named.begin(), named.end(), source.name) != named.end())
      chosen.push_back(i);
  }
  return chosen;
}

/// Outermost place, to the mirror's side, of the vehicle behind the mirror.
std::optional<double> outermost_left_mm(const SceneFile& scene, const std::vector<std::size_t>& body,
                                        std::size_t optic, const optics::RoadFrame& road, bool left) {
  double rearmost = -1e300;
  for (const auto& vertex : scene.scene.optics[optic].mesh.vertices)
    rearmost = std::max(rearmost, road.coordinates(vertex.position_mm).x);
  std::optional<double> outermost;
  for (const std::size_t i : body) {
    if (belongs_to(scene.surrounding_sources[i], optic)) continue;
    for (const glm::vec3& position : scene.scene.surroundings[i].positions) {
      const glm::dvec3 at = road.coordinates(glm::dvec3(position));
      if (at.x < rearmost + kBehindMirror_mm) continue;
      if (!outermost || (left ? at.y > *outermost : at.y < *outermost)) outermost = at.y;
    }
  }
  return outermost;
}

void set_planes(const SceneFile& scene, const std::vector<std::size_t>& body, std::size_t optic,
                const optics::MirrorGlass& glass, MirrorVehicle& vehicle) {
  const EvaluationSettings& settings = scene.evaluation;
  VehicleSummary& summary = vehicle.summary;
  const auto left_of = [&](const glm::dvec3& p) { return summary.road.coordinates(p).y; };
  if (settings.median_mm)
    summary.median_left_mm = left_of(*settings.median_mm);
  else if (settings.left_side_mm && settings.right_side_mm)
    summary.median_left_mm = (left_of(*settings.left_side_mm) + left_of(*settings.right_side_mm)) / 2;
  const double mirror_left = left_of(glass.frame().center_mm);
  summary.mirror_left = mirror_left > summary.median_left_mm.value_or(0);
  summary.driver_left = settings.driver_left;
  if (!summary.driver_left && summary.median_left_mm) summary.driver_left = *summary.median_left_mm < 0;

  const auto& side = summary.mirror_left ? settings.left_side_mm : settings.right_side_mm;
  const std::string key = summary.mirror_left ? "left_side" : "right_side";
  if (side) {
    summary.side_left_mm = left_of(*side);
    return;
  }
  if (!settings.vehicle.empty())
    summary.side_left_mm = outermost_left_mm(scene, body, optic, summary.road, summary.mirror_left);
  if (summary.side_left_mm) {
    summary.side_from = SidePlane::vehicle;
    vehicle.notes.push_back(
        "The side plane touches the outermost place of the vehicle's meshes behind the mirror; evaluation." +
        key + " would set it.");
    return;
  }
  double inner = summary.mirror_left ? 1e300 : -1e300;
  for (const auto& vertex : glass.optic().mesh.vertices) {
    const double at = left_of(vertex.position_mm);
    inner = summary.mirror_left ? std::min(inner, at) : std::max(inner, at);
  }
  summary.side_left_mm = inner;
  summary.side_from = SidePlane::mirror;
  vehicle.notes.push_back("The side plane is assumed at the mirror's inner end; evaluation." + key +
                          " would set it.");
}

void add_bodies(const SceneFile& scene, const std::vector<std::size_t>& body, std::size_t optic,
                MirrorVehicle& vehicle) {
  for (const std::size_t i : body) {
    const SurroundingSource& source = scene.surrounding_sources[i];
    vehicle.files.push_back(source.file);
    // What is left of the file of several mirrors does not turn with one of them.
    auto& target = belongs_to(source, optic) && source.optics.size() == 1 ? vehicle.attached : vehicle.body;
    if (!target) target = std::make_unique<optics::RayScene>();
    target->add_surroundings(scene.scene.surroundings[i]);
    vehicle.summary.obstructions.push_back(source.name.empty() ? "rim of a lens" : source.name);
  }
  if (vehicle.body) vehicle.body->commit();
  if (vehicle.attached) vehicle.attached->commit();
}

}  // namespace

MirrorVehicle make_mirror_vehicle(const SceneFile& scene, std::size_t optic, const optics::MirrorGlass& glass,
                                  const MirrorEvaluationOptions& options) {
  MirrorVehicle vehicle;
  const glm::dvec3 middle = eye_of(scene, options);
  VehicleSummary& summary = vehicle.summary;
  try {
    summary.road =
        optics::make_road_frame(forward_of(scene), scene.scene.camera.up, scene.evaluation.ground_mm, middle);
  } catch (const Error& error) {
    throw Error(scene.scene.file, "evaluation." + error.entity(), error.reason(), error.hint());
  }
  if (!scene.evaluation.forward)
    vehicle.notes.push_back("The direction of travel is assumed; evaluation.forward would set it.");
  if (!(glm::dot(middle - summary.road.origin_mm, summary.road.up) > 0))
    throw Error(scene.scene.file, "evaluation.ground", "the eye is not above the ground",
                "ground is any point of the road, in the scene's units");
  summary.eyes_mm = ocular_points(scene, options, middle, summary.road.left);
  summary.far_mm = options.far_mm.value_or(scene.evaluation.far_mm);
  const auto body = body_of(scene, optic);
  const bool other_things = std::any_of(body.begin(), body.end(), [&](std::size_t i) {
    return !belongs_to(scene.surrounding_sources[i], optic);
  });
  if (scene.evaluation.vehicle.empty() && other_things)
    vehicle.notes.push_back(
        "All surroundings count as the vehicle; evaluation.vehicle would name those that are.");
  set_planes(scene, body, optic, glass, vehicle);
  add_bodies(scene, body, optic, vehicle);
  return vehicle;
}

}  // namespace catoptra::app
