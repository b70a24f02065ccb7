// Tells a file's format from its first bytes and, where they say nothing, from its suffix.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "cad_import/import.h"
#include "cad_import/src/freecad_archive.h"

namespace catoptra::cad_import {
namespace {

/// Enough for every header, and for a glTF whose "asset" comes after other short keys.
constexpr std::size_t kHeadBytes = 1 << 16;

struct FileHead {
  std::string bytes;        ///< the first kHeadBytes at most
  std::uintmax_t size = 0;  ///< of the whole file
};

FileHead read_head(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw ImportError(file.string(), "", "no such file");
  if (std::filesystem::is_directory(status)) throw ImportError(file.string(), "", "is a folder, not a file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw ImportError(file.string(), "", "cannot be opened", "check the read permission");
  FileHead head;
  head.bytes.resize(kHeadBytes);
  stream.read(head.bytes.data(), static_cast<std::streamsize>(kHeadBytes));
  head.bytes.resize(static_cast<std::size_t>(stream.gcount()));
  head.size = std::filesystem::file_size(file, error);
  if (error) head.size = head.bytes.size();
  return head;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool starts_with_word(std::string_view text, std::string_view word) {
  return text.substr(0, word.size()) == word &&
         (text.size() == word.size() || std::isspace(static_cast<unsigned char>(text[word.size()])) != 0);
}

/// The text without a UTF-8 byte order mark and leading white space.
std::string_view skip_blank(std::string_view text) {
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  return text;
}

/// Files that people hand over in place of a model, each with the advice that helps.
void reject_look_alikes(const std::filesystem::path& file, const FileHead& head) {
  const std::string_view text = head.bytes;
  if (head.size == 0) throw ImportError(file.string(), "", "the file is empty");
  if (text.substr(0, 42) == "version https://git-lfs.github.com/spec/v1")
    throw ImportError(file.string(), "", "is a Git LFS pointer, not the file itself", "run git lfs pull");
  if (text.substr(0, 2) == "\xFE\xFF" || text.substr(0, 2) == "\xFF\xFE")
    throw ImportError(file.string(), "", "is UTF-16 text, which no CAD or mesh format allows",
                      "save it as UTF-8");
}

/// IGES 5.3, 2.2: lines of 80 columns whose column 73 is the section's letter; the first is the start
/// section.
bool looks_like_iges(std::string_view text) {
  if (text.size() < 80) return false;
  if (text.substr(0, 72).find_first_of("\r\n") != std::string_view::npos) return false;
  if (text[72] != 'S' && text[72] != 'C') return false;
  return std::all_of(text.begin() + 73, text.begin() + 80,
                     [](unsigned char c) { return std::isdigit(c) != 0 || c == ' '; });
}

/// 80 bytes of header, a little-endian count, 50 bytes per triangle.
bool looks_like_binary_stl(const FileHead& head) {
  if (head.bytes.size() < 84) return false;
  std::uint32_t count = 0;
  for (int i = 3; i >= 0; --i)
    count = count << 8 | static_cast<unsigned char>(head.bytes[80 + static_cast<std::size_t>(i)]);
  return head.size == 84 + 50 * static_cast<std::uintmax_t>(count);
}

/// Every whole line in the head begins with an OBJ keyword, and one of them is a vertex.
bool looks_like_obj(std::string_view text) {
  constexpr std::array<std::string_view, 14> kKeywords{
      "v", "vt", "vn", "vp", "f", "o", "g", "s", "l", "p", "usemtl", "mtllib", "usemap", "cstype"};
  bool vertex = false;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos && text.size() > 256) break;  // cut off by the head's length
    const std::string_view line = skip_blank(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty() || line.front() == '#') continue;
    if (std::none_of(kKeywords.begin(), kKeywords.end(),
                     [&](auto word) { return starts_with_word(line, word); }))
      return false;
    vertex = vertex || starts_with_word(line, "v");
  }
  return vertex;
}

/// FreeCAD writes Document.xml first; other programs that pack a document again may not.
bool looks_like_freecad(const std::filesystem::path& file, std::string_view text) {
  if (text.substr(0, 4) != std::string_view("PK\x03\x04", 4)) return false;
  return text.substr(std::min<std::size_t>(30, text.size()), 12) == "Document.xml" ||
         holds_freecad_document(file);
}

FileFormat format_of_content(const std::filesystem::path& file, const FileHead& head) {
  const std::string_view all = head.bytes;
  if (looks_like_freecad(file, all)) return FileFormat::freecad;
  const std::string_view text = skip_blank(all);
  const std::string_view opening = text.substr(0, 1024);
  if (opening.find("ISO-10303-21") != std::string_view::npos) return FileFormat::step;
  if (opening.find("DBRep_DrawableShape") != std::string_view::npos ||
      opening.find("CASCADE Topology V") != std::string_view::npos)
    return FileFormat::brep;
  if (looks_like_iges(all)) return FileFormat::iges;
  if (all.substr(0, 4) == "glTF") return FileFormat::gltf;
  if (!text.empty() && text.front() == '{' && text.find("\"asset\"") != std::string_view::npos)
    return FileFormat::gltf;
  if (starts_with_word(text, "ply")) return FileFormat::ply;
  if (looks_like_binary_stl(head)) return FileFormat::stl;
  if (starts_with_word(text, "solid") && text.find("facet") != std::string_view::npos) return FileFormat::stl;
  if (looks_like_obj(text)) return FileFormat::obj;
  return FileFormat::unknown;
}

FileFormat format_of_suffix(const std::filesystem::path& file) {
  constexpr std::array<std::pair<std::string_view, FileFormat>, 13> kSuffixes{
      {{".step", FileFormat::step},
       {".stp", FileFormat::step},
       {".p21", FileFormat::step},
       {".iges", FileFormat::iges},
       {".igs", FileFormat::iges},
       {".brep", FileFormat::brep},
       {".brp", FileFormat::brep},
       {".fcstd", FileFormat::freecad},
       {".gltf", FileFormat::gltf},
       {".glb", FileFormat::gltf},
       {".obj", FileFormat::obj},
       {".stl", FileFormat::stl},
       {".ply", FileFormat::ply}}};
  const std::string suffix = lower_case(file.extension().string());
  const auto found =
      std::find_if(kSuffixes.begin(), kSuffixes.end(), [&](const auto& s) { return s.first == suffix; });
  return found == kSuffixes.end() ? FileFormat::unknown : found->second;
}

}  // namespace

bool is_cad(FileFormat format) {
  return format == FileFormat::step || format == FileFormat::iges || format == FileFormat::brep ||
         format == FileFormat::freecad;
}

FileFormat sniff_format(const std::filesystem::path& file) {
  const FileHead head = read_head(file);
  reject_look_alikes(file, head);
  const FileFormat format = format_of_content(file, head);
  return format != FileFormat::unknown ? format : format_of_suffix(file);
}

std::optional<double> unit_in_mm(std::string_view unit) {
  // The inch is 25.4 mm by definition since 1959 (NIST SP 447, appendix 5); the others follow.
  constexpr std::array<std::pair<std::string_view, double>, 25> kUnits{
      {{"mm", 1},          {"millimetre", 1},    {"millimeter", 1},    {"cm", 10},         {"centimetre", 10},
       {"centimeter", 10}, {"dm", 100},          {"decimetre", 100},   {"decimeter", 100}, {"m", 1000},
       {"metre", 1000},    {"meter", 1000},      {"km", 1e6},          {"kilometre", 1e6}, {"kilometer", 1e6},
       {"in", 25.4},       {"inch", 25.4},       {"ft", 304.8},        {"foot", 304.8},    {"feet", 304.8},
       {"um", 1e-3},       {"micrometre", 1e-3}, {"micrometer", 1e-3}, {"micron", 1e-3},   {"yd", 914.4}}};
  std::string name = lower_case(unit);
  const auto find = [&] {
    return std::find_if(kUnits.begin(), kUnits.end(), [&](const auto& u) { return u.first == name; });
  };
  auto found = find();
  if (found == kUnits.end() && name.size() > 3 && name.back() == 's') {  // "metres", "inches"
    name.resize(name.size() - (name == "inches" ? 2 : 1));
    found = find();
  }
  if (found == kUnits.end()) return std::nullopt;
  return found->second;
}

}  // namespace catoptra::cad_import
