// The ZIP archive that a FreeCAD document is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct zip;

namespace catoptra::cad_import {

/// True where the file is a ZIP archive with a Document.xml in it. Never throws.
[[nodiscard]] bool holds_freecad_document(const std::filesystem::path& file);

/// An open archive. Entries are read into memory by their exact names; nothing is ever unpacked to disk, so
/// that paths in names lead nowhere.
class FreecadArchive {
 public:
  /// Largest sizes read, in bytes unpacked. The largest entries of real documents are shapes of some 100 MB.
  static constexpr std::uint64_t kMostXmlBytes = 128ULL << 20;
  static constexpr std::uint64_t kMostShapeBytes = 1ULL << 30;
  static constexpr std::uint64_t kMostBytesInAll = 4ULL << 30;
  static constexpr std::uint64_t kMostListBytes = 64ULL << 20;

  /// Throws ImportError where the file is not a ZIP archive or is cut off.
  explicit FreecadArchive(const std::filesystem::path& file);

  [[nodiscard]] const std::string& file() const { return file_; }

  /// The unpacked entry; nullopt where there is none of this name. Throws ImportError, with the entry's name,
  /// for damage (checksum), encryption, more than `most_bytes`, and compression that no CAD data reaches.
  [[nodiscard]] std::optional<std::string> read(const std::string& entry, std::uint64_t most_bytes);

 private:
  struct Close {
    void operator()(zip* archive) const;
  };
  std::string file_;
  std::unique_ptr<zip, Close> zip_;
  std::uint64_t bytes_ = 0;       // of the whole file
  std::uint64_t read_bytes_ = 0;  // unpacked so far
};

}  // namespace catoptra::cad_import
