#include "render/src/shading.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

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

/// log2 to 1e-4, without a library call: a level of detail needs no more. 0 and denormals give about -127.
inline float fast_log2(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const float exponent = float(int(bits >> 23) - 127);
  const float m = std::bit_cast<float>((bits & 0x007fffffu) | 0x3f800000u);  // in [1, 2)
  const float r = (m - 1) / (m + 1), q = r * r;
  // ln m = 2 artanh r, r <= 1/3: the fourth term is below 2e-5.
  return exponent + 2.8853901f * r * (1 + q * (1 / 3.0f + q * (1 / 5.0f + q * (1 / 7.0f))));
}

inline Float4 float4(const glm::vec3& v) {
  return Float4{v.x, v.y, v.z, 0};
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

glm::vec3 sky_radiance(const SkyImage& sky, const Environment& environment, const glm::vec3& direction) {
  if (sky.width < 1) return environment.color;
  const float length =
      std::sqrt(direction.x * direction.x + direction.y * direction.y + direction.z * direction.z);
  const float across = std::atan2(direction.x, direction.y) * (0.5f / std::numbers::pi_v<float>)+0.5f;
  const float down = std::acos(std::clamp(direction.z / length, -1.0f, 1.0f)) / std::numbers::pi_v<float>;
  const float x = across * float(sky.width) - 0.5f,
              y = std::clamp(down * float(sky.height) - 0.5f, 0.0f, float(sky.height - 1));
  const int i = int(std::floor(x)), j = std::min(int(y), sky.height - 1);
  const float fx = x - float(i), fy = y - float(j);
  const auto texel = [&](int column, int row) {
    const auto c = std::size_t(wrap_texel(column, sky.width, cad_import::TextureWrap::repeat));
    const float* p = &sky.rgb[3 * (std::size_t(std::min(row, sky.height - 1)) * std::size_t(sky.width) + c)];
    return glm::vec3(p[0], p[1], p[2]);
  };
  const glm::vec3 top = texel(i, j) + fx * (texel(i + 1, j) - texel(i, j));
  const glm::vec3 bottom = texel(i, j + 1) + fx * (texel(i + 1, j + 1) - texel(i, j + 1));
  return top + fy * (bottom - top);
}

/// Intermediate values of one call of shade().
struct alignas(64) ShadingScene::Gathered {
  const ShadeMaterial* material[ShadeLanes::kLanes];
  float nx[ShadeLanes::kLanes], ny[ShadeLanes::kLanes], nz[ShadeLanes::kLanes];
  /// Texels per unit of area on the surface, times twice the triangle's area.
  float texels[ShadeLanes::kLanes];
  float red[ShadeLanes::kLanes], green[ShadeLanes::kLanes], blue[ShadeLanes::kLanes];  ///< irradiance
  TextureLanes texture;
};

ShadingScene::ShadingScene(const Scene& scene, const SceneTextures& textures)
    : scene_(scene), textures_(textures) {
  linear_.reserve(scene.surroundings.size());
  for (std::size_t m = 0; m < scene.surroundings.size(); ++m)
    add_surroundings(scene.surroundings[m], textures.textures[m]);
  for (std::size_t i = 0; i < scene.optics.size(); ++i) {
    optic_material_.push_back(static_cast<std::uint32_t>(materials_.size()));
    materials_.push_back({float4(scene.optics[i].reflectance), Float4{}});
    materials_.push_back({float4(glm::vec3(kOpticBackAlbedo)), Float4{}});
    materials_.push_back({float4(scene.optics[i].material.color), Float4{}});
    objects_.emplace_back();
    pack_optic(i);
  }
}

void ShadingScene::add_surroundings(const cad_import::TriangleMesh& mesh,
                                    const std::vector<MipTexture>& textures) {
  auto& linear = linear_.emplace_back();
  linear.reserve(textures.size());  // materials point into it
  for (const MipTexture& texture : textures) linear.emplace_back(texture);
  const auto first_material = static_cast<std::uint32_t>(materials_.size());
  for (const cad_import::Material& m : mesh.materials)
    materials_.push_back({float4(m.base_color), float4(m.emissive),
                          m.texture < 0 ? nullptr : &linear[std::size_t(m.texture)], m.wrap});
  Object& object = objects_.emplace_back();
  object.triangles.resize(mesh.triangles.size());
  const bool textured = mesh.texture_coordinates.size() == mesh.positions.size();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    ShadeTriangle& packed = object.triangles[i];
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[i][k];
      packed.normal[k] = mesh.normals[vertex];
      packed.st[k] = textured ? mesh.texture_coordinates[vertex] : glm::vec2(0);
    }
    packed.material = first_material + mesh.triangle_material[i];
  }
}

