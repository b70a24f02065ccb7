// catoptra man, catoptra completion SHELL
#include <memory>

#include "app/src/commands.h"
#include "app/src/completion.h"
#include "app/src/man_page.h"
#include "app/src/output_file.h"

namespace catoptra::app {

std::vector<Command> add_documentation_commands(CLI::App& root, CommonOptions& common) {
  CLI::App* man = add_subcommand(root, common, "man", "Print the manual page (catoptra man | man -l -)");
  CLI::App* completion = add_subcommand(root, common, "completion", "Print the completion script of a shell");
  auto shell = std::make_shared<std::string>();
  completion->add_option("SHELL", *shell, "bash, zsh or fish")->required();
  const auto print_man = [&root]() -> int {
    write_text("-", man_page(root));
    return kExitDone;
  };
  const auto print_completion = [&root, shell]() -> int {
    write_text("-", completion_script(root, *shell));
    return kExitDone;
  };
  return {{man, print_man}, {completion, print_completion}};
}

}  // namespace catoptra::app
