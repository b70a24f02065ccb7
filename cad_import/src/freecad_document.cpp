#include "cad_import/src/freecad_document.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>
#include <string_view>

#include "cad_import/error.h"
#include "cad_import/src/freecad_gui.h"
#include "cad_import/src/freecad_properties.h"

namespace catoptra::cad_import {
namespace {

/// Links that hold an object or hang on to it, rather than make a shape of it.
constexpr std::array<std::string_view, 8> kHolding{
    "Group", "Model", "Origin", "Tip", "LinkedObject", "ElementList", "Support", "AttachmentSupport"};

bool starts_with(std::string_view text, std::string_view begin) {
  return text.substr(0, begin.size()) == begin;
}

bool is_true(const pugi::xml_node& value) {
  return std::string_view(value.attribute("value").value()) == "true";
}

int integer(const pugi::xml_node& value) {
  return std::clamp(value.attribute("value").as_int(0), 0, 1'000'000'000);
}

/// The parts of "Part.Body.Face3": objects to go through, and whether a face, edge or vertex ends it.
void read_path(std::string_view text, FreecadLink& link) {
  link.path.clear();
  for (std::size_t dot = text.find('.'); dot != std::string_view::npos; dot = text.find('.')) {
    if (dot > 0) link.path.emplace_back(text.substr(0, dot));
    text.remove_prefix(dot + 1);
  }
  if (!text.empty()) link.face_only = true;
}

void read_target(const pugi::xml_node& value, FreecadLink& link) {
  link.target_file = value.attribute("file").value();
  link.target = value.attribute(value.attribute("name") ? "name" : "value").value();
  std::string sub = value.attribute("sub").value();
  for (const pugi::xml_node& child : value.children("Sub"))
    if (sub.empty()) sub = child.attribute("value").value();
  if (!sub.empty()) read_path(sub, link);
}

/// Reads the properties of one object.
class ObjectReader {
 public:
  ObjectReader(FreecadArchive& archive, FreecadObject& object) : archive_(archive), object_(object) {}

  void read(const pugi::xml_node& properties) {
    bool links = false, elements = false;
    for (const pugi::xml_node& property : properties.children("Property")) {
      const std::string_view name = property.attribute("name").value();
      links = links || name == "LinkedObject";
      elements = elements || name == "ElementList";
    }
    if (links || elements) object_.link.emplace().group = !links;
    for (const pugi::xml_node& property : properties.children("Property")) {
      const std::string_view name = property.attribute("name").value();
      const std::string_view type = property.attribute("type").value();
      const pugi::xml_node value = first_element(property);
      read_common(name, type, value);
      if (object_.link) read_link(name, value);
    }
  }

 private:
  static pugi::xml_node first_element(const pugi::xml_node& node) {
    pugi::xml_node child = node.first_child();
    while (child && child.type() != pugi::node_element) child = child.next_sibling();
    return child;
  }

  [[noreturn]] void fail(std::string_view property) const {
    throw ImportError(
        archive_.file(), "Document.xml",
        "the " + std::string(property) + " of \"" + object_.label_or_name() + "\" is not made of numbers",
        "open it in FreeCAD and save it again");
  }

  void read_common(std::string_view name, std::string_view type, const pugi::xml_node& value) {
    if (name == "Label") object_.label = value.attribute("value").value();
    if (name == "Visibility") object_.visible = is_true(value);
    // A link has its place in one property or in both alike.
    if ((name == "Placement" || name == "LinkPlacement") && type == "App::PropertyPlacement") {
      if (object_.placement && name == "Placement") return;
      object_.placement = placement_of(value);
      if (!object_.placement) fail(name);
    }
    if (name == "Shape" && type == "Part::PropertyPartShape")
      object_.shape_entry = value.attribute("file").value();
    if (name == "Group" || name == "Model") object_.group = linked_names(value);
    if (name == "Origin" && starts_with(type, "App::PropertyLink")) object_.own_axes = true;
    if (name == "Tip" && !linked_names(value).empty()) object_.tip = linked_names(value).front();
    if ((starts_with(type, "App::PropertyLink") || starts_with(type, "App::PropertyXLink")) &&
        std::ranges::find(kHolding, name) == kHolding.end())
      for (std::string& other : linked_names(value)) object_.made_from.push_back(std::move(other));
  }

  void read_link(std::string_view name, const pugi::xml_node& value) {
    FreecadLink& link = *object_.link;
    if (name == "LinkedObject") read_target(value, link);
    if (name == "LinkTransform") link.with_target_placement = is_true(value);
    if (name == "ElementCount") link.count = integer(value);
    if (name == "ElementList") link.elements = linked_names(value);
    if (name == "VisibilityList") link.elements_shown = bool_list(value.attribute("value").value());
    if (name == "PlacementList") link.placements = placement_list(entry(value));
    if (name == "ScaleList") link.scales = vector_list(entry(value));
    if (name == "Scale" && !has_scale_vector_)
      if (const auto scale = number_attribute(value, "value")) link.scale = glm::dvec3(*scale);
    if (name == "ScaleVector") {
      const auto x = number_attribute(value, "valueX"), y = number_attribute(value, "valueY"),
                 z = number_attribute(value, "valueZ");
      if (!x || !y || !z) fail(name);
      link.scale = {*x, *y, *z};
      has_scale_vector_ = true;
    }
  }

  std::string entry(const pugi::xml_node& value) {
    const std::string name = value.attribute("file").value();
    if (name.empty()) return {};
    return archive_.read(name, FreecadArchive::kMostListBytes).value_or("");
  }

  FreecadArchive& archive_;
  FreecadObject& object_;
  bool has_scale_vector_ = false;
};

void read_objects(FreecadArchive& archive, const pugi::xml_node& root, FreecadDocument& document) {
  for (const pugi::xml_node& node : root.child("Objects").children("Object")) {
    FreecadObject object;
    object.name = node.attribute("name").value();
    object.type = node.attribute("type").value();
    if (object.name.empty()) continue;
    if (document.index_of.try_emplace(object.name, document.objects.size()).second)
      document.objects.push_back(std::move(object));
  }
  for (const pugi::xml_node& node : root.child("ObjectData").children("Object")) {
    const auto found = document.index_of.find(node.attribute("name").value());
    if (found == document.index_of.end()) continue;
    FreecadObject& object = document.objects[found->second];
    ObjectReader(archive, object).read(node.child("Properties"));
  }
}

}  // namespace

const std::string& FreecadObject::label_or_name() const {
  return label.empty() ? name : label;
}

void parse_freecad_xml(const std::string& file, const std::string& entry, std::string& text,
                       pugi::xml_document& xml) {
  const pugi::xml_parse_result result = xml.load_buffer_inplace(text.data(), text.size());
  if (result && xml.child("Document")) return;
  if (result)
    throw ImportError(file, entry, "has no element Document", "open it in FreeCAD and save it again");
  throw ImportError(file, entry,
                    "is broken XML at byte " + std::to_string(result.offset) + ": " + result.description(),
                    "open it in FreeCAD and save it again");
}

FreecadDocument read_freecad_document(FreecadArchive& archive) {
  auto text = archive.read("Document.xml", FreecadArchive::kMostXmlBytes);
  if (!text)
    throw ImportError(archive.file(), "Document.xml", "is missing: not a FreeCAD document",
                      "give a .FCStd file that FreeCAD saved");
  pugi::xml_document xml;
  parse_freecad_xml(archive.file(), "Document.xml", *text, xml);
  FreecadDocument document;
  read_objects(archive, xml.child("Document"), document);
  read_freecad_gui(archive, document);
  return document;
}

}  // namespace catoptra::cad_import
