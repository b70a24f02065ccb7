#include "cad_import/src/freecad_archive.h"

#include <zip.h>

#include <algorithm>
#include <fstream>

#include "cad_import/error.h"

namespace catoptra::cad_import {
namespace {

constexpr const char* kSaveAgain = "open it in FreeCAD and save it again, or fetch it again";
// Deflate packs CAD text 3 to 20 times; only data made to blow up comes near its limit of 1032.
constexpr std::uint64_t kMostRatio = 200, kRatioFromBytes = 16ULL << 20;

std::string megabytes(std::uint64_t bytes) {
  return std::to_string(bytes >> 20) + " MB";
}

bool begins_as_zip(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  char begin[2] = {};
  in.read(begin, 2);
  return in && begin[0] == 'P' && begin[1] == 'K';
}

std::string error_text(int code) {
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  std::string text = zip_error_strerror(&error);
  zip_error_fini(&error);
  return text;
}

/// Closes an entry.
struct CloseEntry {
  void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};

}  // namespace

void FreecadArchive::Close::operator()(zip* archive) const {
  zip_discard(archive);
}

bool holds_freecad_document(const std::filesystem::path& file) {
  int code = 0;
  zip_t* archive = zip_open(file.string().c_str(), ZIP_RDONLY, &code);
  if (!archive) return false;
  const bool found = zip_name_locate(archive, "Document.xml", 0) >= 0;
  zip_discard(archive);
  return found;
}

FreecadArchive::FreecadArchive(const std::filesystem::path& file) : file_(file.string()) {
  int code = 0;
  zip_.reset(zip_open(file_.c_str(), ZIP_RDONLY, &code));
  std::error_code unknown;
  bytes_ = std::filesystem::file_size(file, unknown);
  if (zip_ && !unknown) return;
  if (begins_as_zip(file_))
    throw ImportError(file_, "", "the FreeCAD document is cut off or damaged (" + error_text(code) + ")",
                      kSaveAgain);
  throw ImportError(file_, "", "is not a FreeCAD document: it is no ZIP archive", kSaveAgain);
}

std::optional<std::string> FreecadArchive::read(const std::string& entry, std::uint64_t most_bytes) {
  const zip_int64_t index = zip_name_locate(zip_.get(), entry.c_str(), 0);
  if (index < 0) return std::nullopt;
  const auto number = static_cast<zip_uint64_t>(index);
  zip_stat_t stat;
  zip_stat_init(&stat);
  if (zip_stat_index(zip_.get(), number, 0, &stat) != 0 || (stat.valid & ZIP_STAT_SIZE) == 0)
    throw ImportError(file_, entry, "cannot be read from the archive", kSaveAgain);
  if ((stat.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0 && stat.encryption_method != ZIP_EM_NONE)
    throw ImportError(file_, entry, "is encrypted", "save the document without a password");
  if (stat.size > most_bytes || read_bytes_ + stat.size > kMostBytesInAll)
    throw ImportError(file_, entry, "unpacks to " + megabytes(stat.size) + ", more than is read",
                      "hide or remove what is not needed and save the document again");
  const std::uint64_t packed =
      (stat.valid & ZIP_STAT_COMP_SIZE) != 0 ? std::min(stat.comp_size, bytes_) : bytes_;
  if (stat.size > kRatioFromBytes && stat.size / kMostRatio > packed)
    throw ImportError(file_, entry,
                      "unpacks to " + megabytes(stat.size) + " from almost nothing, as no CAD data does",
                      "do not trust this file");

  const std::unique_ptr<zip_file_t, CloseEntry> open(zip_fopen_index(zip_.get(), number, 0));
  if (!open)
    throw ImportError(file_, entry, std::string("cannot be unpacked: ") + zip_strerror(zip_.get()),
                      kSaveAgain);
  std::string bytes(stat.size, '\0');
  std::uint64_t done = 0;
  while (done < stat.size) {
    const zip_int64_t count = zip_fread(open.get(), bytes.data() + done, stat.size - done);
    if (count <= 0) break;
    done += static_cast<std::uint64_t>(count);
  }
  char more = 0;  // the checksum is compared when the end is reached, and not before
  if (done != stat.size || zip_fread(open.get(), &more, 1) != 0)
    throw ImportError(file_, entry, std::string("is damaged: ") + zip_file_strerror(open.get()), kSaveAgain);
  read_bytes_ += stat.size;
  return bytes;
}

}  // namespace catoptra::cad_import
