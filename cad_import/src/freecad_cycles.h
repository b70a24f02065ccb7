// Looks for objects of a FreeCAD document that hold or show themselves.
#pragma once

#include <string>

#include "cad_import/src/freecad_document.h"

namespace catoptra::cad_import {

/// Throws ImportError that names the ring, "A > B > A", where an object is in its own group or shown by its
/// own link.
void check_freecad_cycles(const FreecadDocument& document, const std::string& file);

}  // namespace catoptra::cad_import
