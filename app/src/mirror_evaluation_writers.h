// A mirror's evaluation for machines and for people; docs/reports.md describes every field.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/src/mirror_evaluation.h"

namespace catoptra::app {

[[nodiscard]] nlohmann::ordered_json mirror_json(const MirrorEvaluation& evaluation);

/// Some forty lines for the terminal.
[[nodiscard]] std::string mirror_text(const MirrorEvaluation& evaluation);

}  // namespace catoptra::app
