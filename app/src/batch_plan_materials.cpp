// What the lenses of a plan are made of: names, indices, Abbe pairs, and ranges of these.
#include <algorithm>
#include <variant>

#include "app/src/batch_plan_parts.h"
#include "app/src/file_hash.h"
#include "app/src/lens_material.h"
#include "cad_import/error.h"

namespace catoptra::app {
namespace {

constexpr Range kIndices{1, std::numeric_limits<double>::max()};

/// Where a plan's wavelengths are (and a little closer than they need), for checks of a curve.
constexpr double kShortest_nm = 380, kLongest_nm = 780, kStep_nm = 5;

/// The glass catalogue of a table.
struct OwnGlasses {
  optics::MediumCatalogue own, all;  ///< `all`: with the built-in ones
  std::string sha256;
};

/// One entry of `materials`: a name, or what nd and vd run through or are drawn from.
struct MaterialSweep {
  CaseMaterial named;
  std::optional<Sweep> nd, vd;
};

/// As an error of `key`, whatever it is about.
[[noreturn]] void fail_as(const TomlTable& table, std::string_view key, const Error& error) {
  table.fail(key, error.entity().empty() ? error.reason() : error.entity() + " " + error.reason(),
             error.hint());
}

OwnGlasses read_catalogue(const TomlTable& table, const PlanContext& context) {
  OwnGlasses glasses{{}, optics::built_in_media(), ""};
  if (!table.has("catalogue")) return glasses;
  const std::filesystem::path file = plan_path(table, context, "catalogue");
  try {
    glasses.sha256 = sha256_of_file(file);
    glasses.own = optics::MediumCatalogue(glasses_of_file(file));
  } catch (const Error& error) {
    table.fail(
        "catalogue",
        "'" + file.string() + "': " + (error.entity().empty() ? "" : error.entity() + " ") + error.reason(),
        error.hint());
  }
  glasses.all.add(glasses.own.media());
  return glasses;
}

/// A glass of one's own must have an index at every wavelength that a plan can ask for.
void check_curve(const TomlTable& table, std::string_view key, const optics::Medium& medium) {
  for (double nm = kShortest_nm; nm <= kLongest_nm; nm += kStep_nm)
    if (const double n = medium.index(nm); !(n >= 1 && n <= 5))
      table.fail(key,
                 "glass '" + medium.name + "' has no index of 1 to 5 at " + std::to_string(int(nm)) + " nm",
                 "a plan's glasses need one from 380 to 780 nm");
}

CaseMaterial named_material(const TomlTable& table, std::string_view key, const std::string& name,
                            const OwnGlasses& glasses) {
  CaseMaterial material;
  try {
    const optics::Medium& found = glasses.all.find(name);
    material.name = found.name;
    const auto own = glasses.own.media();
    if (std::any_of(own.begin(), own.end(), [&](const auto& m) { return m.name == found.name; })) {
      check_curve(table, key, found);
      material.own = std::make_shared<const optics::Medium>(found);
      material.catalogue_sha256 = glasses.sha256;
    }
  } catch (const Error& error) {
    if (error.file() == table.file()) throw;
    fail_as(table, key, error);
  }
  return material;
}

MaterialSweep read_material(const TomlTable& table, std::string_view key, const toml::node& node,
                            const OwnGlasses& glasses, bool sampled) {
  MaterialSweep material;
  if (node.is_string()) {
    material.named = named_material(table, key, *node.value<std::string>(), glasses);
    return material;
  }
  const toml::table* found = node.as_table();
  if (!found && !node.is_number())
    table.fail(key, "expected a material", "a name such as \"CR-39\", an index, or { nd = 1.6, vd = 41 }");
  const auto is_range = [](const toml::table& t) {
    return std::any_of(t.begin(), t.end(), [](const auto& entry) {
      const auto name = entry.first.str();
      return name == "from" || name == "to" || name == "step" || name == "mean" || name == "sd";
    });
  };
  if (!found || is_range(*found)) {
    material.nd = sweep_of(node, table, key, kIndices, sampled);
    return material;
  }
  const TomlTable given(*found, table.file(), std::string(key), {"nd", "vd"});
  material.nd = read_sweep(given, "nd", kIndices, sampled);
  material.vd = read_sweep(given, "vd", Range::positive(), sampled);
  if (!material.nd || !material.vd)
    table.fail(key, "a material as a table has nd and vd", "{ nd = 1.6, vd = 41 }");
  return material;
}

std::vector<MaterialSweep> read_entries(const TomlTable& table, const OwnGlasses& glasses, bool sampled) {
  if (table.has("material") && table.has("materials")) table.fail("material", "material excludes materials");
  if (const toml::node* one = table.node("material"))
    return {read_material(table, "material", *one, glasses, sampled)};
  const toml::node* node = table.node("materials");
  if (!node) table.fail_missing("material", "a name such as \"CR-39\", an index, or { nd = 1.6, vd = 41 }");
  const toml::array* several = node->as_array();
  if (!several || several->empty()) table.fail("materials", "expected a list of materials");
  std::vector<MaterialSweep> entries;
  for (const toml::node& one : *several)
    entries.push_back(read_material(table, "materials", one, glasses, sampled));
  return entries;
}

void append_grid(const std::string& plan, const MaterialSweep& entry, std::vector<CaseMaterial>& materials) {
  if (!entry.nd) {
    materials.push_back(entry.named);
    return;
  }
  (void)case_product(plan, entry.nd->values.size(), entry.vd ? entry.vd->values.size() : 1);
  for (const double nd : entry.nd->values) {
    CaseMaterial material;
    material.nd = nd;
    if (!entry.vd) materials.push_back(material);
    if (entry.vd)
      for (const double vd : entry.vd->values) {
        material.vd = vd;
        materials.push_back(material);
      }
  }
}

/// An entry, each as likely as another, and its numbers.
CaseMaterial drawn(const std::vector<MaterialSweep>& entries, const PlanSample& sample, std::size_t draw) {
  const double share = sample.number(draw, "material").uniform();
  const MaterialSweep& entry =
      entries[std::min(entries.size() - 1, std::size_t(share * double(entries.size())))];
  if (!entry.nd) return entry.named;
  CaseMaterial material;
  material.nd = entry.nd->drawn(sample.number(draw, "nd"));
  if (entry.vd) material.vd = entry.vd->drawn(sample.number(draw, "vd"));
  return material;
}

}  // namespace

std::vector<CaseMaterial> read_materials(const TomlTable& table, const PlanContext& context,
                                         const std::string& path) {
  const auto sample =
      sample_of_table(table, context, "material_sample", path + ".material_sample", "materials");
  const auto entries = read_entries(table, read_catalogue(table, context), sample.has_value());
  std::vector<CaseMaterial> materials;
  if (sample)
    for (std::size_t i = 0; i < sample->count; ++i) materials.push_back(drawn(entries, *sample, i));
  else
    for (const MaterialSweep& entry : entries) append_grid(context.name, entry, materials);
  return materials;
}

}  // namespace catoptra::app
