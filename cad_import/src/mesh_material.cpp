// Materials and textures of a mesh file.
#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <system_error>

#include "cad_import/src/mesh_parts.h"

namespace catoptra::cad_import {
namespace {

/// Where alpha is a blend weight, docs/decisions/0001 cuts at the half.
constexpr float kBlendCutoff = 0.5f;

/// IEC 61966-2-1, 5.2.
float linear_from_srgb(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

glm::vec3 color_of(const aiColor4D& c) {
  const auto channel = [](float v) { return std::isfinite(v) ? std::max(v, 0.0f) : 0.0f; };
  return {channel(c.r), channel(c.g), channel(c.b)};
}

/// A reference as MTL and glTF files have it: backslashes, "%20".
std::string plain_path(std::string_view reference) {
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string path;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const bool escaped = reference[i] == '%' && i + 2 < reference.size() && digit(reference[i + 1]) >= 0 &&
                         digit(reference[i + 2]) >= 0;
    if (escaped) {
      path += static_cast<char>(16 * digit(reference[i + 1]) + digit(reference[i + 2]));
      i += 2;
    } else {
      path += reference[i] == '\\' ? '/' : reference[i];
    }
  }
  return path;
}

TextureWrap wrap_of(int mode) {
  switch (mode) {
    case aiTextureMapMode_Clamp:
    case aiTextureMapMode_Decal:
      return TextureWrap::clamp;
    case aiTextureMapMode_Mirror:
      return TextureWrap::mirror;
    default:
      return TextureWrap::repeat;
  }
}

/// KHR_texture_transform's own numbers, from what assimp 5.2 made of them: it negates the rotation and moves
/// the offset to a transform about the image's centre with t up (glTF2Importer.cpp,
/// SetMaterialTextureProperty).
TextureTransform khr_transform(const aiUVTransform& t) {
  TextureTransform result;
  result.scale = {t.mScaling.x, t.mScaling.y};
  result.rotation_rad = -t.mRotation;
  const float c = std::cos(result.rotation_rad), s = std::sin(result.rotation_rad);
  result.offset.x = t.mTranslation.x - 0.5f * t.mScaling.x * (-c + s + 1);
  result.offset.y = 0.5f * t.mScaling.y * (s + c - 1) + 1 - t.mScaling.y - t.mTranslation.y;
  return result;
}

class MaterialReader {
 public:
  MaterialReader(const aiScene& scene, const std::filesystem::path& file, FileFormat format, glm::vec3 color)
      : scene_(scene), file_(file), format_(format), color_(color) {}

  MaterialSet run() {
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i) add(*scene_.mMaterials[i], i);
    if (result_.materials.empty()) {
      result_.materials.push_back({});
      result_.materials.back().base_color = color_;
      result_.uses.push_back({});
    }
    return std::move(result_);
  }

 private:
  void add(const aiMaterial& source, unsigned index) {
    Material material;
    aiString name;
    if (source.Get(AI_MATKEY_NAME, name) == AI_SUCCESS) material.name = name.C_Str();
    TextureUse use;
    if (is_stand_in(material.name, index)) {
      material.base_color = color_;
    } else {
      read_colors(source, material);
      read_texture(source, material, use);
      read_alpha(source, material);
    }
    result_.materials.push_back(std::move(material));
    result_.uses.push_back(use);
  }

  /// assimp adds a material for what has none: the last of a glTF file, a named one elsewhere.
  bool is_stand_in(const std::string& name, unsigned index) const {
    if (format_ == FileFormat::gltf) return index + 1 == scene_.mNumMaterials && name.empty();
    return name == AI_DEFAULT_MATERIAL_NAME;
  }

  /// glTF colours are linear; MTL and PLY ones are meant for a display, so sRGB.
  void read_colors(const aiMaterial& source, Material& material) const {
    const auto linear = [this](glm::vec3 c) {
      if (format_ == FileFormat::gltf) return c;
      return glm::vec3(linear_from_srgb(c.x), linear_from_srgb(c.y), linear_from_srgb(c.z));
    };
    aiColor4D color(1, 1, 1, 1);
    if (source.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS)
      material.base_color = linear(color_of(color));
    aiColor4D emissive(0, 0, 0, 1);
    if (source.Get(AI_MATKEY_COLOR_EMISSIVE, emissive) == AI_SUCCESS)
      material.emissive = linear(color_of(emissive));
    float strength = 1;
    if (source.Get(AI_MATKEY_EMISSIVE_INTENSITY, strength) == AI_SUCCESS && std::isfinite(strength))
      material.emissive *= std::max(strength, 0.0f);
  }

