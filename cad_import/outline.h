// Outlines of blanks, as files of corners.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <vector>

#include "cad_import/error.h"

namespace catoptra::cad_import {

/// Reads the outline of a mirror glass or lens: one corner "x y" (or "x, y") in mm per line; "#" begins a
/// comment, a last corner that repeats the first is dropped. Throws ImportError with the line's number.
[[nodiscard]] std::vector<glm::dvec2> read_outline(const std::filesystem::path& file);

}  // namespace catoptra::cad_import
