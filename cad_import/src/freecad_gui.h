// What a FreeCAD document says about how its objects are shown.
#pragma once

#include <pugixml.hpp>
#include <string>

#include "cad_import/src/freecad_document.h"

namespace catoptra::cad_import {

/// Fills in visibility and colours from GuiDocument.xml, where there is one (documents made without the user
/// interface have none). Throws ImportError where it is damaged.
void read_freecad_gui(FreecadArchive& archive, FreecadDocument& document);

/// Parses `text`, which the result points into, and makes sure of the root. Throws ImportError naming
/// `entry`.
void parse_freecad_xml(const std::string& file, const std::string& entry, std::string& text,
                       pugi::xml_document& xml);

}  // namespace catoptra::cad_import
