// Which shapes of a FreeCAD document are shown, and where.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cad_import/src/freecad_document.h"

namespace catoptra::cad_import {

/// A shape of the document at one place. Links show one shape at several.
struct FreecadShown {
  std::size_t object = 0;  ///< whose shape it is: index in FreecadDocument::objects
  std::string label;       ///< of the object, or of the link that shows it
  /// Where the shape goes once its own placement is taken away; nullopt: leave it where the shape itself
  /// says.
  std::optional<glm::dmat4> place;
  std::optional<glm::dvec3> color;  ///< of a link that covers the object's (sRGB)
};

struct FreecadScene {
  std::vector<FreecadShown> shapes;   ///< in the document's order
  std::vector<std::string> warnings;  ///< meshes, links into other documents
};

/// What FreeCAD's 3D view shows: visible objects, placed by their containers and links; of a PartDesign::Body
/// its result. Where no shape is visible, and in documents made without the user interface, an object that
/// another one was made from counts as hidden and every other one as shown. Throws ImportError for objects
/// that hold themselves, for more than 100,000 shapes, and for links to objects that are not there.
[[nodiscard]] FreecadScene freecad_scene(const FreecadDocument& document, const std::string& file);

}  // namespace catoptra::cad_import
