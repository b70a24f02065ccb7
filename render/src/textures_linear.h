// Textures as the ray tracer reads them: linear light, 16 bits a channel, trilinear, sixteen look-ups at
// once.
#pragma once

#include <cstdint>
#include <vector>

#include "cad_import/triangle_mesh.h"
#include "render/src/textures.h"

namespace catoptra::render {

/// Four floats that the compiler keeps in one vector register.
using Float4 = float __attribute__((vector_size(16)));

struct TextureLanes;

/// A mip pyramid of linear RGBA. 16 bits hold every 8-bit sRGB value to 1/40 of its step, in half the memory
/// of floats.
class LinearTexture {
 public:
  explicit LinearTexture(const MipTexture& texture);

  /// Number of texels of the finest level.
  [[nodiscard]] float texel_count() const { return texel_count_; }

 private:
  friend void sample_textures(TextureLanes& lanes);

  struct Level {
    int width, height;
    int first;  ///< index of the level's first texel
  };
  struct Texel {
    std::uint16_t rgba[4];
  };

  float texel_count_ = 1;
  std::vector<Level> levels_;
  std::vector<Texel> texels_;
};

/// Up to 16 look-ups, each in a texture of its own.
struct alignas(64) TextureLanes {
  static constexpr int kLanes = 16;
  // In. Coordinates that are not finite are taken for 0.
  const LinearTexture* texture[kLanes];  ///< null: none, the result is white
  float s[kLanes], t[kLanes];
  float lod[kLanes];  ///< level of detail, 0: the finest; clamped to the levels there are
  cad_import::TextureWrap wrap[kLanes];
  // Out: linear RGBA.
  Float4 color[kLanes];
};

void sample_textures(TextureLanes& lanes);

}  // namespace catoptra::render
