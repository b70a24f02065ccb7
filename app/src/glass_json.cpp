#include "app/src/glass_json.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace catoptra::app {
namespace {

using nlohmann::json;
using optics::DispersionFormula;

/// In the order of DispersionFormula. They are in the keys of cases: a name never changes.
constexpr std::array kFormulas{
    "constant",  "table",      "cauchy",    "schott",    "sellmeier1", "herzberger", "sellmeier2",
    "conrady",   "sellmeier3", "handbook1", "handbook2", "sellmeier4", "extended1",  "sellmeier5",
    "extended2", "database1",  "database2", "database3", "database4",  "database5",  "database6"};
static_assert(kFormulas.size() == std::size_t(DispersionFormula::database6) + 1);

}  // namespace

json glass_json(const optics::Medium& glass) {
  const optics::Dispersion& curve = glass.dispersion;
  json samples = json::array();
  for (const optics::IndexSample& s : curve.samples()) samples.push_back({s.wavelength_nm, s.n});
  return {{"formula", kFormulas.at(std::size_t(curve.formula()))},
          {"coefficients", curve.coefficients()},
          {"samples", std::move(samples)},
          {"nd", glass.nd},
          {"ne", glass.ne}};
}

optics::Medium glass_from(const json& text, const std::string& name) {
  optics::Medium glass;
  glass.name = name;
  glass.nd = text.at("nd").get<double>();
  glass.ne = text.at("ne").get<double>();
  const auto found = std::find(kFormulas.begin(), kFormulas.end(), text.at("formula").get<std::string>());
  std::vector<optics::IndexSample> samples;
  for (const json& s : text.at("samples")) samples.push_back({s.at(0).get<double>(), s.at(1).get<double>()});
  const auto formula = DispersionFormula(found - kFormulas.begin());
  if (found == kFormulas.end() || samples.empty() == (formula == DispersionFormula::table))
    throw Error("", "case", "has a glass of an unknown formula",
                "it has to come from a plan that this version has read");
  glass.dispersion = samples.empty()
                         ? optics::Dispersion(formula, text.at("coefficients").get<std::vector<double>>())
                         : optics::Dispersion(std::move(samples));
  return glass;
}

}  // namespace catoptra::app
