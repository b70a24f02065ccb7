#include "app/src/completion.h"

#include <vector>

#include "app/src/commands.h"

namespace catoptra::app {
namespace {

struct Entry {
  std::string path;                                           ///< "mirror make"; empty for the root
  std::vector<std::pair<std::string, std::string>> commands;  ///< name, description
  std::vector<std::pair<std::string, std::string>> options;   ///< "--name", description
};

void collect(const CLI::App& app, const std::string& path, std::vector<Entry>& entries) {
  Entry entry{path, {}, {}};
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames())
      entry.options.emplace_back("--" + name, option->get_description());
  const auto commands = app.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); });
  for (const CLI::App* command : commands)
    entry.commands.emplace_back(command->get_name(), command->get_description());
  entries.push_back(std::move(entry));
  for (const CLI::App* command : commands)
    collect(*command, path + (path.empty() ? "" : " ") + command->get_name(), entries);
}

std::string words(const Entry& entry) {
  std::string text;
  for (const auto& [name, description] : entry.commands) text += name + " ";
  for (const auto& [name, description] : entry.options) text += name + " ";
  text.pop_back();
  return text;
}

/// In single quotes for the shells: an apostrophe ends the quotes, stands escaped, and opens them again.
std::string single_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string bash_script(const std::vector<Entry>& entries) {
  std::string text =
      "_catoptra() {\n"
      "  local word path=\"\" current=\"${COMP_WORDS[COMP_CWORD]}\" words=\"\"\n"
      "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
      "    case \"$path $word\" in\n";
  for (const Entry& entry : entries)
    if (!entry.path.empty()) {
      const auto space = entry.path.rfind(' ');
      const std::string parent = space == std::string::npos ? "" : entry.path.substr(0, space);
      const std::string name = space == std::string::npos ? entry.path : entry.path.substr(space + 1);
      text += "      \"" + parent + " " + name + "\") path=\"" + entry.path + "\" ;;\n";
    }
  text += "    esac\n  done\n  case \"$path\" in\n";
  for (const Entry& entry : entries)
    text += "    \"" + entry.path + "\") words=\"" + words(entry) + "\" ;;\n";
  return text +
         "  esac\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "  case \"$current\" in -*) ;; *) COMPREPLY+=($(compgen -f -- \"$current\")) ;; esac\n"
         "}\n"
         "complete -o filenames -F _catoptra catoptra\n";
}

std::string zsh_script(const std::vector<Entry>& entries) {
  return "#compdef catoptra\nautoload -U +X bashcompinit && bashcompinit\n" + bash_script(entries);
}

std::string fish_script(const std::vector<Entry>& entries) {
  std::string text;
  for (const Entry& entry : entries) {
    std::string condition = "__fish_use_subcommand";
    if (!entry.path.empty()) {
      condition.clear();
      for (std::size_t start = 0; start <= entry.path.size();) {
        const auto end = std::min(entry.path.find(' ', start), entry.path.size());
        condition += (start ? "; and " : "") +
                     ("__fish_seen_subcommand_from " + entry.path.substr(start, end - start));
        start = end + 1;
      }
    }
    for (const auto& [name, description] : entry.commands)
      text += "complete -c catoptra -n " + single_quoted(condition) + " -a " + name + " -d " +
              single_quoted(description) + "\n";
    for (const auto& [name, description] : entry.options)
      text += "complete -c catoptra -n " + single_quoted(condition) + " -l " + name.substr(2) + " -d " +
              single_quoted(description) + "\n";
  }
  return text;
}

}  // namespace

std::string completion_script(const CLI::App& root, const std::string& shell) {
  std::vector<Entry> entries;
  collect(root, "", entries);
  if (shell == "bash") return bash_script(entries);
  if (shell == "zsh") return zsh_script(entries);
  if (shell == "fish") return fish_script(entries);
  throw UsageError("no completion for the shell '" + shell + "'", "bash, zsh or fish");
}

}  // namespace catoptra::app
