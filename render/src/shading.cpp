#include "render/src/shading.h"

#include <algorithm>
#include <cmath>

namespace catoptra::render {
namespace {

/// Texel index `i` brought into 0 .. size - 1.
int wrap_texel(int i, int size, cad_import::TextureWrap wrap) {
  switch (wrap) {
    case cad_import::TextureWrap::clamp:
      return std::clamp(i, 0, size - 1);
    case cad_import::TextureWrap::repeat:
      return ((i % size) + size) % size;
    case cad_import::TextureWrap::mirror: {
      const int j = ((i % (2 * size)) + 2 * size) % (2 * size);
      return j < size ? j : 2 * size - 1 - j;
    }
  }
  return 0;
}

/// Alpha at texture coordinates (s, t), bilinear between texel centres.
float bilinear_alpha(const MipLevel& level, glm::vec2 st, cad_import::TextureWrap wrap) {
  const float x = st.x * float(level.width) - 0.5f, y = st.y * float(level.height) - 0.5f;
  if (!std::isfinite(x) || !std::isfinite(y) || std::abs(x) > 1e9f || std::abs(y) > 1e9f) return 1;
  const int i = int(std::floor(x)), j = int(std::floor(y));
  const float fx = x - float(i), fy = y - float(j);
  const auto alpha = [&](int column, int row) {
    const auto c = std::size_t(wrap_texel(column, level.width, wrap)),
               r = std::size_t(wrap_texel(row, level.height, wrap));
    return float(level.rgba[4 * (r * std::size_t(level.width) + c) + 3]) * (1.0f / 255.0f);
  };
  const float top = alpha(i, j) + fx * (alpha(i + 1, j) - alpha(i, j));
  const float bottom = alpha(i, j + 1) + fx * (alpha(i + 1, j + 1) - alpha(i, j + 1));
  return top + fy * (bottom - top);
}

}  // namespace

optics::AlphaTest make_alpha_test(const cad_import::TriangleMesh& mesh,
                                  const std::vector<MipTexture>& textures) {
  const bool any = std::any_of(mesh.materials.begin(), mesh.materials.end(),
                               [](const cad_import::Material& m) { return m.alpha_cutoff > 0; });
  if (!any) return {};
  return [&mesh, &textures](std::uint32_t triangle, float u, float v) {
    const cad_import::Material& m = mesh.materials[mesh.triangle_material[triangle]];
    if (m.alpha_cutoff <= 0) return true;
    if (m.texture < 0) return m.alpha >= m.alpha_cutoff;
    const glm::uvec3 corner = mesh.triangles[triangle];
    const auto& st = mesh.texture_coordinates;
    const glm::vec2 at = (1 - u - v) * st[corner.x] + u * st[corner.y] + v * st[corner.z];
    const MipLevel& finest = textures[std::size_t(m.texture)].levels.front();
    return m.alpha * bilinear_alpha(finest, at, m.wrap) >= m.alpha_cutoff;
  };
}

}  // namespace catoptra::render
