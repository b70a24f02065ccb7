// Textures as the ray tracer reads them: linear light, 16 bits a channel, trilinear.
#pragma once

#include <cstdint>
#include <vector>

#include "cad_import/triangle_mesh.h"
#include "render/src/textures.h"

namespace catoptra::render {

/// Four floats that the compiler keeps in one vector register.
using Float4 = float __attribute__((vector_size(16)));

/// A mip pyramid of linear RGBA. 16 bits hold every 8-bit sRGB value to 1/40 of its step, in half the memory
/// of floats.
class LinearTexture {
 public:
  explicit LinearTexture(const MipTexture& texture);

  /// Number of texels of the finest level.
  [[nodiscard]] float texel_count() const { return texel_count_; }

  /// Colour at texture coordinates (s, t) and level of detail `lod` (0: the finest level; clamped to those
  /// there are). Coordinates that are not finite give the first texel.
  [[nodiscard]] Float4 sample(float s, float t, float lod, cad_import::TextureWrap wrap) const;

 private:
  struct Level {
    int width, height;
    std::size_t first;  ///< index of the level's first texel
  };
  struct Texel {
    std::uint16_t rgba[4];
  };

  [[nodiscard]] Float4 bilinear(const Level& level, float s, float t, cad_import::TextureWrap wrap) const;
  [[nodiscard]] Float4 texel(std::size_t index) const;

  float texel_count_ = 1;
  std::vector<Level> levels_;
  std::vector<Texel> texels_;
};

}  // namespace catoptra::render