void ShadingScene::pack_optic(std::size_t index) {
  const optics::Optic& optic = scene_.optics[index];
  Object& object = objects_[scene_.surroundings.size() + index];
  object.optic = true;
  object.flip = optic.flip;
  object.two_sided = optic.two_sided;
  object.triangles.resize(optic.mesh.triangles.size());
  for (std::size_t i = 0; i < object.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      ShadeTriangle& packed = object.triangles[i];
      packed.normal[k] = glm::vec3(optic.mesh.vertices[optic.mesh.triangles[i].vertices[k]].normal);
      packed.st[k] = glm::vec2(0);
      packed.material = optic_material_[index];
    }
}

void ShadingScene::optic_changed(std::size_t index) {
  pack_optic(index);
}

/// Interpolates the corners' normals and texture coordinates; turns the normal to the side of the viewer.
void ShadingScene::gather(const ShadeLanes& lanes, Gathered& g) const {
  for (int i = 0; i < ShadeLanes::kLanes; ++i) {
    g.material[i] = nullptr;
    g.texture.texture[i] = nullptr;
    g.texture.s[i] = g.texture.t[i] = g.texels[i] = 0;
    g.texture.wrap[i] = cad_import::TextureWrap::repeat;
    g.nx[i] = g.ny[i] = 0;
    g.nz[i] = 1;
    if (!lanes.active[i] || lanes.object[i] == optics::kNoHit) continue;
    const Object& object = objects_[lanes.object[i]];
    const ShadeTriangle& tri = object.triangles[lanes.triangle[i]];
    const bool from_behind = lanes.normal_x[i] * lanes.direction_x[i] +
                                 lanes.normal_y[i] * lanes.direction_y[i] +
                                 lanes.normal_z[i] * lanes.direction_z[i] >
                             0;
    const float side = from_behind ? -1.0f : 1.0f, v = side * lanes.v[i], u = side * lanes.u[i],
                w = side - u - v;
    g.nx[i] = w * tri.normal[0].x + u * tri.normal[1].x + v * tri.normal[2].x;
    g.ny[i] = w * tri.normal[0].y + u * tri.normal[1].y + v * tri.normal[2].y;
    g.nz[i] = w * tri.normal[0].z + u * tri.normal[1].z + v * tri.normal[2].z;
    const bool back = object.optic && !object.two_sided && from_behind != object.flip;
    const ShadeMaterial& material = materials_[tri.material + (lanes.own_color[i] ? 2u : back ? 1u : 0u)];
    g.material[i] = &material;
    if (!material.texture) continue;
    const glm::vec2 e1 = tri.st[1] - tri.st[0], e2 = tri.st[2] - tri.st[0];
    g.texture.texture[i] = material.texture;
    g.texture.wrap[i] = material.wrap;
    g.texture.s[i] = tri.st[0].x + lanes.u[i] * e1.x + lanes.v[i] * e2.x;
    g.texture.t[i] = tri.st[0].y + lanes.u[i] * e1.y + lanes.v[i] * e2.y;
    g.texels[i] = std::abs(e1.x * e2.y - e1.y * e2.x) * material.texture->texel_count();
  }
}

