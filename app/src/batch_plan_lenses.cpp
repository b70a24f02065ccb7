// [[lenses]] and [[prescriptions]]: which lenses.
#include <glob.h>

#include <algorithm>

#include "app/src/batch_plan_parts.h"
#include "app/src/file_hash.h"
#include "cad_import/error.h"

namespace catoptra::app {
namespace {

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
  std::vector<std::string> keys{"files", "front_faces", "back_faces"};
  keys.insert(keys.end(), std::begin(kMaterialKeys), std::end(kMaterialKeys));
  const TomlTable table(found, context.name, "lenses", keys);
  PlanLenses lenses;
  lenses.materials = read_materials(table, context, "lenses");
  lenses.front_faces = read_face_selectors(table, "front_faces");
  lenses.back_faces = read_face_selectors(table, "back_faces");
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

std::vector<PlanLenses> read_plan_lenses(const TomlTable& root, const PlanContext& context) {
  std::vector<PlanLenses> result;
  for (const toml::table* found : root.tables("lenses")) result.push_back(read_files(*found, context));
  const auto keys = blank_keys();
  for (const toml::table* found : root.tables("prescriptions")) {
    const TomlTable table(*found, context.name, "prescriptions", keys);
    PlanLenses lenses;
    lenses.materials = read_materials(table, context, "prescriptions");
    lenses.blanks = read_blanks(table, context);
    result.push_back(std::move(lenses));
  }
  return result;
}

}  // namespace catoptra::app
