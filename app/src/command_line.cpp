#include "app/command_line.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>

#include "app/src/commands.h"
#include "app/src/nearest_name.h"
#include "app/src/one_line.h"
#include "app/version.h"

namespace catoptra::app {
namespace {

std::string version_line() {
  return "catoptra " + std::string(version());
}

void add_common_options(CLI::App& app, CommonOptions& common) {
  app.set_version_flag("--version", version_line());
  app.add_option("--log-level", common.log_level,
                 "What to tell on standard error: trace, debug, info, warning, error, off")
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "off"}))
      ->option_text("LEVEL")
      ->group("Common options");
  app.add_flag("--no-progress", common.no_progress, "No progress line, even on a terminal")
      ->group("Common options");
}

void set_up_log(const CommonOptions& common) {
  auto logger =
      std::make_shared<spdlog::logger>("catoptra", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("%n: %l: %v");
  logger->set_level(spdlog::level::from_str(common.log_level));
  spdlog::set_default_logger(std::move(logger));
}

int complain(int code, const std::string& text) {
  std::fprintf(stderr, "catoptra: %s\n", one_line(text).c_str());
  return code;
}

const CLI::App* deepest_parsed(const CLI::App* app) {
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  return app;
}

std::string command_path(const CLI::App* app) {
  return app->get_parent() ? command_path(app->get_parent()) + " " + app->get_name() : "catoptra";
}

/// Names that a user may have meant: options of a command, or its subcommands.
std::vector<std::string> names_like(const CLI::App& app, bool options) {
  std::vector<std::string> names;
  if (options) {
    for (const CLI::Option* option : app.get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  } else {
    for (const CLI::App* command :
         app.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); }))
      names.push_back(command->get_name());
  }
  return names;
}

/// What the parser says of the first word that it could not place, or empty: a misspelt option also leaves
/// what it should have set missing, and is then what there is to mend.
std::string unknown_word(const CLI::App& chosen, const CLI::App& root, int argc, char** argv) {
  const std::vector<std::string> left = root.remaining(true);
  const auto word = std::find_if(argv + 1, argv + argc, [&](const char* argument) {
    return std::find(left.begin(), left.end(), argument) != left.end();
  });
  if (word == argv + argc) return {};
  const std::string text = *word, help = "see " + command_path(&chosen) + " --help";
  if (text.size() > 1 && text[0] == '-') {
    const std::string nearest = nearest_name(text.substr(0, text.find('=')), names_like(chosen, true));
    return "unknown option '" + text + "' (" + (nearest.empty() ? "" : "did you mean '" + nearest + "'? ") +
           help + ")";
  }
  const std::vector<std::string> commands = names_like(chosen, false);
  if (commands.empty()) return "unexpected argument '" + text + "' (" + help + ")";
  return "unknown command '" + text + "' (" + hint_for_unknown(text, commands) + "; " + help + ")";
}

/// One line for arguments that the parser refuses.
std::string told(const CLI::ParseError& error, const CLI::App& root, int argc, char** argv) {
  const CLI::App* chosen = deepest_parsed(&root);
  const bool of_words =
      dynamic_cast<const CLI::ExtrasError*>(&error) || dynamic_cast<const CLI::RequiredError*>(&error);
  const std::string word = of_words ? unknown_word(*chosen, root, argc, argv) : std::string{};
  return word.empty() ? std::string(error.what()) + " (see " + command_path(chosen) + " --help)" : word;
}

int run_parsed(const CommandLine& line) {
  const CLI::App* chosen = deepest_parsed(&line.root);
  for (const Command& command : line.commands)
    if (command.app == chosen) return command.run();
  throw UsageError("'" + command_path(chosen) + "' needs a command",
                   "see " + command_path(chosen) + " --help");
}

}  // namespace

CLI::App* add_subcommand(CLI::App& parent, CommonOptions& common, const std::string& name,
                         const std::string& description) {
  CLI::App* app = parent.add_subcommand(name, description);
  add_common_options(*app, common);
  return app;
}

CommandLine::CommandLine()
    : root("See what a curved mirror or a spectacle lens does, straight from CAD, with a stated error",
           "catoptra") {
  add_common_options(root, common);
  commands = {add_info_command(root, common), add_render_command(root, common),
              add_compare_command(root, common), add_bench_command(root, common)};
  for (auto add : {add_lens_commands, add_mirror_commands, add_batch_commands, add_documentation_commands})
    for (Command& command : add(root, common)) commands.push_back(std::move(command));
  root.require_subcommand(0, 1);
  root.footer(
      "Exit codes: 0 done; 1 the work failed; 2 wrong usage; 3 a check that was asked for did not pass.");
}

glm::ivec2 parse_resolution(const std::string& text) {
  int width = 0, height = 0;
  char separator = 0, excess = 0;
  const int read = std::sscanf(text.c_str(), "%5d%c%5d%c", &width, &separator, &height, &excess);
  if (read != 3 || (separator != ',' && separator != 'x'))
    throw UsageError("--resolution '" + text + "' is not a width and a height", "for example 1280,720");
  // The same bound as the scene file's: the largest side that OpenGL drivers in use can render to.
  if (width < 1 || height < 1 || width > 16384 || height > 16384)
    throw UsageError("--resolution '" + text + "' is out of range", "1 to 16384 pixels a side");
  return {width, height};
}

render::Mode parse_mode(const std::string& name) {
  if (const auto mode = render::mode_from_name(name)) return *mode;
  const std::vector<std::string> known{"pvrr", "hybrid", "exact", "raytrace", "cubemap", "auto"};
  throw UsageError("unknown mode '" + name + "'", hint_for_unknown(name, known));
}

std::vector<render::Mode> parse_modes(const std::vector<std::string>& names) {
  std::vector<render::Mode> modes;
  for (const std::string& name : names) {
    const render::Mode mode = parse_mode(name);
    if (std::find(modes.begin(), modes.end(), mode) == modes.end()) modes.push_back(mode);
  }
  return modes;
}

int run_command_line(int argc, char** argv) {
  // A limit on file sizes is a failed write like a full disk, with its error line, and not the end of the
  // process.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    CommandLine line;
    try {
      line.root.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() == 0)
        return line.root.exit(error, std::cout, std::cerr);  // --help, --version
      return complain(kExitUsage, told(error, line.root, argc, argv));
    }
    set_up_log(line.common);
    return run_parsed(line);
  } catch (const UsageError& error) {
    return complain(kExitUsage, error.what());
  } catch (const Error& error) {
    return complain(kExitFailed, error.what());
  } catch (const std::bad_alloc&) {
    return complain(kExitFailed,
                    "out of memory (a smaller resolution, coarser tessellation or smaller files help)");
  } catch (const std::exception& error) {
    return complain(kExitFailed, std::string("unexpected failure: ") + error.what());
  }
}

}  // namespace catoptra::app
