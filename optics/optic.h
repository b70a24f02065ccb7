// A mirror or lens as the optics see it: exact faces, their mesh, and what becomes of the light.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "cad_import/cad_model.h"
#include "optics/medium.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::optics {

enum class OpticKind { mirror, lens };

/// Optical faces with their mesh; OpticVertex::face and OpticTriangle::face index `faces`.
struct OpticSide {
  std::vector<cad_import::Face> faces;
  tessellate::OpticArrays mesh;
};

struct Optic {
  std::string name;
  OpticKind kind = OpticKind::mirror;

  /// A mirror's reflecting surface, or a lens's front.
  std::vector<cad_import::Face> faces;
  tessellate::OpticArrays mesh;

  // Mirrors only.
  glm::vec3 reflectance{0.9f};  ///< linear RGB
  bool flip = false;            ///< the reflecting side is opposite to the faces' normals

  // Lenses only. Normals of both sides point out of the glass.
  OpticSide back;
  Medium medium = air();  ///< of the lens
  Medium around = air();  ///< on both sides of it
  int wavelengths = 3;    ///< see spectral_samples()
  glm::vec3 rim_color{
      0.05f};  ///< linear RGB, shown (times the ambient light) where a ray does not get through
};

}  // namespace catoptra::optics
