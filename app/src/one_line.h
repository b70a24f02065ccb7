// Messages of one line, whatever a file or a library put into them.
#pragma once

#include <string>

namespace catoptra::app {

/// `text` with control characters (line ends, escape sequences) as spaces, and none at the end.
[[nodiscard]] inline std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

}  // namespace catoptra::app
