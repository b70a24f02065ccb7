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

std::array<std::uint16_t, 256> make_linear_table() {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = static_cast<std::uint16_t>(std::lround(65535.0f * srgb_to_linear(float(i) / 255.0f)));
  return table;
}

/// Where each lane's eight texels are (four of each of two levels) and what they weigh.
struct alignas(64) Footprints {
  float s[kLanes], t[kLanes];                                          ///< finite coordinates
  float repeat[kLanes], mirror[kLanes], clamp[kLanes];                 ///< 1 for the lane's wrap mode, else 0
  std::int32_t width[2][kLanes], height[2][kLanes], first[2][kLanes];  ///< of the two levels
  std::int32_t across[2][kLanes],
      down[2][kLanes];     ///< how far a repeating texture is to the texel beyond its border
  float share[2][kLanes];  ///< of the two levels, over 65535
  std::int32_t index[8][kLanes];
  float weight[8][kLanes];
};

// What follows is free of branches, so that the compiler can run it for all lanes at once.

/// Largest whole number not above x, for |x| < 2^31.
[[gnu::always_inline]] inline float whole(float x) {
  const auto truncated = float(std::int32_t(x));
  return truncated - float(truncated > x);
}

/// Brings a coordinate into [0, 1] by the wrap mode.
[[gnu::always_inline]] inline float fold(float s, float repeat, float mirror, float clamp) {
  const float repeated = s - whole(s), mirrored = 1 - std::abs(s - 2 * whole(0.5f * s) - 1);
  const float clamped = std::min(std::max(s, 0.0f), 1.0f);
  return repeat * repeated + mirror * mirrored + clamp * clamped;
}

/// The two texels on both sides of a coordinate in [0, 1] along an axis of `size` texels, and the weight of
/// the second.
struct Neighbours {
  std::int32_t a, b;
  float weight;
};

[[gnu::always_inline]] inline Neighbours neighbours(float folded, std::int32_t size, std::int32_t jump) {
  const float x = folded * float(size) - 0.5f;
  const std::int32_t i = std::int32_t(x + 1) - 1, last = size - 1;  // rounds down, since x >= -0.5
  const std::int32_t below = i >> 31,
                     above = (last - i - 1) >> 31;  // all bits set where the neighbour is beyond the border
  return {std::max(i, 0) + (below & jump), std::min(i + 1, last) - (above & jump), x - float(i)};
}

CATOPTRA_VECTOR_CLONES void find_texels(Footprints& f) {
  for (int i = 0; i < kLanes; ++i) {
    f.s[i] = fold(f.s[i], f.repeat[i], f.mirror[i], f.clamp[i]);
    f.t[i] = fold(f.t[i], f.repeat[i], f.mirror[i], f.clamp[i]);
  }
  for (int level = 0; level < 2; ++level)
    for (int i = 0; i < kLanes; ++i) {
      const std::int32_t width = f.width[level][i], first = f.first[level][i];
      const Neighbours x = neighbours(f.s[i], width, f.across[level][i]);
      const Neighbours y = neighbours(f.t[i], f.height[level][i], f.down[level][i]);
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

/// Weighted sums of each lane's eight texels. `texels`: four channels each.
CATOPTRA_VECTOR_CLONES void blend_texels(const Footprints& f, const std::uint16_t* const (&texels)[kLanes],
                                         Float4 (&color)[kLanes]) {
  using Short4 = std::uint16_t __attribute__((vector_size(8)));
  using Int4 = std::int32_t __attribute__((vector_size(16)));
  for (int i = 0; i < kLanes; ++i) {
    Float4 sum{};
    for (int k = 0; k < 8; ++k) {
      Short4 raw;
      std::memcpy(&raw, texels[i] + 4 * std::ptrdiff_t(f.index[k][i]), sizeof raw);
      // By way of signed integers, which every vector unit converts to float in one step.
      sum += f.weight[k][i] * __builtin_convertvector(__builtin_convertvector(raw, Int4), Float4);
    }
    color[i] = sum;
  }
}

/// Coordinates so far out that their fraction means nothing are taken for 0, as are those that are no
/// numbers.
float finite(float coordinate) {
  return std::abs(coordinate) < 1e6f ? coordinate : 0.0f;
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
  const std::uint16_t* texels[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const LinearTexture& texture = lanes.texture[i] ? *lanes.texture[i] : none;
    const float coarsest = float(texture.levels_.size() - 1), wanted = lanes.lod[i];
    const float lod = wanted > 0 ? std::min(wanted, coarsest) : 0.0f;  // 0 too where it is not a number
    const auto finer = std::size_t(lod), coarser = std::min(finer + 1, texture.levels_.size() - 1);
    const float blend = lod - float(finer);
    const bool repeat = lanes.wrap[i] == TextureWrap::repeat;
    f.repeat[i] = float(repeat);
    f.mirror[i] = float(lanes.wrap[i] == TextureWrap::mirror);
    f.clamp[i] = float(lanes.wrap[i] == TextureWrap::clamp);
    f.s[i] = finite(lanes.s[i]);
    f.t[i] = finite(lanes.t[i]);
    for (int k = 0; k < 2; ++k) {
      const LinearTexture::Level& level = texture.levels_[k == 0 ? finer : coarser];
      f.width[k][i] = level.width;
      f.height[k][i] = level.height;
      f.first[k][i] = level.first;
      f.across[k][i] = repeat ? level.width - 1 : 0;
      f.down[k][i] = repeat ? level.height - 1 : 0;
    }
    f.share[0][i] = (1 - blend) * (1.0f / 65535.0f);
    f.share[1][i] = blend * (1.0f / 65535.0f);
    texels[i] = texture.texels_.front().rgba;
  }
  find_texels(f);
  blend_texels(f, texels, lanes.color);
}

}  // namespace catoptra::render
