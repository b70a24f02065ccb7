// [[lenses]], and what lenses are made of.
#include <glob.h>

#include <map>

#include "app/src/batch_plan_parts.h"
#include "app/src/file_hash.h"
#include "cad_import/error.h"

namespace catoptra::app {
namespace {

CaseMaterial material_from(const TomlTable& table, std::string_view key, const toml::node& node) {
  CaseMaterial material;
  if (node.is_string()) {
    material.name = *node.value<std::string>();
  } else if (node.is_number()) {
    material.nd = *node.value<double>();
  } else if (const toml::table* found = node.as_table()) {
    const TomlTable given(*found, table.file(), std::string(key), {"nd", "vd"});
    material.nd = given.number("nd");
    material.vd = given.number("vd");
    if (!material.nd || !material.vd)
      table.fail(key, "a material as a table has nd and vd", "{ nd = 1.6, vd = 41 }");
  } else {
    table.fail(key, "expected a material", "a name such as \"CR-39\", an index, or { nd = 1.6, vd = 41 }");
  }
  try {
    if (!material.name.empty()) material.name = optics::built_in_media().find(material.name).name;
    (void)material.medium();
  } catch (const Error& error) {
    table.fail(key, error.entity().empty() ? error.reason() : error.entity() + " " + error.reason(),
               error.hint());
  }
  return material;
}

/// `text` with what glob() would understand taken literally.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::string_view("*?[\\").find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

struct Matches {
  glob_t found{};
  ~Matches() { globfree(&found); }
};

/// Files that match, in the order of their names (bytes, whatever the locale).
std::vector<std::string> matching_files(const TomlTable& table, const PlanContext& context,
                                        const std::string& pattern) {
  const bool absolute = std::filesystem::path(pattern).is_absolute();
  const std::string whole = absolute ? pattern : escaped(context.folder.string()) + "/" + pattern;
  Matches matches;
  const int code = glob(whole.c_str(), GLOB_NOSORT, nullptr, &matches.found);
  if (code != 0 && code != GLOB_NOMATCH)
    table.fail("files", "the pattern '" + pattern + "' cannot be searched for");
  std::vector<std::string> files;
  for (std::size_t i = 0; i < matches.found.gl_pathc; ++i) {
    const std::filesystem::path path = std::filesystem::path(matches.found.gl_pathv[i]).lexically_normal();
    std::error_code ignored;
    if (!std::filesystem::is_directory(path, ignored)) files.push_back(path.string());
  }
  std::sort(files.begin(), files.end());
  if (files.empty())
    table.fail("files", "no file matches '" + pattern + "'", "paths start at the folder of the plan");
  return files;
}

PlanLenses read_files(const toml::table& found, const PlanContext& context) {
  const TomlTable table(found, context.name, "lenses", {"files", "material", "materials"});
  PlanLenses lenses;
  lenses.materials = read_materials(table);
  const toml::node* node = table.node("files");
  if (!node) table.fail_missing("files", "for example [\"lenses/*.step\"]");
  const toml::array* patterns = node->as_array();
  if (!patterns || patterns->empty()) table.fail("files", "expected a list of names or patterns");
  for (const toml::node& pattern : *patterns) {
    if (!pattern.is_string()) table.fail("files", "expected a list of names or patterns");
    for (const std::string& file : matching_files(table, context, *pattern.value<std::string>())) {
      try {
        lenses.files.push_back({file, sha256_of_file(file)});
      } catch (const Error& error) {
        table.fail("files", "'" + error.file() + "' " + error.reason(), error.hint());
      }
    }
  }
  return lenses;
}

}  // namespace

std::size_t case_product(const std::string& plan, std::size_t a, std::size_t b) {
  if (b != 0 && a > kMostCases / b)
    throw Error(plan, "plan", "has more than " + std::to_string(kMostCases) + " cases",
                "leave out values, or divide it into several plans");
  return a * b;
}

std::vector<CaseMaterial> read_materials(const TomlTable& table) {
  if (table.has("material") && table.has("materials")) table.fail("material", "material excludes materials");
  if (const toml::node* one = table.node("material")) return {material_from(table, "material", *one)};
  const toml::node* node = table.node("materials");
  if (!node) table.fail_missing("material", "a name such as \"CR-39\", an index, or { nd = 1.6, vd = 41 }");
  const toml::array* several = node->as_array();
  if (!several || several->empty()) table.fail("materials", "expected a list of materials");
  std::vector<CaseMaterial> materials;
  for (const toml::node& one : *several) materials.push_back(material_from(table, "materials", one));
  return materials;
}

std::vector<PlanLenses> read_plan_lenses(const TomlTable& root, const PlanContext& context) {
  std::vector<PlanLenses> result;
  for (const toml::table* found : root.tables("lenses")) result.push_back(read_files(*found, context));
  const auto keys = blank_keys();
  for (const toml::table* found : root.tables("prescriptions")) {
    const TomlTable table(*found, context.name, "prescriptions", keys);
    PlanLenses lenses;
    lenses.materials = read_materials(table);
    lenses.blanks = read_blanks(table);
    result.push_back(std::move(lenses));
  }
  return result;
}

}  // namespace catoptra::app
