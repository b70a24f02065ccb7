// Which bytes a result comes from.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace catoptra::app {

/// SHA-256 as 64 lower-case hexadecimal digits. Source: FIPS 180-4.
[[nodiscard]] std::string sha256(std::string_view bytes);

/// Of a file's content. Throws catoptra::Error where it cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace catoptra::app
