// A vertex with all that its surface knows there.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "cad_import/cad_model.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::tessellate {

/// Normal and curvatures at (u, v) of a face. Where the parameters collapse (a pole, the apex of a cone) they
/// are taken a little way inside. The position is given: a border vertex belongs to several faces.
[[nodiscard]] OpticVertex exact_vertex(const cad_import::Face& face, int face_index, const glm::dvec2& uv,
                                       const glm::dvec3& position_mm);

}  // namespace catoptra::tessellate
