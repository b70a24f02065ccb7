#include "cad_import/src/freecad_gui.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "cad_import/error.h"
#include "cad_import/src/freecad_properties.h"

namespace catoptra::cad_import {
namespace {

/// The view properties of one object. FreeCAD up to 0.21 keeps one ShapeColor and a list DiffuseColor by
/// face; from 1.0 on a list ShapeAppearance is both.
class ViewReader {
 public:
  ViewReader(FreecadArchive& archive, FreecadObject& object) : archive_(archive), object_(object) {}

  void read(const pugi::xml_node& properties) {
    for (const pugi::xml_node& property : properties.children("Property")) {
      const std::string_view name = property.attribute("name").value();
      const pugi::xml_node value =
          property.find_child([](const pugi::xml_node& n) { return n.name()[0] != '\0'; });
      if (name == "Visibility")
        object_.visible = std::string_view(value.attribute("value").value()) == "true";
      if (name == "ShapeColor") object_.color = color(value, "value");
      if (name == "DiffuseColor") take(color_list(entry(value)));
      if (name == "ShapeAppearance") take(material_colors(entry(value)));
      if (name == "ShapeMaterial") material_ = color(value, "diffuseColor");
      if (name == "OverrideMaterial") covers_ = std::string_view(value.attribute("value").value()) == "true";
    }
    if (covers_ && object_.link) object_.link_color = material_;
  }

 private:
  static std::optional<glm::dvec3> color(const pugi::xml_node& value, const char* attribute) {
    if (!value.attribute(attribute)) return std::nullopt;
    return packed_color(value.attribute(attribute).as_ullong());
  }

  std::string entry(const pugi::xml_node& value) {
    const std::string name = value.attribute("file").value();
    if (name.empty()) return {};
    return archive_.read(name, FreecadArchive::kMostListBytes).value_or("");
  }

  void take(std::vector<glm::dvec3> colors) {
    if (colors.empty()) return;
    object_.color = colors.front();
    if (std::ranges::any_of(colors, [&](const glm::dvec3& c) { return c != colors.front(); }))
      object_.face_colors = std::move(colors);
  }

  FreecadArchive& archive_;
  FreecadObject& object_;
  std::optional<glm::dvec3> material_;
  bool covers_ = false;
};

}  // namespace

void read_freecad_gui(FreecadArchive& archive, FreecadDocument& document) {
  auto text = archive.read("GuiDocument.xml", FreecadArchive::kMostXmlBytes);
  if (!text) return;
  document.has_gui = true;
  pugi::xml_document xml;
  parse_freecad_xml(archive.file(), "GuiDocument.xml", *text, xml);
  for (const pugi::xml_node& node :
       xml.child("Document").child("ViewProviderData").children("ViewProvider")) {
    const auto found = document.index_of.find(node.attribute("name").value());
    if (found != document.index_of.end())
      ViewReader(archive, document.objects[found->second]).read(node.child("Properties"));
  }
}

}  // namespace catoptra::cad_import