/// Irradiance: ambient plus each light's share by Lambert's cosine law.
void ShadingScene::add_lights(const ShadeLanes& lanes, Gathered& g) const {
  constexpr int n = ShadeLanes::kLanes;
  for (int i = 0; i < n; ++i) {
    const float squared = g.nx[i] * g.nx[i] + g.ny[i] * g.ny[i] + g.nz[i] * g.nz[i];
    const float scale = squared > 0 ? 1 / std::sqrt(squared) : 0.0f;
    g.nx[i] *= scale;
    g.ny[i] *= scale;
    g.nz[i] *= scale;
    g.red[i] = g.green[i] = g.blue[i] = scene_.environment.ambient;
  }
  for (const Light& light : scene_.lights) {
    const glm::vec3 power = light.color * light.intensity;
    if (light.kind == LightKind::directional) {
      const glm::vec3 l = -glm::vec3(light.direction);
      for (int i = 0; i < n; ++i) {
        const float cosine = std::max(0.0f, g.nx[i] * l.x + g.ny[i] * l.y + g.nz[i] * l.z);
        g.red[i] += power.r * cosine;
        g.green[i] += power.g * cosine;
        g.blue[i] += power.b * cosine;
      }
      continue;
    }
    const glm::vec3 p(light.position_mm);
    for (int i = 0; i < n; ++i) {
      const float x = p.x - lanes.position_x[i], y = p.y - lanes.position_y[i], z = p.z - lanes.position_z[i];
      const float squared = std::max(1e-6f, x * x + y * y + z * z);
      const float cosine = std::max(0.0f, (g.nx[i] * x + g.ny[i] * y + g.nz[i] * z) / std::sqrt(squared));
      const float share = cosine * (1e6f / squared);  // intensity is the irradiance at 1 m
      g.red[i] += power.r * share;
      g.green[i] += power.g * share;
      g.blue[i] += power.b * share;
    }
  }
}

/// Level of detail from the texels under the pixel: area on the surface x texels per area (both of the
/// triangle's areas, in space and in the texture, are doubled).
void ShadingScene::set_detail(const ShadeLanes& lanes, Gathered& g) {
  for (int i = 0; i < ShadeLanes::kLanes; ++i) {
    const float facing =
        std::abs(lanes.normal_x[i] * lanes.direction_x[i] + lanes.normal_y[i] * lanes.direction_y[i] +
                 lanes.normal_z[i] * lanes.direction_z[i]);
    g.texture.lod[i] = 0.5f * fast_log2(lanes.footprint[i] * g.texels[i] / std::max(facing, 1e-30f));
  }
}

void ShadingScene::show_sky(const Gathered& g, ShadeLanes& lanes) const {
  const Float4 plain = float4(scene_.environment.color);
  for (int i = 0; i < ShadeLanes::kLanes; ++i) {
    if (g.material[i]) continue;
    const glm::vec3 direction(lanes.direction_x[i], lanes.direction_y[i], lanes.direction_z[i]);
    const bool pictured = textures_.sky.width > 0 && lanes.active[i];
    lanes.radiance[i] = pictured ? float4(sky_radiance(textures_.sky, scene_.environment, direction)) : plain;
  }
}

void ShadingScene::shade(ShadeLanes& lanes) const {
  Gathered g;
  gather(lanes, g);
  add_lights(lanes, g);
  set_detail(lanes, g);
  sample_textures(g.texture);
  bool any_sky = false;
  for (int i = 0; i < ShadeLanes::kLanes; ++i) {
    const ShadeMaterial* m = g.material[i];
    any_sky = any_sky || !m;
    if (!m) continue;
    const Float4 irradiance = {g.red[i], g.green[i], g.blue[i], 0};
    lanes.radiance[i] = m->emissive + m->base * g.texture.color[i] * irradiance;
  }
  if (any_sky) show_sky(g, lanes);
}

}  // namespace catoptra::render
