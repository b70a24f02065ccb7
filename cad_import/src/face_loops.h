// The boundary of a kernel face as trim loops.
#pragma once

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Face.hxx>
#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <vector>

#include "cad_import/cad_model.h"
#include "cad_import/src/affine_map.h"

namespace catoptra::cad_import {

/// Edges and vertices of the whole model, numbered from 0 by TopTools index - 1.
struct TopologyIndex {
  TopTools_IndexedMapOfShape edges, vertices;
};

struct FaceLoops {
  std::vector<TrimLoop> loops;
  std::vector<std::vector<glm::dvec2>>
      polygons;         // one per loop, for tests of containment and the parameter range
  std::string problem;  // empty, or what is wrong with the boundary
};

/// `face`: with its location. `placement`: of the whole model. Loops come out as TrimLoop says; the surface
/// under them is needed for degenerate edges, which have no space curve.
[[nodiscard]] FaceLoops face_loops(const TopoDS_Face& face, const AffineMap& placement,
                                   const TopologyIndex& index,
                                   const std::shared_ptr<const ExactSurface>& surface);

}  // namespace catoptra::cad_import
