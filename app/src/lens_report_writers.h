// The report on a lens as JSON, tables and text; docs/reports.md describes every field.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/src/lens_report.h"

namespace catoptra::app {

/// Numbers that have no meaning where the light does not get through are null; so is an object at infinity.
[[nodiscard]] nlohmann::ordered_json lens_report_json(const LensReport& report);

/// One row per point, the unit in each column's name; empty where JSON has null.
[[nodiscard]] std::string lens_report_csv(const LensReport& report);

/// One row per tolerance, with certainty and source; empty without a verdict.
[[nodiscard]] std::string lens_limits_csv(const LensReport& report);

/// For people. Of many points, those on the horizontal and the vertical through the middle.
[[nodiscard]] std::string lens_report_text(const LensReport& report);

}  // namespace catoptra::app
