// The validation table of the README: what should come out, what comes out, how far apart they are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace catoptra::validation {

/// Text as printed: so few digits that every machine prints the same ones.
struct Row {
  std::string what;      ///< the case
  std::string expected;  ///< and where it comes from
  std::string computed;
  std::string error;
};

/// Hits, directions and curvatures against formulas. `folder` takes the STEP files that it makes.
[[nodiscard]] std::vector<Row> closed_form_rows(const std::filesystem::path& folder);

/// Measured lenses against published and traced figures.
[[nodiscard]] std::vector<Row> lens_rows();

/// Pictures against exact rays. `examples` holds the example scenes.
[[nodiscard]] std::vector<Row> picture_rows(const std::filesystem::path& examples,
                                            const std::filesystem::path& folder);

/// `value` with `digits` significant digits and the unit.
[[nodiscard]] std::string number(double value, int digits, const std::string& unit = {});

/// For a difference that is rounding error: "< 1e-9 mm", the next power of ten above it.
[[nodiscard]] std::string below(double value, const std::string& unit);

}  // namespace catoptra::validation
