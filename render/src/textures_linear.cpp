#include "render/src/textures_linear.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "render/image_io.h"

namespace catoptra::render {
namespace {

using cad_import::TextureWrap;

std::array<std::uint16_t, 256> make_linear_table() {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = static_cast<std::uint16_t>(std::lround(65535.0f * srgb_to_linear(float(i) / 255.0f)));
  return table;
}

/// The two neighbouring texels of a coordinate along one axis, and the weight of the second.
struct Span {
  int first, second;
  float weight;
};

/// Brings a coordinate into [0, 1] by the wrap mode.
inline float fold(float s, TextureWrap wrap) {
  if (!(std::abs(s) < 1e6f)) return 0;
  switch (wrap) {
    case TextureWrap::repeat:
      return s - std::floor(s);
    case TextureWrap::clamp:
      return std::clamp(s, 0.0f, 1.0f);
    case TextureWrap::mirror: {
      const float r = s - 2 * std::floor(0.5f * s);
      return r > 1 ? 2 - r : r;
    }
  }
  return 0;
}

inline Span neighbours(float s, int size, TextureWrap wrap) {
  const float x = fold(s, wrap) * float(size) - 0.5f;
  const int i = int(x + 1) - 1;  // floor: x >= -0.5
  Span span{i, i + 1, x - float(i)};
  const bool repeat = wrap == TextureWrap::repeat;
  if (span.first < 0) span.first = repeat ? size - 1 : 0;
  if (span.second >= size) span.second = repeat ? 0 : size - 1;
  return span;
}

}  // namespace

LinearTexture::LinearTexture(const MipTexture& texture) {
  static const std::array<std::uint16_t, 256> table = make_linear_table();
  for (const MipLevel& level : texture.levels) {
    levels_.push_back({level.width, level.height, texels_.size()});
    for (std::size_t i = 0; i + 3 < level.rgba.size(); i += 4) {
      const std::uint8_t* c = &level.rgba[i];
      texels_.push_back({{table[c[0]], table[c[1]], table[c[2]], static_cast<std::uint16_t>(257 * c[3])}});
    }
  }
  texel_count_ = float(levels_.front().width) * float(levels_.front().height);
}

inline Float4 LinearTexture::texel(std::size_t index) const {
  using Short4 = std::uint16_t __attribute__((vector_size(8)));
  using Int4 = std::int32_t __attribute__((vector_size(16)));
  Short4 raw;
  std::memcpy(&raw, &texels_[index], sizeof raw);
  // By way of signed integers, which every vector unit converts to float in one step.
  return __builtin_convertvector(__builtin_convertvector(raw, Int4), Float4);
}

inline Float4 LinearTexture::bilinear(const Level& level, float s, float t, TextureWrap wrap) const {
  const Span x = neighbours(s, level.width, wrap), y = neighbours(t, level.height, wrap);
  const std::size_t top = level.first + std::size_t(y.first) * std::size_t(level.width);
  const std::size_t bottom = level.first + std::size_t(y.second) * std::size_t(level.width);
  const Float4 a = texel(top + std::size_t(x.first)), b = texel(top + std::size_t(x.second));
  const Float4 c = texel(bottom + std::size_t(x.first)), d = texel(bottom + std::size_t(x.second));
  const Float4 upper = a + x.weight * (b - a), lower = c + x.weight * (d - c);
  return (1.0f / 65535.0f) * (upper + y.weight * (lower - upper));
}

Float4 LinearTexture::sample(float s, float t, float lod, TextureWrap wrap) const {
  const float coarsest = float(levels_.size() - 1);
  if (!(lod > 0)) return bilinear(levels_.front(), s, t, wrap);
  if (lod >= coarsest) return bilinear(levels_.back(), s, t, wrap);
  const auto level = std::size_t(lod);
  const float weight = lod - float(level);
  const Float4 fine = bilinear(levels_[level], s, t, wrap), coarse = bilinear(levels_[level + 1], s, t, wrap);
  return fine + weight * (coarse - fine);
}

}  // namespace catoptra::render
