// Faces of a CAD model that are one surface to a designer.
#pragma once

#include <vector>

#include "cad_import/cad_model.h"

namespace catoptra::cad_import {

struct FaceGrouping {
  bool planar = false;      ///< planar faces take part
  bool same_names = false;  ///< faces with the same name belong together too
};

/// The faces of `model` in groups, each ascending: faces that meet smoothly (normals within 1 degree at the
/// middle of a shared edge) belong together.
[[nodiscard]] std::vector<std::vector<int>> smooth_face_groups(const CadModel& model,
                                                               const FaceGrouping& grouping = {});

}  // namespace catoptra::cad_import
