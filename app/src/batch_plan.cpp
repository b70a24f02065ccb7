// A batch plan (TOML) into cases: lenses x materials x poses x wavelengths x gaze, each case once.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <unordered_set>

#include "app/batch.h"
#include "app/src/batch_plan_parts.h"
#include "app/src/batch_sweep.h"
#include "app/src/file_hash.h"
#include "cad_import/error.h"
#include "optics/dispersion.h"

namespace catoptra::app {
namespace {

/// Visible light and a little more, where the catalogue's dispersion holds.
constexpr Range kWavelengths{380, 780};

/// Beyond it a lens does not reach, and the tangent of the angle grows without bound.
constexpr double kWidestGaze_deg = 80;

std::string read_all(std::istream& stream) {
  return {std::istreambuf_iterator<char>(stream), {}};
}

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

/// One key of a pose and where it goes.
struct PoseSweep {
  const char* key;
  double* value;
  Range range;
  Sweep sweep;
};

void read_pose(const TomlTable& table, std::vector<LensCase>& poses) {
  LensCase pose;
  optics::WearingPosition& position = pose.options.position;
  const bool worn = table.choice("mode", {"lensmeter", "as-worn"}).value_or("lensmeter") == "as-worn";
  pose.options.mode = worn ? optics::EvaluationMode::as_worn : optics::EvaluationMode::lensmeter;
  position.eye = table.choice("eye", {"right", "left"}).value_or("right") == "right" ? optics::Eye::right
                                                                                     : optics::Eye::left;
  const Range angle{-57, 57};
  std::vector<PoseSweep> sweeps{
      {"rotation_centre_mm", &position.rotation_centre_mm, Range::positive(), {}},
      {"vertex_distance_mm", &position.vertex_distance_mm, Range::positive(), {}},
      {"panto_deg", &pose.panto_deg, angle, {}},
      {"wrap_deg", &pose.wrap_deg, angle, {}},
      {"object_distance_mm", &pose.options.object_distance_mm, Range::positive(), {}}};
  std::erase_if(sweeps, [&](PoseSweep& s) {
    auto sweep = read_sweep(table, s.key, s.range, false);
    if (sweep) s.sweep = std::move(*sweep);
    return !sweep;
  });
  std::size_t count = 1;
  for (const PoseSweep& s : sweeps) count = case_product(table.file(), count, s.sweep.values.size());
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = i;  // the last key runs fastest
    for (auto s = sweeps.rbegin(); s != sweeps.rend(); ++s) {
      *s->value = s->sweep.values[rest % s->sweep.values.size()];
      rest /= s->sweep.values.size();
    }
    poses.push_back(pose);
  }
}

/// Enters the cases of `lenses` in every pose, at every wavelength and gaze.
class CaseList {
 public:
  explicit CaseList(BatchPlan& plan) : plan_(plan) {}
  void add(const LensCase& lens_case, const std::string& source) {
    BatchCase entry{"", to_inputs(lens_case), source};
    entry.key = sha256(entry.inputs);
    if (keys_.insert(entry.key).second)
      plan_.cases.push_back(std::move(entry));
    else
      ++plan_.repeated;
  }

 private:
  BatchPlan& plan_;
  std::unordered_set<std::string> keys_;
};

}  // namespace

std::vector<LensCase> read_plan_poses(const TomlTable& root) {
  std::vector<LensCase> poses;
  for (const toml::table* found : root.tables("poses"))
    read_pose(TomlTable(*found, root.file(), "poses",
                        {"mode", "eye", "rotation_centre_mm", "vertex_distance_mm", "panto_deg", "wrap_deg",
                         "object_distance_mm"}),
              poses);
  if (poses.empty()) poses.emplace_back();
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

BatchPlan read_batch_plan_text(std::string_view text, const std::string& name,
                               const std::filesystem::path& folder) {
  const toml::table parsed = parse_toml(text, name);
  const TomlTable root(parsed, name, "", {"lenses", "prescriptions", "poses", "gaze", "wavelengths_nm"});
  const auto poses = read_plan_poses(root);
  const auto gazes = read_plan_gaze(root);
  const Sweep wavelengths = read_sweep(root, "wavelengths_nm", kWavelengths, false)
                                .value_or(Sweep{{optics::EvaluationOptions{}.wavelength_nm}});
  const auto lenses = read_plan_lenses(root, {name, folder});

  // Counted before any is made.
  std::size_t settings = case_product(name, poses.size(), gazes.size()), count = 0;
  settings = case_product(name, settings, wavelengths.values.size());
  for (const PlanLenses& group : lenses) {
    count += case_product(name, settings, group.count());
    (void)case_product(name, count, 1);
  }
  if (count == 0)
    throw Error(name, "plan", "has no case", "give [[lenses]] with files, or [[prescriptions]]");

  BatchPlan plan{name, std::string(text), {}, 0};
  CaseList list(plan);
  const auto add_settings = [&](LensCase lens_case, const std::string& source) {
    for (const LensCase& pose : poses)
      for (const double wavelength : wavelengths.values)
        for (const CaseGaze& gaze : gazes) {
          lens_case.options = pose.options;
          lens_case.panto_deg = pose.panto_deg;
          lens_case.wrap_deg = pose.wrap_deg;
          lens_case.options.wavelength_nm = wavelength;
          lens_case.gaze = gaze;
          list.add(lens_case, source);
        }
  };
  for (const PlanLenses& group : lenses) {
    LensCase lens_case;
    for (const auto& file : group.files) {
      lens_case.file_sha256 = file.sha256;
      for (const CaseMaterial& material : group.materials) {
        lens_case.material = material;
        add_settings(lens_case, file.path);
      }
    }
    for (const auto& blank : group.blanks) {
      lens_case.blank = blank;
      for (const CaseMaterial& material : group.materials) {
        lens_case.material = material;
        add_settings(lens_case, "");
      }
    }
  }
  return plan;
}

BatchPlan read_batch_plan(const std::filesystem::path& file) {
  if (file == "-")
    return read_batch_plan_text(read_all(std::cin), "standard input", std::filesystem::current_path());
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw Error(file.string(), "", "is a folder, not a plan", "name the .toml file in it");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(file.string(), "", "cannot open the plan", "does it exist and may you read it?");
  return read_batch_plan_text(read_all(stream), file.string(), std::filesystem::absolute(file).parent_path());
}

}  // namespace catoptra::app
