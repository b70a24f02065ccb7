#include "app/src/man_page.h"

#include "app/version.h"

namespace catoptra::app {
namespace {

/// Text for troff: backslashes, hyphens, and lines that begin with a control character.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  return !result.empty() && (result[0] == '.' || result[0] == '\'') ? "\\&" + result : result;
}

std::string option_heading(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames())
    names += (names.empty() ? "" : ", ") + ("\\fB" + escaped("-" + name) + "\\fR");
  for (const std::string& name : option.get_lnames())
    names += (names.empty() ? "" : ", ") + ("\\fB" + escaped("--" + name) + "\\fR");
  if (option.nonpositional() && !option.get_option_text().empty())
    names += " \\fI" + escaped(option.get_option_text()) + "\\fR";
  if (!option.nonpositional()) names = "\\fI" + escaped(option.get_name()) + "\\fR";
  return names;
}

std::string options_of(const CLI::App& app, bool with_common) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    const bool common = option->get_group() == "Common options" || option->check_lname("help") ||
                        option->check_lname("version");
    if (common == with_common && !option->get_group().empty())
      text += ".TP\n" + option_heading(*option) + "\n" + escaped(option->get_description()) + "\n";
  }
  return text;
}

std::string commands_of(const CLI::App& app, const std::string& path) {
  std::string text;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_group().empty()) continue;
    const std::string name = path + " " + command->get_name();
    const std::string deeper = commands_of(*command, name);
    if (deeper.empty())
      text += ".SS " + escaped(name) + "\n" + escaped(command->get_description()) + ".\n" +
              options_of(*command, false);
    text += deeper;
  }
  return text;
}

}  // namespace

std::string man_page(const CLI::App& root) {
  return ".TH CATOPTRA 1 \"\" \"catoptra " + std::string(version()) +
         "\" \"User Commands\"\n.SH NAME\ncatoptra \\- " + escaped(root.get_description()) +
         "\n.SH SYNOPSIS\n.B catoptra\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH COMMANDS\n" +
         commands_of(root, "catoptra") + ".SH OPTIONS OF EVERY COMMAND\n" + options_of(root, true) +
         ".SH EXIT STATUS\n.TP\n0\nDone.\n.TP\n1\nThe work failed: one line on standard error names file, "
         "entity, reason and what to do."
         "\n.TP\n2\nWrong usage.\n.TP\n3\nA check or comparison that was asked for did not pass.\n";
}

}  // namespace catoptra::app
