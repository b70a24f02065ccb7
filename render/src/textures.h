// Decoded textures of a scene with their mip levels: one set of texels for the GPU and for the ray tracer.
#pragma once

#include <cstdint>
#include <vector>

#include "render/scene.h"

namespace catoptra::render {

/// One mip level, RGBA 8-bit, colour sRGB-encoded, alpha linear; row-major, top row first.
struct MipLevel {
  int width = 1, height = 1;
  std::vector<std::uint8_t> rgba;
};

/// Level 0 is the image; each further level is half of the last (rounded down, at least 1) by box filter in
/// linear light, down to 1 x 1.
struct MipTexture {
  std::vector<MipLevel> levels;
};

/// Equirectangular sky, linear RGB float, top row = +z.
struct SkyImage {
  int width = 0, height = 0;
  std::vector<float> rgb;
};

struct SceneTextures {
  /// textures[m][i] is texture i of surroundings mesh m.
  std::vector<std::vector<MipTexture>> textures;
  SkyImage sky;  ///< width 0: none
};

/// Decodes everything that the scene refers to. Throws catoptra::Error naming the image.
[[nodiscard]] SceneTextures load_textures(const Scene& scene);

}  // namespace catoptra::render
