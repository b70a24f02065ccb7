// A flat face from its corners: planar mirrors and panes that no CAD file holds.
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "cad_import/cad_model.h"
#include "cad_import/error.h"

namespace catoptra::cad_import {

/// One body with one planar face, named `Polygon`, whose normal points to the side from which the corners run
/// counter-clockwise. `corners_mm`: three or more in either sense, not closed, within 1e-6 of the polygon's
/// size in one plane, not crossing itself. Throws Error naming the corner at fault.
[[nodiscard]] CadModel polygon_model(std::span<const glm::dvec3> corners_mm);

}  // namespace catoptra::cad_import
