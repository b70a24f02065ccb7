// "Did you mean ...?"
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace catoptra::app {

/// Fewest letters to change, add or drop from `a` to `b`, letter case ignored. Source: Levenshtein 1966.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate with the fewest edits from `name` (letter case ignored); empty where none is near enough to
/// be a slip: more than a third of the longer name's letters would have to change.
[[nodiscard]] std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// "a, b, c", cut after `most` names with "... (N in all)".
[[nodiscard]] std::string list_of_names(std::span<const std::string> names, std::size_t most = 12);

/// A hint for an unknown `name`: "did you mean 'x'?" or "known: a, b, c".
[[nodiscard]] std::string hint_for_unknown(std::string_view name, std::span<const std::string> candidates);

}  // namespace catoptra::app
