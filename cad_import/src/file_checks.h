// What a CAD file's own bytes say when the kernel only says "failed".
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace catoptra::cad_import {

/// Throws ImportError for a file that is missing, empty, or a git-LFS pointer in place of the data.
void check_readable(const std::filesystem::path& file);

/// The reason to tell after the STEP parser gave up.
[[nodiscard]] std::string why_step_failed(const std::filesystem::path& file);

/// "millimetre", "MM", "Inch", "METRE", ... -> "mm", "in", "m": the spelling unit_in_mm() knows. Others:
/// lower case.
[[nodiscard]] std::string normalized_unit(std::string_view unit);

/// The length of a unit of normalized_unit() in mm: those of unit_in_mm() and the rarer ones that CAD files
/// name.
[[nodiscard]] std::optional<double> file_unit_in_mm(std::string_view unit);

/// A string of a STEP file with its escapes (\X2\...\X0\, \X4\...\X0\, \X\hh, \S\c, \\) turned into UTF-8.
/// Source: ISO 10303-21:2016, 6.4.3.
[[nodiscard]] std::string decoded_step_string(std::string_view text);

}  // namespace catoptra::cad_import
