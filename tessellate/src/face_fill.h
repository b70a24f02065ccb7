// Trimmed faces: grid points inside the border, joined to it by a constrained Delaunay triangulation.
#pragma once

#include <string>

#include "cad_import/cad_model.h"
#include "tessellate/src/border.h"
#include "tessellate/src/mesh_draft.h"
#include "tessellate/src/sizing.h"

namespace catoptra::tessellate {

/// Adds the face's triangles, with every inner edge and triangle centre within the limits. Returns an empty
/// string, or why the face cannot be meshed; then nothing was added.
[[nodiscard]] std::string fill_face(const cad_import::Face& face, int face_index, const Borders& borders,
                                    const FaceSizing& sizing, const StepLimits& limits, MeshDraft& draft);

}  // namespace catoptra::tessellate
