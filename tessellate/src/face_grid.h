// Faces that fill a rectangle of their parameters: a plain grid of rows and columns.
#pragma once

#include <array>
#include <optional>

#include "cad_import/cad_model.h"
#include "tessellate/src/border.h"
#include "tessellate/src/mesh_draft.h"

namespace catoptra::tessellate {

/// The edges along v_min, u_max, v_max and u_min, as the loop uses them (counter-clockwise).
using GridSides = std::array<const cad_import::EdgeUse*, 4>;

/// Nullopt where the face has holes, or a side that is not one edge at constant u or v.
[[nodiscard]] std::optional<GridSides> recognise_grid(const cad_import::Face& face);

/// Adds the grid that joins the cuts of opposite sides. These must be equally many.
void mesh_grid(const cad_import::Face& face, int face_index, const GridSides& sides, const Borders& borders,
               MeshDraft& draft);

}  // namespace catoptra::tessellate
