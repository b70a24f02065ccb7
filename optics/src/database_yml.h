// What readers of the refractiveindex.info database share.
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "cad_import/error.h"

namespace catoptra::optics {

/// The numbers of a text up to the first thing that is none.
[[nodiscard]] inline std::vector<double> numbers(const std::string& text) {
  std::istringstream in(text);
  std::vector<double> values;
  for (double value; in >> value;) values.push_back(value);
  return values;
}

[[noreturn]] inline void fail_database(const std::filesystem::path& file, const std::string& entry,
                                       const std::string& reason) {
  throw Error(file.string(), entry, reason, "expected a material of the refractiveindex.info database");
}

/// Calls `read(entry, type)` for each entry of DATA until it returns something, and returns that. Throws
/// Error naming the line of damaged files, and where no entry was of use: `holds no NOTHING`.
template <class Read>
[[nodiscard]] auto read_database(const std::filesystem::path& file, const std::string& nothing, Read&& read) {
  if (!std::filesystem::is_regular_file(file))
    throw Error(file.string(), "", "cannot be opened", "check the path and its permissions");
  try {
    const YAML::Node root = YAML::LoadFile(file.string());
    for (const YAML::Node& data : root["DATA"])
      if (auto result = read(data, data["type"].as<std::string>())) return *std::move(result);
  } catch (const YAML::Exception& error) {
    fail_database(file, "line " + std::to_string(error.mark.line + 1), error.msg);
  }
  fail_database(file, "DATA", "holds no " + nothing);
}

}  // namespace catoptra::optics
