// A picture file that a test writes and that goes with it.
#pragma once

#include <filesystem>
#include <string>

#include "render/image_io.h"
#include "tests/support/temporary_folder.h"

namespace catoptra::test {

class TemporaryImage {
 public:
  TemporaryImage(const std::string& name, const render::Frame& picture) : path_(folder_ / name) {
    render::write_image(picture, path_);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  TemporaryFolder folder_;
  std::filesystem::path path_;
};

}  // namespace catoptra::test
