// A mirror (or lens) as the optics see it: exact faces, their mesh, and how much light they return.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "cad_import/cad_model.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::optics {

enum class OpticKind { mirror, lens };

struct Optic {
  std::string name;
  OpticKind kind = OpticKind::mirror;
  std::vector<cad_import::Face>
      faces;  ///< the optical faces; OpticVertex::face and OpticTriangle::face index them
  tessellate::OpticArrays mesh;
  glm::vec3 reflectance{0.9f};  ///< linear RGB
  bool flip = false;            ///< the reflecting side is opposite to the faces' normals
};

}  // namespace catoptra::optics
