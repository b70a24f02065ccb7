#include "examples/street/glb.h"

#include <cstring>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace catoptra::examples {
namespace {

using nlohmann::json;

// Numbers that the glTF specification takes from OpenGL.
constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kLinear = 9729, kLinearMipmapLinear = 9987;
constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

glm::vec3 to_gltf_axes(const glm::vec3& v) {
  return {v.x, v.z, -v.y};
}

class GlbWriter {
 public:
  explicit GlbWriter(const Palette& palette) : palette_(palette) {
    document_["asset"] = {{"version", "2.0"}, {"generator", "catoptra make_street"}};
    document_["samplers"] = json::array({{{"magFilter", kLinear}, {"minFilter", kLinearMipmapLinear}}});
  }

  void add_primitive(const std::string& material_name, const Surface& surface) {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> coordinates;
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const Vertex& v : surface.vertices) {
      positions.push_back(to_gltf_axes(v.position));
      normals.push_back(to_gltf_axes(v.normal));
      coordinates.push_back(v.texture);
      low = glm::min(low, positions.back());
      high = glm::max(high, positions.back());
    }
    const int position =
        accessor(std::as_bytes(std::span(positions)), positions.size(), kFloat, "VEC3", kArrayBuffer);
    document_["accessors"][position]["min"] = {low.x, low.y, low.z};
    document_["accessors"][position]["max"] = {high.x, high.y, high.z};
    json primitive;
    primitive["attributes"] = {
        {"POSITION", position},
        {"NORMAL", accessor(std::as_bytes(std::span(normals)), normals.size(), kFloat, "VEC3", kArrayBuffer)},
        {"TEXCOORD_0",
         accessor(std::as_bytes(std::span(coordinates)), coordinates.size(), kFloat, "VEC2", kArrayBuffer)}};
    primitive["indices"] = accessor(std::as_bytes(std::span(surface.indices)), surface.indices.size(),
                                    kUnsignedInt, "SCALAR", kElementArrayBuffer);
    primitive["material"] = material(material_name);
    primitives_.push_back(primitive);
  }

  std::vector<std::byte> finish(std::string_view name) {
    document_["meshes"] = json::array({{{"name", name}, {"primitives", primitives_}}});
    document_["nodes"] = json::array({{{"name", name}, {"mesh", 0}}});
    document_["scenes"] = json::array({{{"nodes", {0}}}});
    document_["scene"] = 0;
    document_["buffers"] = json::array({{{"byteLength", binary_.size()}}});
    std::string text = document_.dump();
    while (text.size() % 4 != 0) text.push_back(' ');  // chunks are padded to four bytes, JSON with blanks

    std::vector<std::byte> file;
    const auto word = [&](std::size_t value) {
      const auto little_endian = static_cast<std::uint32_t>(value);
      for (unsigned shift = 0; shift < 32; shift += 8)
        file.push_back(std::byte((little_endian >> shift) & 0xFFu));
    };
    for (const std::size_t value :
         {std::size_t{kMagic}, std::size_t{kVersion}, 12 + 8 + text.size() + 8 + binary_.size(), text.size(),
          std::size_t{kJsonChunk}})
      word(value);
    for (const char c : text) file.push_back(std::byte(c));
    word(binary_.size());
    word(kBinaryChunk);
    file.insert(file.end(), binary_.begin(), binary_.end());
    return file;
  }

 private:
  int view(std::span<const std::byte> bytes, int target) {
    json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    binary_.insert(binary_.end(), bytes.begin(), bytes.end());
    while (binary_.size() % 4 != 0) binary_.push_back(std::byte{0});
    return append("bufferViews", view);
  }

  int accessor(std::span<const std::byte> bytes, std::size_t count, int component, const char* type,
               int target) {
    return append("accessors", {{"bufferView", view(bytes, target)},
                                {"componentType", component},
                                {"count", count},
                                {"type", type}});
  }

  int material(const std::string& name) {
    const Paint& paint = palette_.paints.at(name);
    json pbr = {{"baseColorFactor", {paint.color.r, paint.color.g, paint.color.b, 1}},
                {"metallicFactor", 0},
                {"roughnessFactor", 1}};
    if (!paint.texture.empty()) pbr["baseColorTexture"] = {{"index", texture(paint.texture)}};
    json material = {{"name", name}, {"pbrMetallicRoughness", pbr}, {"doubleSided", paint.alpha_cutoff > 0}};
    if (paint.alpha_cutoff > 0) material.update({{"alphaMode", "MASK"}, {"alphaCutoff", paint.alpha_cutoff}});
    return append("materials", material);
  }

  int texture(const std::string& name) {
    if (const auto known = textures_.find(name); known != textures_.end()) return known->second;
    const auto png = palette_.textures.at(name).png();
    const int image =
        append("images", {{"name", name}, {"mimeType", "image/png"}, {"bufferView", view(png, 0)}});
    return textures_[name] = append("textures", {{"sampler", 0}, {"source", image}});
  }

  int append(const char* list, const json& entry) {
    document_[list].push_back(entry);
    return static_cast<int>(document_[list].size()) - 1;
  }

  const Palette& palette_;
  json document_, primitives_ = json::array();
  std::vector<std::byte> binary_;
  std::map<std::string, int> textures_;
};

}  // namespace

std::vector<std::byte> write_glb(const Model& model, const Palette& palette, std::string_view name) {
  GlbWriter writer(palette);
  for (const auto& [material, surface] : model.surfaces) writer.add_primitive(material, surface);
  return writer.finish(name);
}

}  // namespace catoptra::examples