  void read_texture(const aiMaterial& source, Material& material, TextureUse& use) {
    aiString reference;
    if (source.Get(AI_MATKEY_TEXTURE(aiTextureType_DIFFUSE, 0), reference) == AI_SUCCESS &&
        reference.length > 0)
      material.texture = texture_index(reference.C_Str(), material.name);
    int channel = 0, wrap_u = aiTextureMapMode_Wrap, wrap_v = aiTextureMapMode_Wrap;
    source.Get(AI_MATKEY_UVWSRC(aiTextureType_DIFFUSE, 0), channel);
    if (channel >= 0 && channel < AI_MAX_NUMBER_OF_TEXTURECOORDS)
      use.channel = static_cast<unsigned>(channel);
    source.Get(AI_MATKEY_MAPPINGMODE_U(aiTextureType_DIFFUSE, 0), wrap_u);
    source.Get(AI_MATKEY_MAPPINGMODE_V(aiTextureType_DIFFUSE, 0), wrap_v);
    material.wrap = wrap_of(wrap_u);
    if (material.texture >= 0 && wrap_of(wrap_u) != wrap_of(wrap_v))
      result_.warnings.push_back("material \"" + material.name +
                                 "\": the texture wraps as in s in both directions");
    aiUVTransform transform;
    if (source.Get(AI_MATKEY_UVTRANSFORM(aiTextureType_DIFFUSE, 0), transform) == AI_SUCCESS &&
        format_ == FileFormat::gltf)
      use.transform = khr_transform(transform);
    aiString emission;
    if (source.Get(AI_MATKEY_TEXTURE(aiTextureType_EMISSIVE, 0), emission) == AI_SUCCESS &&
        emission.length > 0) {
      material.emissive = glm::vec3(0);  // the factor alone would make all of it glow
      result_.warnings.push_back("material \"" + material.name + "\": the emissive texture is not used");
    }
  }

  /// glTF says how alpha is meant; a dissolved MTL material is a blend.
  void read_alpha(const aiMaterial& source, Material& material) {
    float opacity = 1;
    source.Get(AI_MATKEY_OPACITY, opacity);
    material.alpha = std::isfinite(opacity) ? std::clamp(opacity, 0.0f, 1.0f) : 1.0f;
    if (format_ != FileFormat::gltf) {
      aiString mask, diffuse;
      const bool masked = source.Get(AI_MATKEY_TEXTURE(aiTextureType_OPACITY, 0), mask) == AI_SUCCESS;
      source.Get(AI_MATKEY_TEXTURE(aiTextureType_DIFFUSE, 0), diffuse);
      const bool same_image = masked && mask == diffuse;
      if (material.alpha < 1 || same_image) material.alpha_cutoff = kBlendCutoff;
      if (masked && !same_image)
        result_.warnings.push_back("material \"" + material.name + "\": the opacity texture is not used");
      return;
    }
    aiString mode;
    source.Get(AI_MATKEY_GLTF_ALPHAMODE, mode);
    const std::string_view name(mode.C_Str());
    if (name == "BLEND") material.alpha_cutoff = kBlendCutoff;
    if (name != "MASK") return;
    float cutoff = kBlendCutoff;
    source.Get(AI_MATKEY_GLTF_ALPHACUTOFF, cutoff);
    material.alpha_cutoff = std::isfinite(cutoff) ? cutoff : kBlendCutoff;
  }

  /// Index in the set's textures, made at first sight; -1 with a warning where there is no such image.
  int texture_index(const std::string& reference, const std::string& material) {
    if (const auto known = known_.find(reference); known != known_.end()) return known->second;
    Texture texture;
    bool found = false;
    if (const aiTexture* embedded = scene_.GetEmbeddedTexture(reference.c_str())) {
      found = embedded->mHeight == 0 && embedded->mWidth > 0 && embedded->pcData;
      texture.name = embedded->mFilename.length > 0 ? embedded->mFilename.C_Str() : reference;
      if (found) {
        const auto* bytes = reinterpret_cast<const std::byte*>(embedded->pcData);
        texture.encoded.assign(bytes, bytes + embedded->mWidth);
      }
    } else if (const auto path = find_beside(file_, reference)) {
      found = true;
      texture.name = reference;
      texture.path = path->string();
    }
    if (!found)
      result_.warnings.push_back("material \"" + material + "\": texture \"" + reference +
                                 "\" was not found");
    const int index = found ? static_cast<int>(result_.textures.size()) : -1;
    if (found) result_.textures.push_back(std::move(texture));
    known_.emplace(reference, index);
    return index;
  }

  const aiScene& scene_;
  const std::filesystem::path& file_;
  FileFormat format_;
  glm::vec3 color_;
  MaterialSet result_;
  std::map<std::string, int> known_;
};

}  // namespace

std::optional<std::filesystem::path> find_beside(const std::filesystem::path& mesh_file,
                                                 const std::string& reference) {
  const std::filesystem::path folder = mesh_file.parent_path(), plain = plain_path(reference);
  for (const std::filesystem::path& candidate :
       {folder / reference, folder / plain, folder / plain.filename()}) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(candidate, error)) continue;
    const std::filesystem::path absolute = std::filesystem::absolute(candidate, error);
    return error ? candidate : absolute.lexically_normal();
  }
  return std::nullopt;
}

MaterialSet read_materials(const aiScene& scene, const std::filesystem::path& file, FileFormat format,
                           glm::vec3 color) {
  return MaterialReader(scene, file, format, color).run();
}

}  // namespace catoptra::cad_import
