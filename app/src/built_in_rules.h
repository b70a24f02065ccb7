// The files of app/rules, compiled into the program as text.
#pragma once

#include <span>
#include <string_view>

namespace catoptra::app {

struct BuiltInRule {
  std::string_view id;  ///< the file's name without suffix: its `id` in lower case
  std::string_view text;
};

[[nodiscard]] std::span<const BuiltInRule> built_in_rule_texts();

}  // namespace catoptra::app
