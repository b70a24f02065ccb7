// What the XML of a FreeCAD document says: its objects, how they hold one another, and how they are shown.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "cad_import/src/freecad_archive.h"

namespace catoptra::cad_import {

/// The part of an object that App::Link and its kin (arrays, elements, groups of links) have.
struct FreecadLink {
  bool group = false;                  ///< App::LinkGroup: shows its elements and links to nothing itself
  std::string target;                  ///< name of the object linked to
  std::string target_file;             ///< not empty: the object is in that other document
  std::vector<std::string> path;       ///< from the target on to what is shown: names, or "$" and a label
  bool face_only = false;              ///< links to a face, edge or vertex of the target
  bool with_target_placement = false;  ///< else the link's placement stands in place of the target's
  glm::dvec3 scale{1};
  int count = 0;  ///< > 0: an array of so many, at `placements`
  std::vector<glm::dmat4> placements;
  std::vector<glm::dvec3> scales;
  std::vector<std::string> elements;  ///< objects shown in place of the target
  std::vector<bool> elements_shown;   ///< by index in `elements`; what is missing is shown
};

/// One object of Document.xml with what GuiDocument.xml says of it.
struct FreecadObject {
  std::string name;   ///< unique in the document
  std::string type;   ///< "Part::Box", "App::Part", ...
  std::string label;  ///< what the user called it
  std::optional<bool> visible;
  std::optional<glm::dmat4> placement;  ///< within its container
  std::string shape_entry;              ///< entry with the BREP, empty where it has no shape
  std::optional<std::vector<std::string>> group;
  bool own_axes = false;  ///< its group moves with it: App::Part, PartDesign::Body, assemblies
  std::string tip;        ///< of a PartDesign::Body
  std::optional<FreecadLink> link;
  std::vector<std::string> made_from;  ///< objects that this one's shape was made of
  // What follows is sRGB, 0..1, as FreeCAD shows it.
  std::optional<glm::dvec3> color;
  std::vector<glm::dvec3> face_colors;   ///< by face, where the faces differ
  std::optional<glm::dvec3> link_color;  ///< of a link that covers its target's colour

  [[nodiscard]] const std::string& label_or_name() const;
};

struct FreecadDocument {
  std::vector<FreecadObject> objects;                     ///< in the document's order
  std::unordered_map<std::string, std::size_t> index_of;  ///< by name
  bool has_gui = false;  ///< a GuiDocument.xml was there: `visible` is what the user saw
};

/// Throws ImportError, with the entry's name, for XML that is missing or broken.
[[nodiscard]] FreecadDocument read_freecad_document(FreecadArchive& archive);

}  // namespace catoptra::cad_import
