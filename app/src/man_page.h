// The manual page, from the command line's own definition.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace catoptra::app {

/// A page for section 1 in the man macros, with every command and option of `root`.
[[nodiscard]] std::string man_page(const CLI::App& root);

}  // namespace catoptra::app
