// Running `catoptra lens evaluate` in tests.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/app/command_runner.h"

namespace catoptra::test {

inline std::vector<std::string> joined(std::vector<std::string> first,
                                       const std::vector<std::string>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// A lens by `catoptra lens make` with these options, as `name` in `folder`; its path.
inline std::string make_lens(const TemporaryFolder& folder, const std::vector<std::string>& options,
                             const std::string& name = "lens.step") {
  std::string file = (folder / name).string();
  const CommandResult made = run_catoptra(joined(joined({"lens", "make"}, options), {"-o", file}));
  EXPECT_EQ(made.code, 0) << made.errors;
  return file;
}

/// The JSON report on `file`; an empty object, and a failure, where the command fails.
inline nlohmann::json evaluate(const std::string& file, const std::vector<std::string>& options) {
  const CommandResult result =
      run_catoptra(joined(joined({"lens", "evaluate", file}, options), {"--json", "-"}));
  EXPECT_EQ(result.code, 0) << result.errors;
  return result.code == 0 ? nlohmann::json::parse(result.output) : nlohmann::json::object();
}

}  // namespace catoptra::test
