#include "app/src/toml_table.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "app/src/nearest_name.h"
#include "app/src/one_line.h"
#include "cad_import/error.h"

namespace catoptra::app {
namespace {

std::string_view type_in_words(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return node.is_array_of_tables() ? "an array of tables" : "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

std::string in_words(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string in_words(Range range) {
  const bool has_max = range.max < std::numeric_limits<double>::max();
  const bool has_min = range.min > std::numeric_limits<double>::lowest();
  std::string text = "must be ";
  if (has_min) text += (range.open_min ? "greater than " : "at least ") + in_words(range.min);
  if (has_max) text += (has_min ? " and at most " : "at most ") + in_words(range.max);
  return text;
}

std::vector<std::string> to_strings(std::initializer_list<std::string_view> views) {
  return {views.begin(), views.end()};
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& name) {
  try {
    return toml::parse(text, std::string_view(name));
  } catch (const toml::parse_error& error) {
    throw Error(name, "line " + std::to_string(error.source().begin.line),
                one_line(std::string(error.description())), "the file is not valid TOML");
  }
}

TomlTable::TomlTable(const toml::table& table, std::string file, std::string path,
                     std::initializer_list<std::string_view> known)
    : TomlTable(table, std::move(file), std::move(path), to_strings(known)) {}

TomlTable::TomlTable(const toml::table& table, std::string file, std::string path,
                     std::span<const std::string> known)
    : table_(table), file_(std::move(file)), path_(std::move(path)) {
  for (const auto& [key, value] : table_) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    fail(key.str(), "unknown key", hint_for_unknown(key.str(), known));
  }
}

std::string TomlTable::entity(std::string_view key) const {
  auto line = table_.source().begin.line;
  for (const auto& [k, value] : table_)
    // Arrays of tables have no key of their own line by line: their first table stands for them.
    if (k.str() == key) line = k.source().begin.line ? k.source().begin.line : value.source().begin.line;
  std::string text = line ? "line " + std::to_string(line) + ", " : "";
  if (!path_.empty()) text += path_ + (key.empty() ? "" : ".");
  return text + std::string(key);
}

void TomlTable::fail(std::string_view key, const std::string& reason, const std::string& hint) const {
  throw Error(file_, one_line(entity(key)), one_line(reason), one_line(hint));
}

void TomlTable::fail_missing(std::string_view key, const std::string& hint) const {
  throw Error(file_, entity(key), "this key is required", hint);
}

void TomlTable::fail_type(const toml::node& node, std::string_view key, std::string_view expected) const {
  fail(key, "expected " + std::string(expected) + ", found " + std::string(type_in_words(node)));
}

double TomlTable::checked_number(const toml::node& node, std::string_view key, Range range) const {
  if (!node.is_number()) fail_type(node, key, "a number");
  const double value = *node.value<double>();
  if (!std::isfinite(value)) fail(key, "must be a finite number");
  if (value < range.min || value > range.max || (range.open_min && value == range.min))
    fail(key, in_words(value) + " is out of range: " + in_words(range));
  return value;
}

std::optional<double> TomlTable::number(std::string_view key, Range range) const {
  const toml::node* found = node(key);
  if (!found) return std::nullopt;
  return checked_number(*found, key, range);
}

std::optional<int> TomlTable::integer(std::string_view key, int min, int max) const {
  const toml::node* found = node(key);
  if (!found) return std::nullopt;
  if (!found->is_integer()) fail_type(*found, key, "an integer");
  return static_cast<int>(checked_number(*found, key, {double(min), double(max)}));
}

std::optional<bool> TomlTable::boolean(std::string_view key) const {
  const toml::node* found = node(key);
  if (!found) return std::nullopt;
  if (!found->is_boolean()) fail_type(*found, key, "true or false");
  return *found->value<bool>();
}

std::optional<std::string> TomlTable::text(std::string_view key) const {
  const toml::node* found = node(key);
  if (!found) return std::nullopt;
  if (!found->is_string()) fail_type(*found, key, "a string");
  return *found->value<std::string>();
}

std::optional<std::string> TomlTable::choice(std::string_view key,
                                             std::initializer_list<std::string_view> choices) const {
  auto value = text(key);
  if (value && std::find(choices.begin(), choices.end(), *value) == choices.end()) {
    const auto names = to_strings(choices);
    fail(key, "'" + *value + "' is not one of " + list_of_names(names), hint_for_unknown(*value, names));
  }
  return value;
}

std::vector<double> TomlTable::numbers_of(const toml::node& found, std::string_view key, std::size_t count,
                                          Range range) const {
  const std::string expected =
      count ? "an array of " + std::to_string(count) + " numbers" : "an array of numbers";
  const toml::array* array = found.as_array();
  if (!array) fail_type(found, key, expected);
  if (count && array->size() != count)
    fail(key, "expected " + expected + ", found " + std::to_string(array->size()));
  std::vector<double> values;
  for (const toml::node& element : *array) values.push_back(checked_number(element, key, range));
  return values;
}

std::optional<std::vector<double>> TomlTable::numbers(std::string_view key, std::size_t count,
                                                      Range range) const {
  const toml::node* found = node(key);
  if (!found) return std::nullopt;
  return numbers_of(*found, key, count, range);
}

std::optional<glm::dvec3> TomlTable::vec3(std::string_view key, Range range) const {
  const auto values = numbers(key, 3, range);
  if (!values) return std::nullopt;
  return glm::dvec3((*values)[0], (*values)[1], (*values)[2]);
}

const toml::table* TomlTable::table(std::string_view key) const {
  const toml::node* found = node(key);
  if (!found) return nullptr;
  if (!found->is_table()) fail_type(*found, key, "a table, written [" + std::string(key) + "]");
  return found->as_table();
}

std::vector<const toml::table*> TomlTable::tables(std::string_view key) const {
  const toml::node* found = node(key);
  if (!found) return {};
  const toml::array* array = found->as_array();
  if (!array) fail_type(*found, key, "an array of tables, written [[" + std::string(key) + "]]");
  std::vector<const toml::table*> result;
  for (const toml::node& element : *array) {
    if (!element.is_table())
      fail_type(element, key, "an array of tables, written [[" + std::string(key) + "]]");
    result.push_back(element.as_table());
  }
  return result;
}

}  // namespace catoptra::app
