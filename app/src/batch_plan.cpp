// A batch plan (TOML) into cases, each once: the combinations of lenses, materials, poses, wavelengths and
// gaze, or the draws of a sample.
#include <fstream>
#include <iostream>
#include <iterator>
#include <unordered_set>

#include "app/batch.h"
#include "app/src/batch_plan_parts.h"
#include "app/src/file_hash.h"
#include "cad_import/error.h"

namespace catoptra::app {
namespace {

std::string read_all(std::istream& stream) {
  return {std::istreambuf_iterator<char>(stream), {}};
}

struct Plan {
  std::vector<PlanLenses> lenses;
  std::vector<std::vector<PlanPose>> poses;  ///< by table
  std::vector<double> wavelengths_nm;
  std::vector<CaseGaze> gazes;
};

/// Makes the cases of a plan, in its order.
class CaseList {
 public:
  CaseList(BatchPlan& plan, const Plan& parts) : plan_(plan), parts_(parts) {}

  /// Every material in every pose, at every wavelength and gaze.
  void add_combinations(const PlanLenses& group) {
    for_each_lens(group, [&](LensCase lens, const std::string& source, std::size_t) {
      for (const CaseMaterial& material : group.materials) {
        lens.material = material;
        for (const auto& table : parts_.poses)
          for (const PlanPose& pose : table)
            for (const double wavelength_nm : parts_.wavelengths_nm) add(lens, source, pose, wavelength_nm);
      }
    });
  }

  /// Draw i is the i-th of everything. Files and tables are combined: each has the same draws.
  void add_draws(const PlanLenses& group, std::size_t count) {
    const auto add_draw = [&](LensCase lens, const std::string& source, std::size_t i) {
      lens.material = group.materials[i];
      for (const auto& table : parts_.poses) add(lens, source, table[i], parts_.wavelengths_nm[i]);
    };
    for_each_lens(group, [&](const LensCase& lens, const std::string& source, std::size_t at) {
      if (lens.blank)
        add_draw(lens, source, at);
      else
        for (std::size_t i = 0; i < count; ++i) add_draw(lens, source, i);
    });
  }

 private:
  template <typename Visit>
  static void for_each_lens(const PlanLenses& group, Visit visit) {
    LensCase lens;
    lens.front_faces = group.front_faces;
    lens.back_faces = group.back_faces;
    for (std::size_t i = 0; i < group.files.size(); ++i) {
      lens.file_sha256 = group.files[i].sha256;
      visit(lens, group.files[i].path, i);
    }
    for (std::size_t i = 0; i < group.blanks.size(); ++i) {
      lens.blank = group.blanks[i];
      visit(lens, "", i);
    }
  }

  void add(LensCase lens, const std::string& source, const PlanPose& pose, double wavelength_nm) {
    lens.options.mode = pose.mode;
    lens.options.position = pose.position;
    lens.options.object_distance_mm = pose.object_distance_mm;
    lens.panto_deg = pose.panto_deg;
    lens.wrap_deg = pose.wrap_deg;
    lens.options.wavelength_nm = wavelength_nm;
    for (const CaseGaze& gaze : parts_.gazes) {
      lens.gaze = gaze;
      BatchCase entry{"", to_inputs(lens), source};
      entry.key = sha256(entry.inputs);
      if (keys_.insert(entry.key).second)
        plan_.cases.push_back(std::move(entry));
      else
        ++plan_.repeated;
    }
  }

  BatchPlan& plan_;
  const Plan& parts_;
  std::unordered_set<std::string> keys_;
};

/// Throws where there would be none, or too many. Counted before any is made.
void check_count(const Plan& parts, const PlanContext& context) {
  const std::string& name = context.name;
  std::size_t settings = parts.poses.size();
  if (context.sample) {
    settings = case_product(name, settings, context.sample->count);
  } else {
    settings = 0;
    for (const auto& table : parts.poses) settings += table.size();
    settings = case_product(name, settings, parts.wavelengths_nm.size());
  }
  settings = case_product(name, settings, parts.gazes.size());
  std::size_t count = 0;
  for (const PlanLenses& group : parts.lenses) {
    std::size_t lenses = group.files.size();
    if (!context.sample)
      lenses = case_product(name, lenses + group.blanks.size(), group.materials.size());
    else if (!group.blanks.empty())
      lenses = 1;  // the draws are in `settings`
    count += case_product(name, settings, lenses);
    (void)case_product(name, count, 1);
  }
  if (count == 0)
    throw Error(name, "plan", "has no case", "give [[lenses]] with files, or [[prescriptions]]");
}

}  // namespace

std::size_t case_product(const std::string& plan, std::size_t a, std::size_t b) {
  if (b != 0 && a > kMostCases / b)
    throw Error(plan, "plan", "has more than " + std::to_string(kMostCases) + " cases",
                "leave out values, or divide it into several plans");
  return a * b;
}

std::optional<PlanSample> sample_of_table(const TomlTable& table, const PlanContext& context,
                                          std::string_view key, const std::string& path,
                                          const std::string& what) {
  auto own = read_plan_sample(table, key, path, what);
  if (!own) return context.sample;
  if (context.sample)
    table.fail(key, "the sample of the whole plan draws the " + what + " already",
               "leave out one of the two: the plan's draws everything together, this one enters a grid");
  return own;
}

std::filesystem::path plan_path(const TomlTable& table, const PlanContext& context, std::string_view key) {
  const auto text = table.text(key);
  if (!text || text->empty()) table.fail(key, "expected the name of a file");
  return (context.folder / *text).lexically_normal();
}

BatchPlan read_batch_plan_text(std::string_view text, const std::string& name,
                               const std::filesystem::path& folder) {
  const toml::table parsed = parse_toml(text, name);
  const TomlTable root(
      parsed, name, "",
      {"sample", "lenses", "prescriptions", "poses", "gaze", "wavelengths_nm", "wavelength_sample"});
  const PlanContext context{name, folder, read_plan_sample(root, "sample", "sample", "cases")};
  Plan parts;
  parts.poses = read_plan_poses(root, context);
  parts.gazes = read_plan_gaze(root);
  parts.wavelengths_nm = read_plan_wavelengths(root, context);
  parts.lenses = read_plan_lenses(root, context);
  check_count(parts, context);

  BatchPlan plan{name, std::string(text), {}, 0};
  CaseList list(plan, parts);
  for (const PlanLenses& group : parts.lenses)
    context.sample ? list.add_draws(group, context.sample->count) : list.add_combinations(group);
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
