// Batch plans from text, and what comes of them.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/batch.h"
#include "cad_import/error.h"

namespace catoptra::test {

/// The plan of that text, in the current folder.
inline app::BatchPlan read(const std::string& text) {
  return app::read_batch_plan_text(text, "plan.toml", std::filesystem::current_path());
}

/// What is said of a plan that is refused.
inline std::string refusal(const std::string& text) {
  try {
    (void)read(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

/// A number of the inputs, case by case.
inline std::vector<double> column(const app::BatchPlan& plan, const std::string& name) {
  std::vector<double> values;
  for (const auto& entry : plan.cases)
    values.push_back(nlohmann::json::parse(entry.inputs).at(name).get<double>());
  return values;
}

}  // namespace catoptra::test
