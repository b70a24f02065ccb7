#include "examples/street/pixmap.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace catoptra::examples {

Rgba mix(const Rgba& a, const Rgba& b, float t) {
  Rgba result{};
  for (std::size_t i = 0; i < 4; ++i)
    result[i] = static_cast<std::uint8_t>(std::lround((1 - t) * float(a[i]) + t * float(b[i])));
  return result;
}

float noise(int x, int y, int seed) {
  // Integer hash with the multipliers of Murmur3's finaliser (Appleby, public domain).
  auto h = static_cast<std::uint32_t>(x) * 0x9E3779B9u + static_cast<std::uint32_t>(y) * 0x85EBCA6Bu +
           static_cast<std::uint32_t>(seed) * 0xC2B2AE35u;
  h ^= h >> 16;
  h *= 0x85EBCA6Bu;
  h ^= h >> 13;
  h *= 0xC2B2AE35u;
  h ^= h >> 16;
  return static_cast<float>(h >> 8) / 16777216.0f;
}

Pixmap::Pixmap(int width, int height, const Rgba& color)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), color) {}

Rgba Pixmap::at(int x, int y) const {
  return pixels_.at(static_cast<std::size_t>(y) * width_ + x);
}

void Pixmap::set(int x, int y, const Rgba& color) {
  if (x >= 0 && y >= 0 && x < width_ && y < height_)
    pixels_[static_cast<std::size_t>(y) * width_ + x] = color;
}

void Pixmap::blend(int x, int y, const Rgba& color, float coverage) {
  if (coverage > 0 && x >= 0 && y >= 0 && x < width_ && y < height_)
    set(x, y, mix(at(x, y), color, coverage));
}

void Pixmap::rectangle(int x0, int y0, int x1, int y1, const Rgba& color) {
  for (int y = std::max(0, y0); y < std::min(height_, y1); ++y)
    for (int x = std::max(0, x0); x < std::min(width_, x1); ++x) set(x, y, color);
}

void Pixmap::disc(glm::vec2 centre, float radius, const Rgba& color) {
  for (int y = int(centre.y - radius) - 1; y <= int(centre.y + radius) + 1; ++y)
    for (int x = int(centre.x - radius) - 1; x <= int(centre.x + radius) + 1; ++x) {
      const float distance = std::hypot(float(x) + 0.5f - centre.x, float(y) + 0.5f - centre.y);
      blend(x, y, color, std::clamp(radius + 0.5f - distance, 0.0f, 1.0f));
    }
}

void Pixmap::polygon(const std::vector<glm::vec2>& corners, const Rgba& color) {
  const auto inside = [&](glm::vec2 p) {
    int left = 0, right = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
      ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) >= 0 ? left : right)++;
    }
    return left == 0 || right == 0;
  };
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      int covered = 0;
      for (int sample = 0; sample < 16; ++sample)
        covered +=
            inside({float(x) + (float(sample % 4) + 0.5f) / 4, float(y) + (float(sample / 4) + 0.5f) / 4});
      blend(x, y, color, float(covered) / 16);
    }
}

void Pixmap::grain(float amount, int cell, int seed) {
  const int columns = std::max(1, width_ / cell), rows = std::max(1, height_ / cell);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const float gain = 1 + amount * (2 * noise((x / cell) % columns, (y / cell) % rows, seed) - 1);
      Rgba color = at(x, y);
      for (std::size_t i = 0; i < 3; ++i)
        color[i] = static_cast<std::uint8_t>(std::clamp(std::lround(float(color[i]) * gain), 0L, 255L));
      set(x, y, color);
    }
}

struct Font::Impl {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  ~Impl() {
    if (face) FT_Done_Face(face);
    if (library) FT_Done_FreeType(library);
  }
};

Font::Font(const std::filesystem::path& file) : impl_(std::make_unique<Impl>()) {
  if (FT_Init_FreeType(&impl_->library) != 0) throw std::runtime_error("FreeType does not start");
  if (FT_New_Face(impl_->library, file.c_str(), 0, &impl_->face) != 0)
    throw std::runtime_error(file.string() + ": not a font that FreeType reads");
}
Font::~Font() = default;
Font::Font(Font&&) noexcept = default;
Font& Font::operator=(Font&&) noexcept = default;

namespace {

/// Code points of well-formed UTF-8 up to three bytes long: all that a sign needs.
std::vector<FT_ULong> code_points(std::string_view utf8) {
  std::vector<FT_ULong> result;
  for (std::size_t i = 0; i < utf8.size();) {
    const auto byte = static_cast<unsigned char>(utf8[i]);
    const std::size_t length = byte < 0x80 ? 1 : byte < 0xE0 ? 2 : 3;
    FT_ULong code = length == 1 ? byte : byte & (0xFFu >> (length + 1));
    for (std::size_t k = 1; k < length && i + k < utf8.size(); ++k)
      code = code << 6 | (static_cast<unsigned char>(utf8[i + k]) & 0x3Fu);
    result.push_back(code);
    i += length;
  }
  return result;
}

constexpr float kFixed26_6 = 64;  // FreeType's unit of length: 1/64 px

float line_width(FT_Face face, const std::vector<FT_ULong>& line) {
  float width = 0;
  for (const FT_ULong code : line)
    if (FT_Load_Char(face, code, FT_LOAD_NO_HINTING) == 0)
      width += float(face->glyph->advance.x) / kFixed26_6;
  return width;
}

}  // namespace

void Pixmap::text(const Font& font, std::string_view utf8, glm::vec2 centre, float height, float max_width,
                  const Rgba& color) {
  const FT_Face face = font.impl().face;
  const auto line = code_points(utf8);
  // A capital of this font family is 0.729 em high.
  const auto size = static_cast<FT_F26Dot6>(height / 0.729f * kFixed26_6);
  FT_Set_Char_Size(face, size, size, 72, 72);
  float width = line_width(face, line);
  if (width > max_width) {
    FT_Set_Char_Size(face, static_cast<FT_F26Dot6>(float(size) * max_width / width), size, 72, 72);
    width = line_width(face, line);
  }
  float pen = centre.x - width / 2;
  const float baseline = centre.y + height / 2;
  for (const FT_ULong code : line) {
    if (FT_Load_Char(face, code, FT_LOAD_RENDER | FT_LOAD_NO_HINTING) != 0) continue;
    const FT_Bitmap& glyph = face->glyph->bitmap;
    for (int y = 0; y < int(glyph.rows); ++y)
      for (int x = 0; x < int(glyph.width); ++x)
        blend(int(std::lround(pen)) + face->glyph->bitmap_left + x,
              int(std::lround(baseline)) - face->glyph->bitmap_top + y, color,
              float(glyph.buffer[y * glyph.pitch + x]) / 255);
    pen += float(face->glyph->advance.x) / kFixed26_6;
  }
}

std::vector<std::byte> Pixmap::png() const {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput sink(bytes);
  const auto output = OIIO::ImageOutput::create("png");
  OIIO::ImageSpec spec(width_, height_, 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (!output || !output->set_ioproxy(&sink) || !output->open("texture.png", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, pixels_.data()) || !output->close())
    throw std::runtime_error("PNG encoding failed: " + (output ? output->geterror() : OIIO::geterror()));
  std::vector<std::byte> result(bytes.size());
  std::transform(bytes.begin(), bytes.end(), result.begin(), [](unsigned char b) { return std::byte{b}; });
  return result;
}

}  // namespace catoptra::examples
