// Values that several of the JSON writers share.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "app/src/file_hash.h"

namespace catoptra::app {

/// JSON has neither infinity nor not-a-number: null stands for both.
[[nodiscard]] inline nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

/// Null also where there is no number.
[[nodiscard]] inline nlohmann::ordered_json number_or_null(const std::optional<double>& value) {
  return value ? number_or_null(*value) : nlohmann::ordered_json(nullptr);
}

/// `inputs` of the reports: file and sha256 each.
[[nodiscard]] inline nlohmann::ordered_json inputs_json(std::span<const InputFile> inputs) {
  auto result = nlohmann::ordered_json::array();
  for (const InputFile& input : inputs) result.push_back({{"file", input.file}, {"sha256", input.sha256}});
  return result;
}

}  // namespace catoptra::app
