// [[poses]], [[gaze]] and wavelengths: how, where and in which light a lens is measured.
#include "app/src/batch_plan_parts.h"
#include "cad_import/error.h"
#include "optics/dispersion.h"

namespace catoptra::app {
namespace {

/// Visible light and a little more, where the catalogue's dispersion holds.
constexpr Range kWavelengths{380, 780};

/// Beyond it a lens does not reach, and the tangent of the angle grows without bound.
constexpr double kWidestGaze_deg = 80;

/// Beyond it (1 rad) nobody looks through a lens.
constexpr Range kTilt_deg{-57, 57};

CaseGaze read_gaze(const TomlTable& table) {
  CaseGaze gaze;
  const toml::node* directions = table.node("directions_deg");
  if (!directions) {
    gaze.max_deg = table.number("max_deg", {0, kWidestGaze_deg}).value_or(gaze.max_deg);
    gaze.step_deg = table.number("step_deg", Range::positive()).value_or(gaze.step_deg);
    const double a_side = 2 * gaze.max_deg / gaze.step_deg + 1;
    if (!(a_side * a_side <= double(kMostDirections)))
      table.fail("step_deg", "the grid has more than " + std::to_string(kMostDirections) + " directions");
    return gaze;
  }
  if (table.has("max_deg") || table.has("step_deg"))
    table.fail("directions_deg", "directions_deg excludes max_deg and step_deg");
  const toml::array* array = directions->as_array();
  if (!array || array->empty())
    table.fail("directions_deg", "expected a list of directions", "[[0, 0], [20, 0]]");
  if (array->size() > kMostDirections)
    table.fail("directions_deg", "has more than " + std::to_string(kMostDirections) + " directions");
  for (const toml::node& direction : *array) {
    const auto angles = table.numbers_of(direction, "directions_deg", 2, {-kWidestGaze_deg, kWidestGaze_deg});
    gaze.directions_deg.emplace_back(angles[0] + 0.0, angles[1] + 0.0);
  }
  return gaze;
}

/// One number of a pose.
struct PoseNumber {
  const char* key;
  double& (*value)(PlanPose&);
  Range range;
};
const PoseNumber kPoseNumbers[] = {
    {"rotation_centre_mm", [](PlanPose& p) -> double& { return p.position.rotation_centre_mm; },
     Range::positive()},
    {"vertex_distance_mm", [](PlanPose& p) -> double& { return p.position.vertex_distance_mm; },
     Range::positive()},
    {"panto_deg", [](PlanPose& p) -> double& { return p.panto_deg; }, kTilt_deg},
    {"wrap_deg", [](PlanPose& p) -> double& { return p.wrap_deg; }, kTilt_deg},
    {"object_distance_mm", [](PlanPose& p) -> double& { return p.object_distance_mm; }, Range::positive()}};

struct PoseSweep {
  const PoseNumber* number;
  Sweep sweep;
};

std::vector<PlanPose> read_poses(const TomlTable& table, const PlanContext& context) {
  PlanPose base;
  if (table.choice("mode", {"lensmeter", "as-worn"}) == "as-worn")
    base.mode = optics::EvaluationMode::as_worn;
  if (table.choice("eye", {"right", "left"}) == "left") base.position.eye = optics::Eye::left;
  const auto sample = sample_of_table(table, context, "sample", "poses.sample", "poses");
  std::vector<PoseSweep> sweeps;
  for (const PoseNumber& number : kPoseNumbers)
    if (auto sweep = read_sweep(table, number.key, number.range, sample.has_value()))
      sweeps.push_back({&number, std::move(*sweep)});
  if (!sample)
    return grid_of(context.name, base, sweeps,
                   [](PlanPose& pose, const PoseSweep& s, double value) { s.number->value(pose) = value; });
  std::vector<PlanPose> poses(sample->count, base);
  for (const PoseSweep& s : sweeps) {
    const auto values = values_of(s.sweep, sample, s.number->key);
    for (std::size_t i = 0; i < poses.size(); ++i) s.number->value(poses[i]) = values[i];
  }
  return poses;
}

}  // namespace

std::vector<std::vector<PlanPose>> read_plan_poses(const TomlTable& root, const PlanContext& context) {
  std::vector<std::vector<PlanPose>> poses;
  for (const toml::table* found : root.tables("poses"))
    poses.push_back(read_poses(TomlTable(*found, context.name, "poses",
                                         {"mode", "eye", "sample", "rotation_centre_mm", "vertex_distance_mm",
                                          "panto_deg", "wrap_deg", "object_distance_mm"}),
                               context));
  if (poses.empty()) poses.emplace_back(context.sample ? context.sample->count : 1);
  return poses;
}

std::vector<CaseGaze> read_plan_gaze(const TomlTable& root) {
  std::vector<CaseGaze> result;
  for (const toml::table* found : root.tables("gaze"))
    result.push_back(
        read_gaze(TomlTable(*found, root.file(), "gaze", {"max_deg", "step_deg", "directions_deg"})));
  if (result.empty()) result.emplace_back();
  return result;
}

std::vector<double> read_plan_wavelengths(const TomlTable& root, const PlanContext& context) {
  const auto sample = sample_of_table(root, context, "wavelength_sample", "wavelength_sample", "wavelengths");
  const auto sweep = read_sweep(root, "wavelengths_nm", kWavelengths, sample.has_value());
  if (!sweep && root.has("wavelength_sample"))
    root.fail("wavelength_sample", "there is no wavelengths_nm to draw from",
              "wavelengths_nm = { from = 400, to = 700 }");
  return values_of(sweep.value_or(Sweep{{optics::EvaluationOptions{}.wavelength_nm}, 0, 0, {}}), sample,
                   "wavelengths_nm");
}

}  // namespace catoptra::app
