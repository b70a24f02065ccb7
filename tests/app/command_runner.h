// Runs the built command line as a user's shell does.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace catoptra::test {

struct CommandResult {
  int code = -1;
  std::string output, errors;
};

/// For the shell, in single quotes.
inline std::string shell_quoted(const std::string& text) {
  std::string result(1, '\'');
  for (const char c : text) {
    if (c == '\'') result += "'\\'";
    result += c;
  }
  result += '\'';
  return result;
}

/// `before` stands before the program's name (an environment variable, "timeout 5").
inline CommandResult run_catoptra(const std::vector<std::string>& arguments, const std::string& input = "",
                                  const std::string& before = "") {
  const TemporaryFolder folder;
  folder.write("input", input);
  std::string line = before;
  line += ' ' + shell_quoted(CATOPTRA_PROGRAM);
  for (const std::string& argument : arguments) line += ' ' + shell_quoted(argument);
  for (const auto& [redirection, name] : {std::pair{'<', "input"}, {'>', "output"}})
    line += redirection + shell_quoted((folder / name).string());
  line.append(" 2>").append(shell_quoted((folder / "errors").string()));
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(folder / "output"),
          read_file(folder / "errors")};
}

}  // namespace catoptra::test
