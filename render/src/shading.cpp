#include "render/src/shading.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
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
  LitLanes lit;
  /// Texels per unit of area on the surface, times twice the triangle's area.
  float texels[ShadeLanes::kLanes];
  TextureLanes texture;
};

ShadingScene::ShadingScene(const Scene& scene, const SceneTextures& textures, const optics::RayScene& rays)
    : scene_(scene), textures_(textures), lighting_(scene, rays) {
  linear_.reserve(scene.surroundings.size());
  for (std::size_t m = 0; m < scene.surroundings.size(); ++m)
    add_surroundings(scene.surroundings[m], textures.textures[m]);
  for (std::size_t i = 0; i < scene.optics.size(); ++i) {
    optic_material_.push_back(static_cast<std::uint32_t>(materials_.size()));
    materials_.push_back({float4(scene.optics[i].reflectance), Float4{}});
    materials_.push_back({float4(glm::vec3(kOpticBackAlbedo)), Float4{}});
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
  lighting_.optic_changed(scene_);
}

/// Interpolates the corners' normals and texture coordinates; turns the normal to the side of the viewer.
void ShadingScene::gather(const ShadeLanes& lanes, Gathered& g) const {
  for (int i = 0; i < ShadeLanes::kLanes; ++i) {
    g.material[i] = nullptr;
    g.texture.texture[i] = nullptr;
    g.texture.s[i] = g.texture.t[i] = g.texels[i] = 0;
    g.texture.wrap[i] = cad_import::TextureWrap::repeat;
    g.lit.nx[i] = g.lit.ny[i] = 0;
    g.lit.nz[i] = 1;
    if (!lanes.active[i] || lanes.object[i] == optics::kNoHit) continue;
    const Object& object = objects_[lanes.object[i]];
    const ShadeTriangle& tri = object.triangles[lanes.triangle[i]];
    const bool from_behind = lanes.normal_x[i] * lanes.direction_x[i] +
                                 lanes.normal_y[i] * lanes.direction_y[i] +
                                 lanes.normal_z[i] * lanes.direction_z[i] >
                             0;
    const float side = from_behind ? -1.0f : 1.0f, v = side * lanes.v[i], u = side * lanes.u[i],
                w = side - u - v;
    g.lit.nx[i] = w * tri.normal[0].x + u * tri.normal[1].x + v * tri.normal[2].x;
    g.lit.ny[i] = w * tri.normal[0].y + u * tri.normal[1].y + v * tri.normal[2].y;
    g.lit.nz[i] = w * tri.normal[0].z + u * tri.normal[1].z + v * tri.normal[2].z;
    const bool back = object.optic && from_behind != object.flip;
    const ShadeMaterial& material = materials_[tri.material + (back ? 1u : 0u)];
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

/// Where shadow rays start: on the flat triangles, by weights, which no length of the eye's ray blurs.
void ShadingScene::set_starts(const ShadeLanes& lanes, LitLanes& lit) const {
  for (int i = 0; i < ShadeLanes::kLanes; ++i) {
    if (!lit.lit[i]) continue;
    glm::dvec3 corner[3];
    corners(lanes.object[i], lanes.triangle[i], corner);
    const double u = lanes.u[i], v = lanes.v[i];
    lit.start[i] = (1 - u - v) * corner[0] + u * corner[1] + v * corner[2];
    const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double length = glm::length(normal);
    lit.flat_normal[i] = length > 0 ? normal / length : glm::dvec3(0);
    double largest = 0;
    for (const glm::dvec3& c : corner)
      largest = std::max({largest, std::abs(c.x), std::abs(c.y), std::abs(c.z)});
    lit.margin[i] = shadow_margin_mm(largest);
  }
}

void ShadingScene::corners(std::uint32_t object, std::uint32_t triangle, glm::dvec3 (&corner)[3]) const {
  if (object < scene_.surroundings.size()) {
    const cad_import::TriangleMesh& mesh = scene_.surroundings[object];
    for (int k = 0; k < 3; ++k) corner[k] = glm::dvec3(mesh.positions[mesh.triangles[triangle][k]]);
    return;
  }
  const tessellate::OpticArrays& mesh = scene_.optics[object - scene_.surroundings.size()].mesh;
  for (std::size_t k = 0; k < 3; ++k)
    corner[k] = mesh.vertices[mesh.triangles[triangle].vertices[k]].position_mm;
}

/// Irradiance: ambient plus what of each light is seen.
void ShadingScene::add_lights(const ShadeLanes& lanes, Gathered& g) const {
  LitLanes& lit = g.lit;
  for (int i = 0; i < ShadeLanes::kLanes; ++i) {
    const float squared = lit.nx[i] * lit.nx[i] + lit.ny[i] * lit.ny[i] + lit.nz[i] * lit.nz[i];
    const float scale = squared > 0 ? 1 / std::sqrt(squared) : 0.0f;
    lit.nx[i] *= scale;
    lit.ny[i] *= scale;
    lit.nz[i] *= scale;
    lit.x[i] = lanes.position_x[i];
    lit.y[i] = lanes.position_y[i];
    lit.z[i] = lanes.position_z[i];
    lit.lit[i] = g.material[i] != nullptr;
    lit.red[i] = lit.green[i] = lit.blue[i] = scene_.environment.ambient;
  }
  if (lighting_.any_shadows()) set_starts(lanes, lit);
  lighting_.add(lit);
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
    const Float4 irradiance = {g.lit.red[i], g.lit.green[i], g.lit.blue[i], 0};
    lanes.radiance[i] = m->emissive + m->base * g.texture.color[i] * irradiance;
  }
  if (any_sky) show_sky(g, lanes);
}

}  // namespace catoptra::render
