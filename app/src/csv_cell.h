// A text as one cell of a CSV table.
#pragma once

#include <string>

namespace catoptra::app {

/// Quoted where it holds a comma, a quote or a line end. Source: RFC 4180.
[[nodiscard]] inline std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace catoptra::app
