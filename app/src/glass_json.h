// A glass of one's own as JSON: its dispersion curve, number by number.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "optics/medium.h"

namespace catoptra::app {

/// {"coefficients": [...], "formula": "sellmeier1", "ne": ..., "nd": ..., "samples": [[nm, n], ...]}
[[nodiscard]] nlohmann::json glass_json(const optics::Medium& glass);

/// Back again, with the same index at every wavelength bit for bit. Throws catoptra::Error where the formula
/// is unknown, nlohmann::json::exception for other text.
[[nodiscard]] optics::Medium glass_from(const nlohmann::json& json, const std::string& name);

}  // namespace catoptra::app
