// The commands of `catoptra`: each adds its options to the parser and returns what runs when it is chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "app/command_line.h"
#include "app/src/progress.h"
#include "cad_import/error.h"
#include "render/renderer.h"

namespace catoptra::app {

/// The command line asks for something that does not exist: exit code 2.
class UsageError : public Error {
 public:
  explicit UsageError(std::string reason, std::string hint = {})
      : Error("", "", std::move(reason), std::move(hint)) {}
};

/// What every command takes.
struct CommonOptions {
  std::string log_level = "warning";
  bool no_progress = false;
};

struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;  ///< returns an ExitCode; throws catoptra::Error
};

/// Adds a subcommand with --version, --log-level and --no-progress.
CLI::App* add_subcommand(CLI::App& parent, CommonOptions& common, const std::string& name,
                         const std::string& description);

[[nodiscard]] Command add_info_command(CLI::App& root, CommonOptions& common);
[[nodiscard]] Command add_render_command(CLI::App& root, CommonOptions& common);
[[nodiscard]] Command add_compare_command(CLI::App& root, CommonOptions& common);
[[nodiscard]] Command add_bench_command(CLI::App& root, CommonOptions& common);
[[nodiscard]] std::vector<Command> add_lens_commands(CLI::App& root, CommonOptions& common);
[[nodiscard]] Command add_lens_evaluate_command(CLI::App& lens, CommonOptions& common);
[[nodiscard]] std::vector<Command> add_mirror_commands(CLI::App& root, CommonOptions& common);
[[nodiscard]] Command add_mirror_evaluate_command(CLI::App& mirror, CommonOptions& common);
[[nodiscard]] std::vector<Command> add_documentation_commands(CLI::App& root, CommonOptions& common);
[[nodiscard]] std::vector<Command> add_batch_commands(CLI::App& root, CommonOptions& common);

/// The whole command line, as the parser, the man page and the shell completions see it.
struct CommandLine {
  CLI::App root;
  CommonOptions common;
  std::vector<Command> commands;
  CommandLine();
};

/// Checks of numbers for CLI::Option::check: not-a-number and infinities are refused by each, so that what is
/// out of range is wrong usage (exit 2) before any work.
[[nodiscard]] CLI::Validator finite();
[[nodiscard]] CLI::Validator between(double min, double max);
[[nodiscard]] CLI::Validator above(double min);
[[nodiscard]] CLI::Validator at_least(double min);

/// Throws UsageError unless `file` ends in .step or .stp (any letter case): what the lens and mirror makers
/// write.
void check_step_path(const std::string& file);

/// The corners of --outline, `file`. `words`: outlines that have a name of their own. Throws UsageError for a
/// word that is neither a file nor one of them, else as cad_import::read_outline.
[[nodiscard]] std::vector<glm::dvec2> outline_corners(const std::string& file,
                                                      const std::vector<std::string>& words);

/// "1280,720" (or "1280x720"). Throws UsageError.
[[nodiscard]] glm::ivec2 parse_resolution(const std::string& text);

/// A mode of this version. Throws UsageError with the nearest name, or that `exact` and `auto` are yet to
/// come.
[[nodiscard]] render::Mode parse_mode(const std::string& name);
[[nodiscard]] std::vector<render::Mode> parse_modes(const std::vector<std::string>& names);

}  // namespace catoptra::app
