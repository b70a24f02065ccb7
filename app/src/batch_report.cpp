#include "app/src/batch_report.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "app/src/batch_lens_case.h"
#include "app/src/html_report.h"

namespace catoptra::app {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// What a column is called for people: the unit set apart.
std::string title_of(const std::string& name) {
  constexpr std::array<std::array<std::string_view, 2>, 7> kUnits{{{"_pd", "Δ"},
                                                                   {"_d", "D"},
                                                                   {"_deg", "°"},
                                                                   {"_mm", "mm"},
                                                                   {"_nm", "nm"},
                                                                   {"_percent", "%"},
                                                                   {"_ratio", ""}}};
  std::string title = name, unit;
  for (const auto& [suffix, shown] : kUnits)
    if (name.ends_with(suffix)) {
      title = name.substr(0, name.size() - suffix.size());
      unit = shown;
      break;
    }
  for (char& c : title)
    if (c == '_') c = ' ';
  return unit.empty() ? title : title + ", " + unit;
}

/// Inputs that tell cases apart at a glance; the others are in the export.
constexpr std::array kInputs{"sph_d",    "cyl_d",    "axis_deg",     "add_d", "prism_pd",
                             "front",    "material", "index",        "mode",  "panto_deg",
                             "wrap_deg", "eye",      "wavelength_nm"};

ordered_json columns_json() {
  const auto column = [](const std::string& name, const std::string& title, bool numeric) {
    return ordered_json{{"name", name}, {"title", title}, {"numeric", numeric}, {"digits", numeric ? 3 : 0}};
  };
  ordered_json columns{{{"name", "case"}, {"title", "Case"}, {"numeric", true}, {"digits", 0}},
                       column("status", "Status", false),
                       column("source", "File", false)};
  for (const std::string name : kInputs)
    columns.push_back(column(name, title_of(name),
                             name != "front" && name != "material" && name != "mode" && name != "eye"));
  for (const std::string& name : batch_columns().summary)
    columns.push_back(column(name, title_of(name), true));
  columns.push_back(column("error", "Error", false));
  return columns;
}

ordered_json number_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json row_json(const StoredCase& stored, const json& inputs) {
  ordered_json row{stored.position, status_name(stored.status),
                   std::filesystem::path(stored.batch_case.source).filename().string()};
  for (const char* name : kInputs)
    row.push_back(inputs.contains(name) ? ordered_json(inputs.at(name)) : ordered_json(nullptr));
  for (std::size_t i = 0; i < batch_columns().summary.size(); ++i)
    row.push_back(stored.summary.empty() ? ordered_json(nullptr) : number_or_null(stored.summary[i]));
  row.push_back(stored.error);
  return row;
}

/// The case as `lens evaluate` would report it, as far as the page shows it.
ordered_json lens_json(const StoredCase& stored, const json& inputs, const std::vector<double>& points) {
  const auto& summary = batch_columns().summary;
  const auto value = [&](const char* name) {
    for (std::size_t i = 0; i < summary.size(); ++i)
      if (summary[i] == name) return number_or_null(stored.summary[i]);
    return ordered_json(nullptr);
  };
  const auto material = inputs.find("material");
  ordered_json lens{
      {"lens", "case " + std::to_string(stored.position)},
      {"material",
       material != inputs.end() && material->is_string() ? material->get<std::string>() : "by its index"},
      {"wavelength_nm", inputs.value("wavelength_nm", 0.0)},
      {"mode", inputs.value("mode", "")},
      {"reference",
       {{"sphere_d", value("reference_sphere_d")},
        {"cylinder_d", value("reference_cylinder_d")},
        {"axis_deg", value("reference_axis_deg")},
        {"prism_d", value("reference_prism_pd")},
        {"prism_base_deg", value("reference_prism_base_deg")}}},
      {"spectacle_magnification", value("spectacle_magnification_ratio")}};
  ordered_json& list = lens["points"] = ordered_json::array();
  const auto& names = batch_columns().points;
  for (std::size_t first = 0; first + names.size() <= points.size(); first += names.size()) {
    ordered_json point;
    for (std::size_t i = 0; i < names.size(); ++i) {
      std::string name = names[i];  // as `lens evaluate` calls them
      for (const auto& [column, key] : {std::pair{"prism_h_pd", "prism_h"},
                                        {"prism_v_pd", "prism_v"},
                                        {"tca_pd", "tca_d"},
                                        {"distortion_ratio", "distortion"}})
        if (name == column) name = key;
      point[name] = number_or_null(points[first + i]);
    }
    list.push_back(std::move(point));
  }
  return lens;
}

}  // namespace

std::string batch_page(BatchReader& reader, const std::string& name, const BatchReportOptions& options) {
  const BatchCounts counts = reader.counts();
  ordered_json batch{
      {"counts", {{"done", counts.done}, {"failed", counts.failed}, {"pending", counts.pending}}},
      {"plot_x", "reference_sphere_d"},
      {"plot_y", "oblique_astigmatism_max_d"}};
  batch["failures"] = ordered_json::array();
  for (const FailureReason& reason : reader.failures())
    batch["failures"].push_back({{"count", reason.count}, {"example", reason.example}});
  batch["columns"] = columns_json();
  ordered_json& rows = batch["rows"] = ordered_json::array();
  std::vector<std::pair<StoredCase, json>> mapped;
  reader.for_each_case([&](const StoredCase& stored) {
    const json inputs = json::parse(stored.batch_case.inputs);
    if (rows.size() < options.rows) rows.push_back(row_json(stored, inputs));
    if (stored.status == CaseStatus::done && mapped.size() < options.maps)
      mapped.emplace_back(stored, inputs);
  });
  ordered_json& lenses = batch["lenses"] = ordered_json::array();
  for (const auto& [stored, inputs] : mapped)
    lenses.push_back(lens_json(stored, inputs, reader.points(stored.position)));

  HtmlPage page;
  page.title = "Batch " + name;
  page.summary = std::to_string(counts.all()) + " cases: " + std::to_string(counts.done) + " done, " +
                 std::to_string(counts.failed) + " failed, " + std::to_string(counts.pending) + " pending";
  page.batch = std::move(batch);
  for (const StoredPlan& plan : reader.plans())
    page.inputs.push_back({{"file", plan.file}, {"sha256", plan.sha256}, {"version", plan.version}});
  return html_report(page);
}

}  // namespace catoptra::app
