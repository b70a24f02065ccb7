// Shell completion, from the command line's own definition.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace catoptra::app {

/// A script for "bash", "zsh" or "fish" that completes commands, options and file names.
/// Throws UsageError for another shell.
[[nodiscard]] std::string completion_script(const CLI::App& root, const std::string& shell);

}  // namespace catoptra::app
