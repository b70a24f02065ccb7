#include "cad_import/src/file_checks.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <utility>

#include "cad_import/import.h"

namespace catoptra::cad_import {
namespace {

std::string head(const std::filesystem::path& file, std::size_t count) {
  std::ifstream in(file, std::ios::binary);
  std::string text(count, '\0');
  in.read(text.data(), std::streamsize(count));
  text.resize(std::size_t(in.gcount()));
  return text;
}

std::string tail(const std::filesystem::path& file, std::size_t count) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const auto size = std::size_t(std::max<std::streamoff>(0, in.tellg()));
  in.seekg(std::streamoff(size - std::min(size, count)));
  return {std::istreambuf_iterator<char>(in), {}};
}

void append_utf8(std::string& out, unsigned long c) {
  const auto byte = [&out](unsigned long b) { out += char(static_cast<unsigned char>(b)); };
  if (c < 0x80) {
    byte(c);
  } else if (c < 0x800) {
    byte(0xC0 | c >> 6);
    byte(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    byte(0xE0 | c >> 12);
    byte(0x80 | (c >> 6 & 0x3F));
    byte(0x80 | (c & 0x3F));
  } else {
    byte(0xF0 | (c >> 18 & 0x07));
    byte(0x80 | (c >> 12 & 0x3F));
    byte(0x80 | (c >> 6 & 0x3F));
    byte(0x80 | (c & 0x3F));
  }
}

bool all_hex(std::string_view digits) {
  return std::ranges::all_of(digits, [](unsigned char c) { return std::isxdigit(c) != 0; });
}

unsigned long hex(std::string_view digits) {
  return std::stoul(std::string(digits), nullptr, 16);
}

// Decodes the run of `width`-digit code units after \X2\ or \X4\ up to \X0\; returns where the text goes on.
std::size_t decode_run(std::string_view text, std::size_t at, std::size_t width, std::string& out) {
  unsigned long high = 0;
  while (at + width <= text.size() && all_hex(text.substr(at, width))) {
    const unsigned long c = hex(text.substr(at, width));
    at += width;
    if (c >= 0xD800 && c < 0xDC00)
      high = c;  // first half of a UTF-16 pair
    else if (c >= 0xDC00 && c < 0xE000)
      append_utf8(out, 0x10000 + ((high & 0x3FF) << 10) + (c & 0x3FF));
    else
      append_utf8(out, c);
  }
  return text.substr(at, 4) == "\\X0\\" ? at + 4 : at;
}

}  // namespace

void check_readable(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code failure;
  if (!std::filesystem::exists(file, failure)) throw ImportError(name, "", "no such file");
  if (!std::filesystem::is_regular_file(file, failure)) throw ImportError(name, "", "is not a file");
  const std::string begin = head(file, 64);
  if (begin.empty()) {
    if (std::filesystem::file_size(file, failure) > 0 || failure)
      throw ImportError(name, "", "cannot be opened", "check its permissions");
    throw ImportError(name, "", "is empty (0 bytes)", "fetch or export the file again");
  }
  if (begin.starts_with("version https://git-lfs"))
    throw ImportError(name, "", "is a git-LFS pointer, not the CAD file itself",
                      "run `git lfs pull` where it came from");
}

std::string why_step_failed(const std::filesystem::path& file) {
  const std::string begin = head(file, 4096);
  if (begin.find("ISO-10303-21") == std::string::npos)
    return "is not a STEP file (it does not begin with ISO-10303-21)";
  if (tail(file, 256).find("END-ISO-10303-21") == std::string::npos)
    return "is cut off (END-ISO-10303-21 is missing)";
  return "the STEP parser could not read it";
}

std::string normalized_unit(std::string_view unit) {
  std::string lower(unit);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 22> kNames{{
      {"millimetre", "mm"}, {"millimeter", "mm"}, {"millimetres", "mm"}, {"millimeters", "mm"},
      {"centimetre", "cm"}, {"centimeter", "cm"}, {"metre", "m"},        {"meter", "m"},
      {"metres", "m"},      {"meters", "m"},      {"inch", "in"},        {"inches", "in"},
      {"foot", "ft"},       {"feet", "ft"},       {"micrometre", "um"},  {"micrometer", "um"},
      {"micron", "um"},     {"kilometre", "km"},  {"kilometer", "km"},   {"mil", "mil"},
      {"mile", "mi"},       {"microinch", "uin"},
  }};
  for (const auto& [name, symbol] : kNames)
    if (lower == name) return std::string(symbol);
  return lower;
}

std::optional<double> file_unit_in_mm(std::string_view unit) {
  // Source: NIST SP 811 (2008), appendix B.8; the inch is 25.4 mm exactly.
  if (unit == "km") return 1e6;
  if (unit == "mi") return 1609344.0;
  if (unit == "mil") return 0.0254;
  if (unit == "uin") return 25.4e-6;
  return unit_in_mm(unit);
}

std::string decoded_step_string(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view rest = text.substr(i);
    if (rest.starts_with("\\X2\\")) {
      i = decode_run(text, i + 4, 4, out);
    } else if (rest.starts_with("\\X4\\")) {
      i = decode_run(text, i + 4, 8, out);
    } else if (rest.starts_with("\\X\\") && rest.size() >= 5 && all_hex(rest.substr(3, 2))) {
      append_utf8(out, hex(rest.substr(3, 2)));
      i += 5;
    } else if (rest.starts_with("\\S\\") && rest.size() >= 4) {
      append_utf8(out, 128UL + static_cast<unsigned char>(rest[3]));
      i += 4;
    } else if (rest.starts_with("\\\\")) {
      out += '\\';
      i += 2;
    } else {
      out += text[i++];
    }
  }
  return out;
}

}  // namespace catoptra::cad_import
