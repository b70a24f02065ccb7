// Results on disk or on standard output: whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "render/frame.h"

namespace catoptra::app {

/// Writes `text` to `file`, or to standard output for "-". Throws catoptra::Error.
void write_text(const std::filesystem::path& file, std::string_view text);

/// Calls `write` with a temporary name beside `file` (same suffix) and renames it to `file` when it returns;
/// on an exception the temporary file is removed. Throws catoptra::Error where the rename fails.
void write_renamed(const std::filesystem::path& file,
                   const std::function<void(const std::filesystem::path&)>& write);

/// Writes a picture by its suffix, or as PNG to standard output for "-".
void write_picture(const render::Frame& frame, const std::filesystem::path& file, bool with_geometry);

/// Throws where a picture could not be written to `file`, before the work, not after it: UsageError for a
/// suffix that is none of pictures, catoptra::Error for a folder that is not there.
void check_picture_path(const std::filesystem::path& file);

/// Makes the folder and its parents. Throws catoptra::Error.
void make_folder(const std::filesystem::path& folder);

}  // namespace catoptra::app
