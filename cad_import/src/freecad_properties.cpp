#include "cad_import/src/freecad_properties.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/gtc/quaternion.hpp>

namespace catoptra::cad_import {
namespace {

/// Reads little-endian values one after the other.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  std::uint32_t word() {
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i)
      value = value << 8 | static_cast<unsigned char>(bytes_[at_ + std::size_t(i)]);
    at_ += 4;
    return value;
  }
  /// Of 4 or 8 bytes.
  double real(std::size_t size) {
    const std::uint64_t low = word();
    if (size == 4) return std::bit_cast<float>(static_cast<std::uint32_t>(low));
    return std::bit_cast<double>(static_cast<std::uint64_t>(word()) << 32 | low);
  }
  void skip(std::size_t count) { at_ += count; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

glm::dmat4 placement(const glm::dvec3& shift, const glm::dquat& turn) {
  glm::dmat4 m = glm::mat4_cast(glm::normalize(turn));
  m[3] = glm::dvec4(shift, 1);
  return m;
}

/// Bytes of one number in a list of `per_item` numbers an item; 0 where the list has another size.
std::size_t real_size(std::string_view bytes, std::size_t per_item) {
  if (bytes.size() < 4) return 0;
  const std::uint64_t count = ByteReader(bytes).word();
  for (const std::size_t size : {8, 4})
    if (bytes.size() - 4 == count * per_item * size) return size;
  return 0;
}

/// Skips the three texts (image, its path, identity) after a material; false where they do not fit.
bool skip_texts(ByteReader& in) {
  for (int i = 0; i < 3; ++i) {
    if (in.left() < 4) return false;
    const std::uint32_t length = in.word();
    if (in.left() < length) return false;
    in.skip(length);
  }
  return true;
}

}  // namespace

std::optional<double> number_attribute(const pugi::xml_node& node, const char* name) {
  const std::string_view text = node.attribute(name).value();
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::optional<glm::dmat4> placement_of(const pugi::xml_node& node) {
  constexpr std::array<const char*, 7> kNames{"Px", "Py", "Pz", "Q0", "Q1", "Q2", "Q3"};
  std::array<double, 7> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto number = number_attribute(node, kNames[i]);
    if (!number) return std::nullopt;
    v[i] = *number;
  }
  const glm::dquat turn(v[6], v[3], v[4], v[5]);
  if (!(glm::length(turn) > 1e-6))
    return std::nullopt;  // a unit quaternion as printed is within 1e-6 of length 1
  return placement({v[0], v[1], v[2]}, turn);
}

std::vector<std::string> linked_names(const pugi::xml_node& value) {
  std::vector<std::string> names;
  const auto add = [&](const pugi::xml_node& node, const char* attribute) {
    if (node.attribute("file").value()[0] != '\0') return;  // in another document
    if (const std::string name = node.attribute(attribute).value(); !name.empty()) names.push_back(name);
  };
  add(value, "value");
  add(value, "name");
  for (const pugi::xml_node& node : value.children()) {
    if (std::strcmp(node.name(), "Sub") == 0) continue;  // a face or edge of what is linked to
    add(node, "value");
    add(node, "obj");
    add(node, "name");
  }
  return names;
}

std::vector<bool> bool_list(std::string_view digits) {
  std::vector<bool> values;
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit) values.push_back(*digit != '0');
  return values;
}

std::vector<glm::dmat4> placement_list(std::string_view bytes) {
  std::vector<glm::dmat4> list;
  const std::size_t size = real_size(bytes, 7);
  if (size == 0) return list;
  ByteReader in(bytes);
  const std::uint32_t count = in.word();
  for (std::uint32_t i = 0; i < count; ++i) {
    std::array<double, 7> v{};
    for (double& number : v) number = in.real(size);
    const glm::dquat turn(v[6], v[3], v[4], v[5]);
    for (const double number : v)
      if (!std::isfinite(number)) return {};
    if (!(glm::length(turn) > 1e-6)) return {};
    list.push_back(placement({v[0], v[1], v[2]}, turn));
  }
  return list;
}

std::vector<glm::dvec3> vector_list(std::string_view bytes) {
  std::vector<glm::dvec3> list;
  const std::size_t size = real_size(bytes, 3);
  if (size == 0) return list;
  ByteReader in(bytes);
  const std::uint32_t count = in.word();
  for (std::uint32_t i = 0; i < count; ++i) {
    glm::dvec3 v;
    for (int axis = 0; axis < 3; ++axis) v[axis] = in.real(size);
    if (!std::isfinite(v.x + v.y + v.z)) return {};
    list.push_back(v);
  }
  return list;
}

glm::dvec3 packed_color(unsigned long value) {
  return {double(value >> 24 & 0xFF) / 255, double(value >> 16 & 0xFF) / 255,
          double(value >> 8 & 0xFF) / 255};
}

std::vector<glm::dvec3> color_list(std::string_view bytes) {
  std::vector<glm::dvec3> colors;
  if (real_size(bytes, 1) != 4) return colors;
  ByteReader in(bytes);
  const std::uint32_t count = in.word();
  for (std::uint32_t i = 0; i < count; ++i) colors.push_back(packed_color(in.word()));
  return colors;
}

std::vector<glm::dvec3> material_colors(std::string_view bytes) {
  // Ambient, diffuse, specular and emissive colour, shininess, transparency; from format 3 on three texts.
  constexpr std::size_t kMaterialBytes = 24;
  std::vector<glm::dvec3> colors;
  if (bytes.size() < 4) return colors;
  ByteReader in(bytes);
  const std::uint64_t count = in.word();
  const bool texts = in.left() != count * kMaterialBytes;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (in.left() < kMaterialBytes) return {};
    in.skip(4);
    colors.push_back(packed_color(in.word()));
    in.skip(kMaterialBytes - 8);
    if (texts && !skip_texts(in)) return {};
  }
  return colors;
}

}  // namespace catoptra::cad_import
