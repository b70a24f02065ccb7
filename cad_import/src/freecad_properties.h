// Values as FreeCAD writes them, in XML and in the binary entries of long lists.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace catoptra::cad_import {

/// The value of an attribute; nullopt where it is missing, no number, infinite or undefined.
[[nodiscard]] std::optional<double> number_attribute(const pugi::xml_node& node, const char* name);

/// <PropertyPlacement Px= Q0= .../>: a rotation by the quaternion (Q0, Q1, Q2; Q3) and a shift, mm. Nullopt
/// where a number is missing or the quaternion is zero.
[[nodiscard]] std::optional<glm::dmat4> placement_of(const pugi::xml_node& node);

/// Names in <LinkList>, <Link>, <LinkSub>, <LinkSubList> and <XLink> of the same document.
[[nodiscard]] std::vector<std::string> linked_names(const pugi::xml_node& value);

/// <BoolList value="110"/>: the last digit is the first value.
[[nodiscard]] std::vector<bool> bool_list(std::string_view digits);

/// Binary lists: a count, then numbers, little-endian, in double or single precision as the size tells. Empty
/// where the size fits neither.
[[nodiscard]] std::vector<glm::dmat4> placement_list(std::string_view bytes);
[[nodiscard]] std::vector<glm::dvec3> vector_list(std::string_view bytes);

/// 0xRRGGBBAA as three shares of 1 (sRGB).
[[nodiscard]] glm::dvec3 packed_color(unsigned long value);
/// Of a ColorList entry (App::PropertyColorList).
[[nodiscard]] std::vector<glm::dvec3> color_list(std::string_view bytes);
/// The diffuse colours of a MaterialList entry (App::PropertyMaterialList), with or without texture names.
[[nodiscard]] std::vector<glm::dvec3> material_colors(std::string_view bytes);

}  // namespace catoptra::cad_import
