// Names as people write them: found without case and punctuation, and the nearest where there is none.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace catoptra::optics {

/// Letters, digits and points only, lower case: "CR-39", "cr 39" and "CR39" are one name.
[[nodiscard]] std::string folded(std::string_view name);

/// The three of `names` that differ from `name` by the fewest letters (Levenshtein), "a, b, c".
[[nodiscard]] std::string nearest_names(std::string_view name, std::span<const std::string> names);

}  // namespace catoptra::optics
