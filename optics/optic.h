// A mirror, lens or planar glass as the optics see it: exact faces, their mesh, and what becomes of the
// light.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "cad_import/cad_model.h"
#include "optics/medium.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::optics {

/// A refractor is one change of medium at a plane, a pane is a plate: in and out.
enum class OpticKind { mirror, lens, refractor, pane };

/// Optical faces with their mesh; OpticVertex::face and OpticTriangle::face index `faces`.
struct OpticSide {
  std::vector<cad_import::Face> faces;
  tessellate::OpticArrays mesh;
};

/// What a planar optic of the surroundings is made of (docs/decisions/0015-planar-optics-and-light.md says
/// what each value does to a ray).
struct PlanarMaterial {
  double ior = 1.5;           ///< glass: behind the face (against its normal) over before it, 1 .. 5
  double thickness_mm = 0;    ///< pane
  glm::vec3 tint{1};          ///< glass: factor of the light that passes, linear RGB, 0 .. 1
  double translucency = 0;    ///< 0 clear .. 1 fog: share of fog over 1 m behind the glass
  double material_alpha = 0;  ///< share of the lit surface in what is seen, 0 .. 1
  glm::vec3 color{0.8f};      ///< diffuse albedo of that surface, and of the fog in ambient light
  /// Standard deviations of the tilt of the normal, along the face's first edge and across it: what a rough
  /// surface reflects, by accumulated samples.
  glm::dvec2 roughness_rad{0};
  glm::dvec3 first_edge{1, 0, 0};  ///< direction of that edge
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
  bool two_sided = false;       ///< both sides reflect; planar mirrors only

  // Planar optics only: mirrors from [[planar]], refractors and panes. One plane face, one mesh, whatever the
  // thickness; refractors and panes always work from both sides unless `one_sided`.
  bool planar = false;
  bool one_sided = false;  ///< glass: from the other side it is not there
  PlanarMaterial material;

  // Lenses only. Normals of both sides point out of the glass.
  OpticSide back;
  Medium medium = air();  ///< of the lens
  Medium around = air();  ///< on both sides of it
  int wavelengths = 3;    ///< see spectral_samples()
  glm::vec3 rim_color{
      0.05f};  ///< linear RGB, shown (times the ambient light) where a ray does not get through
};

/// Whether light both passes and is reflected at a plane.
[[nodiscard]] inline bool is_planar_glass(OpticKind kind) {
  return kind == OpticKind::refractor || kind == OpticKind::pane;
}
[[nodiscard]] inline bool is_planar_glass(const Optic& optic) {
  return is_planar_glass(optic.kind);
}

[[nodiscard]] inline const char* kind_name(OpticKind kind) {
  switch (kind) {
    case OpticKind::mirror:
      return "mirror";
    case OpticKind::lens:
      return "lens";
    case OpticKind::refractor:
      return "refractor";
    case OpticKind::pane:
      return "pane";
  }
  return "";
}

}  // namespace catoptra::optics
