// The CSV form of lens_report.h: points, and verdicts.
#include <array>
#include <cstdio>

#include "app/src/csv_cell.h"
#include "app/src/lens_report_writers.h"

namespace catoptra::app {
namespace {

using nlohmann::ordered_json;

/// Keys of a point in JSON and the columns that they become. Prism dioptre is written pd.
struct Column {
  const char* key;
  const char* name;
};
constexpr Column kColumns[] = {{"gaze_h_deg", "gaze_h_deg"},
                               {"gaze_v_deg", "gaze_v_deg"},
                               {"x_mm", "x_mm"},
                               {"y_mm", "y_mm"},
                               {"end", "end"},
                               {"sphere_d", "sphere_d"},
                               {"cylinder_d", "cylinder_d"},
                               {"axis_deg", "axis_deg"},
                               {"mean_power_error_d", "mean_power_error_d"},
                               {"oblique_astigmatism_d", "oblique_astigmatism_d"},
                               {"tangential_d", "tangential_d"},
                               {"sagittal_d", "sagittal_d"},
                               {"prism_h", "prism_h_pd"},
                               {"prism_v", "prism_v_pd"},
                               {"base_out", "base_out_pd"},
                               {"object_h_deg", "object_h_deg"},
                               {"object_v_deg", "object_v_deg"},
                               {"distortion", "distortion_ratio"},
                               {"tca_d", "tca_pd"}};

std::string cell(const ordered_json& value) {
  if (value.is_null()) return {};
  if (value.is_string()) return csv_cell(value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "pass" : "fail";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.10g", value.get<double>());
  return text.data();
}

std::string row(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) line += (i ? "," : "") + cells[i];
  return line + "\n";
}

}  // namespace

std::string lens_report_csv(const LensReport& report) {
  std::vector<std::string> cells;
  for (const Column& column : kColumns) cells.emplace_back(column.name);
  std::string text = row(cells);
  const ordered_json json = lens_report_json(report);
  for (const ordered_json& point : json.at("points")) {
    cells.clear();
    for (const Column& column : kColumns) cells.push_back(cell(point.at(column.key)));
    text += row(cells);
  }
  return text;
}

std::string lens_limits_csv(const LensReport& report) {
  if (!report.verdict) return {};
  std::string text = row({"rule", "clause", "quantity", "requirement", "ordered", "value", "deviation",
                          "limit", "unit", "pass", "certainty", "source"});
  const ordered_json json = lens_report_json(report);
  for (const ordered_json& limit : json.at("limits")) {
    std::vector<std::string> cells{cell(json.at("rule").at("id"))};
    for (const char* key : {"clause", "quantity", "requirement", "ordered", "value", "deviation", "limit",
                            "unit", "pass", "certainty", "source"})
      cells.push_back(cell(limit.at(key)));
    text += row(cells);
  }
  return text;
}

}  // namespace catoptra::app
