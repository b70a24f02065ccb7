// The command line `catoptra`. docs/command-line.md describes every command.
#pragma once

namespace catoptra::app {

/// Exit codes that scripts rely on.
enum ExitCode : int {
  kExitDone = 0,
  kExitFailed = 1,  ///< the work failed: one line on standard error names file, entity, reason and what to do
  kExitUsage = 2,   ///< wrong usage
  kExitCheckFailed = 3,  ///< a check or comparison that was asked for did not pass
};

/// Runs one command; results go to standard output, everything else to standard error. Never throws.
[[nodiscard]] int run_command_line(int argc, char** argv);

}  // namespace catoptra::app
