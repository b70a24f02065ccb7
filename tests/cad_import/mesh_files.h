// Small mesh files that the tests write for themselves.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace catoptra::cad_import {

/// The name that the tests of this folder know it by.
using ScratchFolder = test::TemporaryFolder;

/// "data:" URI of raw little-endian bytes (RFC 4648, 4).
inline std::string data_uri(std::span<const std::uint8_t> bytes,
                            const std::string& type = "application/octet-stream") {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text = "data:" + type + ";base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// A glTF file of one triangle (0,0,0) (1,0,0) (0,1,0) in metres with texture coordinates (0,0) (1,0) (0,1).
/// `node`: more keys of its node; `material`: the material's keys; `rest`: more top-level keys. Each empty or
/// ending in a comma.
inline std::string gltf_triangle(const std::string& node, const std::string& material,
                                 const std::string& rest = "") {
  const std::vector<float> numbers{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1};
  std::vector<std::uint8_t> bytes(numbers.size() * sizeof(float));
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{)" + node +
         R"("mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
         "materials": [{)" +
         material + R"("name": "paint"}], )" + rest +
         R"("accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
         "max": [1, 1, 0]}, {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
         "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36,
         "byteLength": 24}], "buffers": [{"byteLength": 60, "uri": ")" +
         data_uri(bytes) + R"("}]})";
}

}  // namespace catoptra::cad_import
