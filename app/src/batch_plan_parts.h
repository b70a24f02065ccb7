// The tables of a batch plan: what each gives to the cross product.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/src/batch_lens_case.h"
#include "app/src/toml_table.h"

namespace catoptra::app {

/// Most cases of a plan.
inline constexpr std::size_t kMostCases = 1000000;

/// Most directions of one case.
inline constexpr std::size_t kMostDirections = 100000;

struct PlanContext {
  std::string name;              ///< the plan, as messages call it
  std::filesystem::path folder;  ///< where relative paths start
};

/// Lenses that share their materials: files or orders, never both.
struct PlanLenses {
  struct File {
    std::string path, sha256;  ///< absolute
  };
  std::vector<File> files;
  std::vector<cad_import::LensBlank> blanks;
  std::vector<CaseMaterial> materials;

  [[nodiscard]] std::size_t count() const { return (files.size() + blanks.size()) * materials.size(); }
};

/// All [[lenses]] and [[prescriptions]], in this order.
[[nodiscard]] std::vector<PlanLenses> read_plan_lenses(const TomlTable& root, const PlanContext& context);

/// How lenses are held: mode, position and angles of a case. One pose of the lensmeter where there is no
/// [[poses]].
[[nodiscard]] std::vector<LensCase> read_plan_poses(const TomlTable& root);

/// [[gaze]]; a grid to 30 degrees every 10 where there is none.
[[nodiscard]] std::vector<CaseGaze> read_plan_gaze(const TomlTable& root);

/// `material` or `materials`, required. Throws where a material is unknown.
[[nodiscard]] std::vector<CaseMaterial> read_materials(const TomlTable& table);

/// Prescriptions of one table, as a grid or a sample.
[[nodiscard]] std::vector<cad_import::LensBlank> read_blanks(const TomlTable& table);

/// The keys that read_blanks reads.
[[nodiscard]] std::vector<std::string> blank_keys();

/// Throws where a * b would be more cases than a plan may have; returns the product.
[[nodiscard]] std::size_t case_product(const std::string& plan, std::size_t a, std::size_t b);

}  // namespace catoptra::app
