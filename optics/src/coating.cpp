#include "optics/coating.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "optics/refraction.h"
#include "optics/src/database_yml.h"
#include "optics/src/names.h"

namespace catoptra::optics {
namespace {

// At room temperature, from the tables of refractiveindex.info (CC0) main/Al, main/Ag, main/Cr, interpolated
// at three wavelengths.
const std::vector<Coating>& table() {
  static const std::vector<Coating> coatings{{"aluminium",
                                              {{450, 0.633, 5.454}, {550, 1.015, 6.627}, {650, 1.558, 7.712}},
                                              "Rakic, Applied Optics 34, 4755, 1995"},
                                             {"silver",
                                              {{450, 0.040, 2.648}, {550, 0.060, 3.597}, {650, 0.052, 4.409}},
                                              "Johnson and Christy, Physical Review B 6, 4370, 1972"},
                                             {"chromium",
                                              {{450, 2.323, 3.135}, {550, 3.181, 3.329}, {650, 3.107, 3.331}},
                                              "Johnson and Christy, Physical Review B 9, 5056, 1974"}};
  return coatings;
}

// Rows of wavelength (micrometres), n and k.
std::vector<ComplexIndexSample> read_rows(const std::filesystem::path& file, const std::string& text) {
  std::vector<ComplexIndexSample> samples;
  std::istringstream rows(text);
  for (std::string row; std::getline(rows, row);) {
    const std::vector<double> values = numbers(row);
    if (values.empty()) continue;
    if (values.size() < 3 || !(values[0] > 0) || !(values[1] > 0) || !(values[2] >= 0))
      fail_database(file, "DATA", "the row \"" + row + "\" is not wavelength, n and k");
    samples.push_back({values[0] * 1e3, values[1], values[2]});
  }
  if (samples.empty()) fail_database(file, "DATA", "the table is empty");
  std::ranges::stable_sort(samples, {}, &ComplexIndexSample::wavelength_nm);
  return samples;
}

}  // namespace

ComplexIndexSample Coating::index(double wavelength_nm) const {
  const auto above = std::ranges::upper_bound(samples, wavelength_nm, {}, &ComplexIndexSample::wavelength_nm);
  if (above == samples.begin()) return {wavelength_nm, samples.front().n, samples.front().k};
  const ComplexIndexSample& a = *(above - 1);
  if (above == samples.end()) return {wavelength_nm, a.n, a.k};
  const double x = (wavelength_nm - a.wavelength_nm) / (above->wavelength_nm - a.wavelength_nm);
  return {wavelength_nm, std::lerp(a.n, above->n, x), std::lerp(a.k, above->k, x)};
}

double Coating::reflectance(double wavelength_nm, double cos_theta_i, double n_from) const {
  const ComplexIndexSample metal = index(wavelength_nm);
  return fresnel_conductor(cos_theta_i, n_from, metal.n, metal.k).unpolarised;
}

glm::dvec3 Coating::reflectance_rgb(double cos_theta_i, double n_from) const {
  return {reflectance(kRed_nm, cos_theta_i, n_from), reflectance(kGreen_nm, cos_theta_i, n_from),
          reflectance(kBlue_nm, cos_theta_i, n_from)};
}

std::span<const Coating> built_in_coatings() {
  return table();
}

const Coating& find_coating(std::string_view name) {
  const std::string key = folded(name);
  std::vector<std::string> names;
  for (const Coating& coating : table()) {
    if (folded(coating.name) == key) return coating;
    names.push_back(coating.name);
  }
  throw Error("", "coating \"" + std::string(name) + "\"", "is not known",
              "nearest names: " + nearest_names(name, names));
}

Coating read_coating_yml(const std::filesystem::path& file) {
  return read_database(file, "table of n and k",
                       [&](const YAML::Node& data, const std::string& type) -> std::optional<Coating> {
                         if (type != "tabulated nk") return std::nullopt;
                         const std::string name = file.stem().string();
                         return Coating{name, read_rows(file, data["data"].as<std::string>()),
                                        "refractiveindex.info: " + name};
                       });
}

}  // namespace catoptra::optics
