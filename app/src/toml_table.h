// A TOML table read key by key, with errors that name file, line and key.
#pragma once

#include <toml++/toml.h>
#include <array>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace catoptra::app {

/// Allowed values of a number. Not-a-number and infinities are never allowed.
struct Range {
  double min = std::numeric_limits<double>::lowest();
  double max = std::numeric_limits<double>::max();
  bool open_min = false;  ///< the value must be greater than `min`

  [[nodiscard]] static Range positive() { return {0, std::numeric_limits<double>::max(), true}; }
  [[nodiscard]] static Range not_negative() { return {0, std::numeric_limits<double>::max(), false}; }
};

/// The root table of `text`; `name` stands for the file in messages. Throws catoptra::Error with the line of
/// what is not TOML.
[[nodiscard]] toml::table parse_toml(std::string_view text, const std::string& name);

/// One table of a scene file. The constructor refuses keys that are not in `known`.
/// Every reader returns nullopt where the key is absent and throws catoptra::Error where its value does not
/// fit.
class TomlTable {
 public:
  /// `file` as the user named it; `path`: the table's name in messages ("mirror"), empty for the root.
  TomlTable(const toml::table& table, std::string file, std::string path,
            std::initializer_list<std::string_view> known);
  /// Where the keys are not known before running.
  TomlTable(const toml::table& table, std::string file, std::string path, std::span<const std::string> known);

  [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
  [[nodiscard]] const toml::node* node(std::string_view key) const { return table_.get(key); }
  [[nodiscard]] const std::string& file() const { return file_; }

  [[nodiscard]] std::optional<double> number(std::string_view key, Range range = {}) const;
  [[nodiscard]] std::optional<int> integer(std::string_view key, int min, int max) const;
  [[nodiscard]] std::optional<bool> boolean(std::string_view key) const;
  [[nodiscard]] std::optional<std::string> text(std::string_view key) const;
  /// One of `choices`, else an error that suggests the nearest.
  [[nodiscard]] std::optional<std::string> choice(std::string_view key,
                                                  std::initializer_list<std::string_view> choices) const;
  [[nodiscard]] std::optional<glm::dvec3> vec3(std::string_view key, Range range = {}) const;
  /// An array of exactly `count` numbers (any number where `count` is 0).
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count,
                                                           Range range = {}) const;
  /// A table under `key`; null where absent.
  [[nodiscard]] const toml::table* table(std::string_view key) const;
  /// The tables of an array of tables; empty where absent.
  [[nodiscard]] std::vector<const toml::table*> tables(std::string_view key) const;

  /// The number of a node, checked like number().
  [[nodiscard]] double number_of(const toml::node& node, std::string_view key, Range range) const {
    return checked_number(node, key, range);
  }
  /// Numbers of an array node, checked like numbers().
  [[nodiscard]] std::vector<double> numbers_of(const toml::node& node, std::string_view key,
                                               std::size_t count, Range range) const;

  /// Throws the error for `key` at its own line (or the table's, where the key is absent).
  [[noreturn]] void fail(std::string_view key, const std::string& reason, const std::string& hint = {}) const;

  /// Throws that a required key is absent.
  [[noreturn]] void fail_missing(std::string_view key, const std::string& hint = {}) const;

  /// "line 12, mirror.file"
  [[nodiscard]] std::string entity(std::string_view key) const;

 private:
  [[noreturn]] void fail_type(const toml::node& node, std::string_view key, std::string_view expected) const;
  [[nodiscard]] double checked_number(const toml::node& node, std::string_view key, Range range) const;

  const toml::table& table_;
  std::string file_, path_;
};

}  // namespace catoptra::app
