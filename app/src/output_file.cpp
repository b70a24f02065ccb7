#include "app/src/output_file.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "app/src/commands.h"
#include "cad_import/error.h"
#include "render/image_io.h"

namespace catoptra::app {
namespace {

void write_standard_output(std::string_view bytes) {
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
  if (!written || std::fflush(stdout) != 0)
    throw Error("standard output", "", "cannot be written", "is the disk full or the reader gone?");
}

/// Removes a file when it goes out of scope.
struct TemporaryFile {
  std::filesystem::path path;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

std::string lower_suffix(const std::filesystem::path& file) {
  std::string suffix = file.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return suffix;
}

}  // namespace

void write_renamed(const std::filesystem::path& file,
                   const std::function<void(const std::filesystem::path&)>& write) {
  std::filesystem::path name = ".";
  name += file.stem();
  name += ".part" + std::to_string(getpid());
  name += file.extension();
  const TemporaryFile temporary{file.parent_path() / name};
  write(temporary.path);
  std::error_code failure;
  std::filesystem::rename(temporary.path, file, failure);
  if (failure)
    throw Error(file.string(), "", "cannot be written: " + failure.message(), "choose another place");
}

void write_text(const std::filesystem::path& file, std::string_view text) {
  if (file == "-") return write_standard_output(text);
  write_renamed(file, [&](const std::filesystem::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.close();
    if (!stream)
      throw Error(file.string(), "", "cannot be written", "does the folder exist, and may you write there?");
  });
}

std::string png_bytes(const render::Frame& frame) {
  static std::atomic<unsigned> made = 0;  // several threads may be at it (Lens.picture_png in Python)
  const TemporaryFile temporary{
      std::filesystem::temp_directory_path() /
      ("catoptra" + std::to_string(getpid()) + "_" + std::to_string(made++) + ".png")};
  render::write_image(frame, temporary.path);
  std::ifstream stream(temporary.path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

void write_picture(const render::Frame& frame, const std::filesystem::path& file, bool with_geometry) {
  if (file != "-") return render::write_image(frame, file, with_geometry);
  write_standard_output(png_bytes(frame));
}

void check_picture_path(const std::filesystem::path& file) {
  if (file == "-") return;
  const std::string suffix = lower_suffix(file);
  if (suffix != ".png" && suffix != ".exr")
    throw UsageError("-o '" + file.string() + "': pictures are written as .png or .exr",
                     "choose one of these suffixes");
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    throw Error(file.string(), "", "the folder '" + folder.string() + "' does not exist", "make it first");
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure || !std::filesystem::is_directory(folder))
    throw Error(folder.string(), "",
                "cannot make this folder" + (failure ? ": " + failure.message() : std::string{}),
                "choose another place");
}

}  // namespace catoptra::app
