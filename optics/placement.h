// Where an optic is: a rigid motion from its own frame, that of the scene as loaded, into the world.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "optics/optic.h"

namespace catoptra::optics {

/// world = rotation * own + translation. The rotation is orthogonal with determinant +1. The default moves
/// nothing, and does so exactly: no coordinate changes in its last bit.
struct Placement {
  glm::dmat3 rotation{1};
  glm::dvec3 translation_mm{0};

  [[nodiscard]] glm::dvec3 point(const glm::dvec3& own_mm) const {
    return rotation * own_mm + translation_mm;
  }
  [[nodiscard]] glm::dvec3 direction(const glm::dvec3& own) const { return rotation * own; }
  [[nodiscard]] glm::dvec3 own_point(const glm::dvec3& world_mm) const {
    return (world_mm - translation_mm) * rotation;  // row vector: the transpose is the inverse
  }
  [[nodiscard]] glm::dvec3 own_direction(const glm::dvec3& world) const { return world * rotation; }

  friend bool operator==(const Placement&, const Placement&) = default;
};

/// From a matrix whose last row is (0, 0, 0, 1). Its rotation may be off by 1e-6, as after many
/// multiplications, and is made orthogonal. Throws catoptra::Error, naming `optic`, where it scales, shears
/// or mirrors.
[[nodiscard]] Placement placement_from_matrix(const glm::dmat4& matrix, const std::string& optic);

/// The box in the world that holds a box in the optic's frame; an empty one stays empty.
[[nodiscard]] cad_import::BoundingBox placed(const cad_import::BoundingBox& own, const Placement& placement);
/// The box in the optic's frame that holds a box in the world.
[[nodiscard]] cad_import::BoundingBox in_own_frame(const cad_import::BoundingBox& world,
                                                   const Placement& placement);

/// The optic at its place in the world: meshes and exact faces. Faces keep name, id and trimming in (u, v).
[[nodiscard]] Optic placed(const Optic& own, const Placement& placement);

}  // namespace catoptra::optics
