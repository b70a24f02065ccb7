#include "render/src/textures_linear.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "render/image_io.h"
#include "render/src/shading_vector_clones.h"

namespace catoptra::render {
namespace {

using cad_import::TextureWrap;

constexpr int kLanes = TextureLanes::kLanes;
constexpr auto kRepeat = std::int32_t(TextureWrap::repeat), kMirror = std::int32_t(TextureWrap::mirror);

std::array<std::uint16_t, 256> make_linear_table() {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = static_cast<std::uint16_t>(std::lround(65535.0f * srgb_to_linear(float(i) / 255.0f)));
  return table;
}

/// Where each lane's eight texels are (four of each of two levels) and what they weigh.
struct alignas(64) Footprints {
  std::int32_t width[2][kLanes], height[2][kLanes], first[2][kLanes];  ///< of the two levels
  float share[2][kLanes];                                              ///< of the two levels, over 65535
  std::int32_t index[8][kLanes];
  float weight[8][kLanes];
};

/// Largest whole number not above x, for |x| < 2^31.
[[gnu::always_inline]] inline float whole(float x) {
  const auto truncated = float(std::int32_t(x));
  return truncated - (truncated > x ? 1.0f : 0.0f);
}

/// Brings a coordinate into [0, 1] by the wrap mode.
[[gnu::always_inline]] inline float fold(float coordinate, std::int32_t wrap) {
  const float s = std::abs(coordinate) < 1e6f ? coordinate : 0.0f;
  const float repeated = s - whole(s), double_period = s - 2 * whole(0.5f * s);
  const float mirrored = double_period > 1 ? 2 - double_period : double_period;
  const float low = s > 0 ? s : 0.0f, clamped = low < 1 ? low : 1.0f;
  return wrap == kRepeat ? repeated : wrap == kMirror ? mirrored : clamped;
}

/// The two texels on both sides of a coordinate in [0, 1] along an axis of `size` texels, and the weight of
/// the second.
struct Neighbours {
  std::int32_t a, b;
  float weight;
};

[[gnu::always_inline]] inline Neighbours neighbours(float folded, std::int32_t size, std::int32_t wrap) {
  const float x = folded * float(size) - 0.5f;
  const std::int32_t i = std::int32_t(x + 1) - 1;  // rounds down, since x >= -0.5
  const std::int32_t before = wrap == kRepeat ? size - 1 : 0, after = wrap == kRepeat ? 0 : size - 1;
  return {i < 0 ? before : i, i + 1 >= size ? after : i + 1, x - float(i)};
}

CATOPTRA_VECTOR_CLONES void find_texels(const TextureLanes& lanes, Footprints& f) {
  for (int level = 0; level < 2; ++level)
    for (int i = 0; i < kLanes; ++i) {
      const std::int32_t wrap = lanes.wrap[i], width = f.width[level][i], first = f.first[level][i];
      const Neighbours x = neighbours(fold(lanes.s[i], wrap), width, wrap);
      const Neighbours y = neighbours(fold(lanes.t[i], wrap), f.height[level][i], wrap);
      const float top = f.share[level][i] * (1 - y.weight), bottom = f.share[level][i] * y.weight;
      f.index[4 * level][i] = first + y.a * width + x.a;
      f.index[4 * level + 1][i] = first + y.a * width + x.b;
      f.index[4 * level + 2][i] = first + y.b * width + x.a;
      f.index[4 * level + 3][i] = first + y.b * width + x.b;
      f.weight[4 * level][i] = top * (1 - x.weight);
      f.weight[4 * level + 1][i] = top * x.weight;
      f.weight[4 * level + 2][i] = bottom * (1 - x.weight);
      f.weight[4 * level + 3][i] = bottom * x.weight;
    }
}

template <typename Texel>
[[gnu::always_inline]] inline Float4 load(const Texel& texel) {
  using Short4 = std::uint16_t __attribute__((vector_size(8)));
  using Int4 = std::int32_t __attribute__((vector_size(16)));
  Short4 raw;
  std::memcpy(&raw, &texel, sizeof raw);
  // By way of signed integers, which every vector unit converts to float in one step.
  return __builtin_convertvector(__builtin_convertvector(raw, Int4), Float4);
}

const LinearTexture& white() {
  static const LinearTexture texture({{{1, 1, {255, 255, 255, 255}}}});
  return texture;
}

}  // namespace

LinearTexture::LinearTexture(const MipTexture& texture) {
  static const std::array<std::uint16_t, 256> table = make_linear_table();
  for (const MipLevel& level : texture.levels) {
    levels_.push_back({level.width, level.height, int(texels_.size())});
    for (std::size_t i = 0; i + 3 < level.rgba.size(); i += 4) {
      const std::uint8_t* c = &level.rgba[i];
      texels_.push_back({{table[c[0]], table[c[1]], table[c[2]], static_cast<std::uint16_t>(257 * c[3])}});
    }
  }
  texel_count_ = float(levels_.front().width) * float(levels_.front().height);
}

void sample_textures(TextureLanes& lanes) {
  static const LinearTexture& none = white();
  Footprints f;
  const LinearTexture::Texel* texels[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const LinearTexture& texture = lanes.texture[i] ? *lanes.texture[i] : none;
    const float coarsest = float(texture.levels_.size() - 1), wanted = lanes.lod[i];
    const float lod = wanted > 0 ? std::min(wanted, coarsest) : 0.0f;  // 0 too where it is not a number
    const auto finer = std::size_t(lod), coarser = std::min(finer + 1, texture.levels_.size() - 1);
    const float blend = lod - float(finer);
    for (int k = 0; k < 2; ++k) {
      const LinearTexture::Level& level = texture.levels_[k == 0 ? finer : coarser];
      f.width[k][i] = level.width;
      f.height[k][i] = level.height;
      f.first[k][i] = level.first;
    }
    f.share[0][i] = (1 - blend) * (1.0f / 65535.0f);
    f.share[1][i] = blend * (1.0f / 65535.0f);
    texels[i] = texture.texels_.data();
  }
  find_texels(lanes, f);
  for (int i = 0; i < kLanes; ++i) {
    Float4 color = f.weight[0][i] * load(texels[i][f.index[0][i]]);
    for (int k = 1; k < 8; ++k) color += f.weight[k][i] * load(texels[i][f.index[k][i]]);
    lanes.color[i] = color;
  }
}

}  // namespace catoptra::render
