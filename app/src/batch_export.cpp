#include "app/src/batch_export.h"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>

#include "app/src/batch_lens_case.h"
#include "app/src/csv_cell.h"

namespace catoptra::app {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

std::string cell(double value) {
  if (!std::isfinite(value)) return {};
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

/// Lists (coefficients, directions) in one cell, as JSON.
std::string cell(const json& inputs, const std::string& name) {
  const auto found = inputs.find(name);
  if (found == inputs.end() || found->is_null()) return {};
  if (found->is_string()) return csv_cell(found->get<std::string>());
  if (found->is_number()) return cell(found->get<double>());
  return found->empty() ? std::string() : csv_cell(found->dump());
}

void append(std::string& row, const std::vector<std::string>& cells) {
  for (const std::string& text : cells) row += (row.empty() ? "" : ",") + text;
}

void case_rows(BatchReader& reader, std::ostream& out) {
  std::string header = "number,key,status,error,source";
  for (const std::string& name : lens_input_columns()) header += ',' + name;
  append(header, batch_columns().summary);
  out << header << '\n';
  reader.for_each_case([&](const StoredCase& stored) {
    std::string row = std::to_string(stored.position) + ',' + stored.batch_case.key + ',';
    row += std::string(status_name(stored.status)) + ',' + csv_cell(stored.error) + ',' +
           csv_cell(stored.batch_case.source);
    const json inputs = json::parse(stored.batch_case.inputs);
    for (const std::string& name : lens_input_columns()) row += ',' + cell(inputs, name);
    for (std::size_t i = 0; i < batch_columns().summary.size(); ++i)
      row += ',' + (stored.summary.empty() ? std::string() : cell(stored.summary[i]));
    out << row << '\n';
  });
}

void point_rows(BatchReader& reader, std::ostream& out) {
  std::string header = "number,key,point";
  append(header, batch_columns().points);
  out << header << '\n';
  const std::size_t width = batch_columns().points.size();
  reader.for_each_case([&](const StoredCase& stored) {
    const std::vector<double> values = reader.points(stored.position);
    for (std::size_t point = 0; point < values.size() / width; ++point) {
      std::string row =
          std::to_string(stored.position) + ',' + stored.batch_case.key + ',' + std::to_string(point + 1);
      for (std::size_t i = 0; i < width; ++i) row += ',' + cell(values[point * width + i]);
      out << row << '\n';
    }
  });
}

ordered_json named(const std::vector<std::string>& names, const double* values) {
  ordered_json result = ordered_json::object();
  for (std::size_t i = 0; i < names.size(); ++i)
    result[names[i]] = std::isfinite(values[i]) ? ordered_json(values[i]) : ordered_json(nullptr);
  return result;
}

}  // namespace

void export_csv(BatchReader& reader, ExportRows rows, std::ostream& out) {
  rows == ExportRows::cases ? case_rows(reader, out) : point_rows(reader, out);
}

void export_json(BatchReader& reader, ExportRows rows, std::ostream& out) {
  out << "{\"cases\": [";
  const char* before = "\n";
  reader.for_each_case([&](const StoredCase& stored) {
    ordered_json row = {{"number", stored.position},
                        {"key", stored.batch_case.key},
                        {"status", status_name(stored.status)},
                        {"error", stored.error.empty() ? ordered_json(nullptr) : ordered_json(stored.error)},
                        {"source", stored.batch_case.source},
                        {"inputs", ordered_json::parse(stored.batch_case.inputs)}};
    row["summary"] = stored.summary.empty() ? ordered_json(nullptr)
                                            : named(batch_columns().summary, stored.summary.data());
    if (rows == ExportRows::points) {
      const std::vector<double> values = reader.points(stored.position);
      const std::size_t width = batch_columns().points.size();
      ordered_json& points = row["points"] = ordered_json::array();
      for (std::size_t i = 0; i + width <= values.size(); i += width)
        points.push_back(named(batch_columns().points, values.data() + i));
    }
    out << before << row.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    before = ",\n";
  });
  out << "\n]}\n";
}

}  // namespace catoptra::app
