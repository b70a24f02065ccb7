// The tables of a batch plan: what each gives to the cases.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/src/batch_lens_case.h"
#include "app/src/batch_sweep.h"
#include "app/src/toml_table.h"

namespace catoptra::app {

/// Most cases of a plan.
inline constexpr std::size_t kMostCases = 1000000;

/// Most directions of one case.
inline constexpr std::size_t kMostDirections = 100000;

struct PlanContext {
  std::string name;              ///< the plan, as messages call it
  std::filesystem::path folder;  ///< where relative paths start
  /// Of the whole plan: every list below then has one value per draw, which belong together. Else each list
  /// is a grid or a sample of its own, and cases are all their combinations.
  std::optional<PlanSample> sample;
};

/// Lenses that share their materials: files or orders, never both.
struct PlanLenses {
  struct File {
    std::string path, sha256;  ///< absolute
  };
  std::vector<File> files;
  std::vector<FaceSelector> front_faces, back_faces;  ///< of each file; empty: recognised
  std::vector<cad_import::LensBlank> blanks;          ///< as PlanContext::sample says
  std::vector<CaseMaterial> materials;                ///< as PlanContext::sample says
};

/// How a lens is held.
struct PlanPose {
  optics::EvaluationMode mode = optics::EvaluationMode::lensmeter;
  optics::WearingPosition position;  ///< but for its two angles, which are
  double panto_deg = 0, wrap_deg = 0;
  double object_distance_mm = optics::EvaluationOptions{}.object_distance_mm;
};

/// All [[lenses]] and [[prescriptions]], in this order.
[[nodiscard]] std::vector<PlanLenses> read_plan_lenses(const TomlTable& root, const PlanContext& context);

/// The poses of each [[poses]], as PlanContext::sample says; the lensmeter where there is none.
[[nodiscard]] std::vector<std::vector<PlanPose>> read_plan_poses(const TomlTable& root,
                                                                 const PlanContext& context);

/// `wavelengths_nm`, as PlanContext::sample says; d where it is absent.
[[nodiscard]] std::vector<double> read_plan_wavelengths(const TomlTable& root, const PlanContext& context);

/// [[gaze]]; a grid to 30 degrees every 10 where there is none.
[[nodiscard]] std::vector<CaseGaze> read_plan_gaze(const TomlTable& root);

/// The keys of a table that read_materials reads.
inline constexpr std::string_view kMaterialKeys[] = {"material", "materials", "material_sample", "catalogue"};

/// `material` or `materials`, required. Throws where a material is unknown.
[[nodiscard]] std::vector<CaseMaterial> read_materials(const TomlTable& table, const PlanContext& context,
                                                       const std::string& path);

/// Prescriptions of one table, as a grid or a sample.
[[nodiscard]] std::vector<cad_import::LensBlank> read_blanks(const TomlTable& table,
                                                             const PlanContext& context);

/// The keys that read_blanks reads.
[[nodiscard]] std::vector<std::string> blank_keys();

/// The sample that draws a table: its own under `key` or the plan's, which exclude each other.
[[nodiscard]] std::optional<PlanSample> sample_of_table(const TomlTable& table, const PlanContext& context,
                                                        std::string_view key, const std::string& path,
                                                        const std::string& what);

/// A file that a plan names, absolute. Throws where `key` is no name.
[[nodiscard]] std::filesystem::path plan_path(const TomlTable& table, const PlanContext& context,
                                              std::string_view key);

/// Throws where a * b would be more cases than a plan may have; returns the product.
[[nodiscard]] std::size_t case_product(const std::string& plan, std::size_t a, std::size_t b);

/// The cross product of `sweeps`, each with a `sweep`, over `base`; the last runs fastest. `set` gives one
/// its value. Throws as case_product().
template <typename Item, typename KeySweep, typename Set>
[[nodiscard]] std::vector<Item> grid_of(const std::string& plan, const Item& base,
                                        const std::vector<KeySweep>& sweeps, const Set& set) {
  std::size_t count = 1;
  for (const KeySweep& s : sweeps) count = case_product(plan, count, s.sweep.values.size());
  std::vector<Item> items(count, base);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = i;
    for (auto s = sweeps.rbegin(); s != sweeps.rend(); ++s) {
      set(items[i], *s, s->sweep.values[rest % s->sweep.values.size()]);
      rest /= s->sweep.values.size();
    }
  }
  return items;
}

}  // namespace catoptra::app
