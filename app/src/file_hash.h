// Which bytes a result comes from.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace catoptra::app {

/// A file that a result comes from.
struct InputFile {
  std::string file;  ///< as the user, or the file that names it, has it
  std::string sha256;
};

/// SHA-256 as 64 lower-case hexadecimal digits. Source: FIPS 180-4.
[[nodiscard]] std::string sha256(std::string_view bytes);

/// Of a file's content. Throws catoptra::Error where it cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file);

/// `files` with their digests, each once, in the order of its first mention; empty paths are left out. Throws
/// catoptra::Error where one cannot be read.
[[nodiscard]] std::vector<InputFile> input_files(std::span<const std::filesystem::path> files);

}  // namespace catoptra::app
