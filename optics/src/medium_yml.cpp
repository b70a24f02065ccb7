// Materials of the refractiveindex.info database: formulas 1 to 6 and tables of n or n and k.
#include <yaml-cpp/yaml.h>

#include <array>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "optics/medium.h"

namespace catoptra::optics {
namespace {

std::vector<double> numbers(const std::string& text) {
  std::istringstream in(text);
  std::vector<double> values;
  for (double value; in >> value;) values.push_back(value);
  return values;
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& entry,
                       const std::string& reason) {
  throw Error(file.string(), entry, reason, "expected a material of the refractiveindex.info database");
}

/// "wavelength n [k]" rows, wavelengths in micrometres.
Dispersion read_table(const std::filesystem::path& file, const std::string& text) {
  std::vector<IndexSample> samples;
  std::istringstream rows(text);
  for (std::string row; std::getline(rows, row);) {
    const std::vector<double> values = numbers(row);
    if (values.size() >= 2) samples.push_back({values[0] * 1e3, values[1]});
  }
  if (samples.empty()) fail(file, "DATA", "the table is empty");
  return Dispersion(std::move(samples));
}

/// "formula 1" to "formula 6". Source: refractiveindex.info database manual.
Dispersion read_formula(const std::filesystem::path& file, const std::string& type,
                        std::vector<double> coefficients, const std::vector<double>& range_um) {
  static constexpr std::array kFormulas{DispersionFormula::database1, DispersionFormula::database2,
                                        DispersionFormula::database3, DispersionFormula::database4,
                                        DispersionFormula::database5, DispersionFormula::database6};
  const char digit = type.back();
  if (digit < '1' || digit > '6' || type.size() != std::string_view("formula 1").size())
    fail(file, "type", "\"" + type + "\" is not supported");
  if (coefficients.empty()) fail(file, "coefficients", "there are none");
  if (range_um.size() != 2) fail(file, "wavelength_range", "needs two wavelengths");
  return {kFormulas[static_cast<std::size_t>(digit - '1')], std::move(coefficients), range_um[0] * 1e3,
          range_um[1] * 1e3};
}

}  // namespace

Medium read_refractive_index_yml(const std::filesystem::path& file) {
  try {
    const YAML::Node root = YAML::LoadFile(file.string());
    Medium medium;
    medium.name = file.stem().string();
    medium.source = "refractiveindex.info: " + medium.name;
    for (const YAML::Node& data : root["DATA"]) {
      const std::string type = data["type"].as<std::string>();
      if (type == "tabulated n" || type == "tabulated nk") {
        medium.dispersion = read_table(file, data["data"].as<std::string>());
      } else if (type.starts_with("formula")) {
        medium.dispersion = read_formula(file, type, numbers(data["coefficients"].as<std::string>()),
                                         numbers(data["wavelength_range"].as<std::string>()));
      } else {
        continue;  // absorption beside an index that another entry gives
      }
      medium.nd = medium.dispersion.index(kLineD_nm);
      medium.ne = medium.dispersion.index(kLineE_nm);
      medium.vd = medium.dispersion.abbe_number_d();
      return medium;
    }
  } catch (const YAML::Exception& error) {
    fail(file, "line " + std::to_string(error.mark.line + 1), error.msg);
  }
  fail(file, "DATA", "holds no refractive index");
}

}  // namespace catoptra::optics
