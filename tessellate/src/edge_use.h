// Where a face uses an edge of the CAD model.
#pragma once

#include <glm/vec2.hpp>

#include "cad_import/cad_model.h"

namespace catoptra::tessellate {

/// The use of `cad_edge` by the face that passes nearest to `uv` at `t` (a seam is used twice); nullptr where
/// the face does not use it.
[[nodiscard]] const cad_import::EdgeUse* find_use(const cad_import::Face& face, int cad_edge, double t,
                                                  const glm::dvec2& uv);

}  // namespace catoptra::tessellate
