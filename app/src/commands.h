// The commands of `catoptra`: each adds its options to the parser and returns what runs when it is chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
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
[[nodiscard]] std::vector<Command> add_documentation_commands(CLI::App& root, CommonOptions& common);
[[nodiscard]] std::vector<Command> add_batch_commands(CLI::App& root, CommonOptions& common);

/// The whole command line, as the parser, the man page and the shell completions see it.
struct CommandLine {
  CLI::App root;
  CommonOptions common;
  std::vector<Command> commands;
  CommandLine();
};

/// "1280,720" (or "1280x720"). Throws UsageError.
[[nodiscard]] glm::ivec2 parse_resolution(const std::string& text);

/// A mode of this version. Throws UsageError with the nearest name, or that `exact` and `auto` are yet to
/// come.
[[nodiscard]] render::Mode parse_mode(const std::string& name);
[[nodiscard]] std::vector<render::Mode> parse_modes(const std::vector<std::string>& names);

}  // namespace catoptra::app
