// A file that a test writes and that goes with it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tests/support/temporary_folder.h"

namespace catoptra::test {

class TextFile {
 public:
  TextFile(const std::string& name, std::string_view text) : path_(folder_.write(name, text)) {}
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  TemporaryFolder folder_;
  std::filesystem::path path_;
};

}  // namespace catoptra::test
