// Where on a mirror an eye sees a given point.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "optics/mirror_glass.h"

namespace catoptra::optics {

/// A point, or a direction in which something infinitely far lies.
struct SightTarget {
  glm::dvec3 point_mm{0};  ///< or the unit direction towards it
  bool far = false;
};

struct ReflectionPoint {
  int face = 0;
  glm::dvec2 uv{0};
  glm::dvec3 position_mm{0};
  bool on_glass = false;  ///< false: on the surface's continuation beyond the outline
};

/// Solves for the reflection point by Fermat's principle: the path eye - mirror - target is stationary where
/// (a + b) . r_u = (a + b) . r_v = 0, with a and b the unit vectors from eye and target to the mirror point.
/// Newton's method on exact derivatives, from the vertex whose reflected ray points best at the target;
/// converged when a step is below 1e-9 mm. Thread-safe.
class ReflectionFinder {
 public:
  /// Keeps `glass`.
  ReflectionFinder(const MirrorGlass& glass, const glm::dvec3& eye_mm);

  /// Of several reflection points (concave mirrors beyond the focus) one on the glass. Nullopt where there is
  /// none on the surface's reflecting side.
  [[nodiscard]] std::optional<ReflectionPoint> find(const SightTarget& target) const;

  /// Least angle between the target and a reflected ray of the mesh, rad: how far the mirror looks past it.
  [[nodiscard]] double miss_angle(const SightTarget& target) const;

  [[nodiscard]] const glm::dvec3& eye_mm() const { return eye_; }

 private:
  struct Start {
    glm::dvec3 position, reflected;
    glm::dvec2 uv;
  };
  [[nodiscard]] std::optional<ReflectionPoint> find_on(int face, const SightTarget& target) const;
  [[nodiscard]] bool faces_both(const glm::dvec3& position, const glm::dvec3& normal,
                                const SightTarget& target) const;

  const MirrorGlass* glass_;
  glm::dvec3 eye_;
  std::vector<std::vector<Start>> starts_;  // by face
};

}  // namespace catoptra::optics
