#include "app/src/lens_material.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace catoptra::app {
namespace {

using optics::Dispersion;
using optics::Medium;

/// Indices that a scene may give: from vacuum to beyond every transparent solid (diamond 2.42, germanium 4).
constexpr Range kIndices{1, 5};

/// The wavelengths that spectral_samples() can ask for, nm.
constexpr double kShortest_nm = 390, kLongest_nm = 720, kStep_nm = 5;

Medium given(std::string name, Dispersion dispersion) {
  Medium medium{std::move(name), std::move(dispersion), 0, 0, 0, "given by the scene"};
  medium.nd = medium.index(optics::kLineD_nm);
  medium.ne = medium.index(optics::kLineE_nm);
  return medium;
}

Medium read_index_table(const TomlTable& table) {
  if (table.has("nd") != table.has("vd"))
    table.fail_missing(table.has("nd") ? "vd" : "nd", "nd and vd belong together");
  if (table.has("nd")) {
    const double nd = *table.number("nd", kIndices), vd = *table.number("vd", Range::positive());
    return optics::abbe_medium(nd, vd);
  }
  if (const auto rgb = table.vec3("rgb", kIndices))
    return given("rgb indices",
                 Dispersion(std::vector<optics::IndexSample>{
                     {optics::kLineC_nm, rgb->x}, {optics::kLineE_nm, rgb->y}, {optics::kLineF_nm, rgb->z}}));
  auto terms = *table.numbers("sellmeier", 0);
  if (terms.empty() || terms.size() % 2)
    table.fail("sellmeier", "expected pairs of numbers: B1, C1, B2, C2, ...");
  terms.insert(terms.begin(), 0);  // the database's constant term
  return given("Sellmeier", Dispersion(optics::DispersionFormula::database2, std::move(terms)));
}

/// Resonances of a Sellmeier curve may fall into the visible range; a lens must have an index everywhere.
void check_indices(const TomlTable& lens, std::string_view key, const Medium& medium) {
  for (double nm = kShortest_nm; nm <= kLongest_nm; nm += kStep_nm) {
    const double n = medium.index(nm);
    if (n >= kIndices.min && n <= kIndices.max) continue;
    char text[96];
    std::snprintf(text, sizeof text, "its index at %.0f nm is %.6g", nm, n);
    lens.fail(key, text, "an index is at least 1 and at most 5 from 390 to 720 nm");
  }
}

}  // namespace

std::vector<Medium> glasses_of_file(const std::filesystem::path& file) {
  if (file.extension() == ".yml" || file.extension() == ".yaml")
    return {optics::read_refractive_index_yml(file)};
  return optics::read_agf(file);
}

optics::MediumCatalogue lens_media(const std::filesystem::path& file) {
  optics::MediumCatalogue media = optics::built_in_media();
  if (!file.empty()) media.add(glasses_of_file(file));
  return media;
}

std::optional<Medium> read_medium(const TomlTable& lens, std::string_view key,
                                  const optics::MediumCatalogue& media) {
  const toml::node* node = lens.node(key);
  if (!node) return std::nullopt;
  Medium medium;
  if (node->is_string()) {
    try {
      medium = media.find(*lens.text(key));
    } catch (const Error& error) {
      lens.fail(key, error.entity() + " " + error.reason(), error.hint());
    }
  } else {
    const toml::table* found = node->as_table();
    if (!found) lens.fail(key, "expected a catalogue name or a table", "{ nd = 1.498, vd = 58 }");
    const TomlTable table(*found, lens.file(), "lens." + std::string(key), {"nd", "vd", "rgb", "sellmeier"});
    if (int(table.has("nd") || table.has("vd")) + int(table.has("rgb")) + int(table.has("sellmeier")) != 1)
      lens.fail(key, "needs exactly one of nd with vd, rgb and sellmeier");
    medium = read_index_table(table);
  }
  check_indices(lens, key, medium);
  return medium;
}

}  // namespace catoptra::app
