// Materials of the refractiveindex.info database: formulas 1 to 6 and tables of n or n and k.
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "optics/medium.h"
#include "optics/src/database_yml.h"

namespace catoptra::optics {
namespace {

/// "wavelength n [k]" rows, wavelengths in micrometres.
Dispersion read_table(const std::filesystem::path& file, const std::string& text) {
  std::vector<IndexSample> samples;
  std::istringstream rows(text);
  for (std::string row; std::getline(rows, row);) {
    const std::vector<double> values = numbers(row);
    if (values.size() >= 2) samples.push_back({values[0] * 1e3, values[1]});
  }
  if (samples.empty()) fail_database(file, "DATA", "the table is empty");
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
    fail_database(file, "type", "\"" + type + "\" is not supported");
  if (coefficients.empty()) fail_database(file, "coefficients", "there are none");
  if (range_um.size() != 2) fail_database(file, "wavelength_range", "needs two wavelengths");
  return {kFormulas[static_cast<std::size_t>(digit - '1')], std::move(coefficients), range_um[0] * 1e3,
          range_um[1] * 1e3};
}

}  // namespace

Medium read_refractive_index_yml(const std::filesystem::path& file) {
  return read_database(file, "refractive index",
                       [&](const YAML::Node& data, const std::string& type) -> std::optional<Medium> {
                         Medium medium;
                         medium.name = file.stem().string();
                         medium.source = "refractiveindex.info: " + medium.name;
                         if (type == "tabulated n" || type == "tabulated nk")
                           medium.dispersion = read_table(file, data["data"].as<std::string>());
                         else if (type.starts_with("formula"))
                           medium.dispersion =
                               read_formula(file, type, numbers(data["coefficients"].as<std::string>()),
                                            numbers(data["wavelength_range"].as<std::string>()));
                         else
                           return std::nullopt;  // absorption beside an index that another entry gives
                         medium.nd = medium.dispersion.index(kLineD_nm);
                         if (!std::isfinite(medium.nd))
                           fail_database(file, "coefficients", "give no refractive index");
                         medium.ne = medium.dispersion.index(kLineE_nm);
                         medium.vd = medium.dispersion.abbe_number_d();
                         return medium;
                       });
}

}  // namespace catoptra::optics
