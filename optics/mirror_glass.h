// A mirror's glass as one holds it in the hand: its middle, upright and level on it, its outline, and the
// exact surface at any place of it. What the instruments of mirror_evaluation.h are put on.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cad_import/exact_surface.h"
#include "optics/optic.h"
#include "optics/ray_packet.h"

namespace catoptra::optics {

/// Right-handed frame on the glass: x along `across`, y along `upward`, z along `normal`. Someone who looks
/// at the reflecting side sees x to the right and y up.
struct GlassFrame {
  glm::dvec3 center_mm;  ///< on the surface, at its centre of area
  glm::dvec3 normal;     ///< unit, of the surface there, on the reflecting side
  glm::dvec3 across;     ///< unit, level
  glm::dvec3 upward;     ///< unit, as upright as the glass allows
};

/// A place on the reflecting surface.
struct GlassPoint {
  glm::dvec2 xy_mm{0};  ///< in the GlassFrame
  int face = 0;         ///< index in the mirror's faces
  glm::dvec2 uv{0};
  cad_import::SurfaceDerivatives surface;
  glm::dvec3 normal;                           ///< unit, on the reflecting side
  cad_import::PrincipalCurvatures curvatures;  ///< 1/mm, positive where convex on the reflecting side
};

/// Immutable, safe to use from many threads.
class MirrorGlass {
 public:
  /// Shares the mirror's surfaces. `up` (any length) tells how the glass is held; where it runs along the
  /// glass's normal, upright is any direction. Throws catoptra::Error for a lens or a mirror without mesh.
  MirrorGlass(const Optic& mirror, const glm::dvec3& up);

  [[nodiscard]] const Optic& optic() const { return optic_; }
  [[nodiscard]] const GlassFrame& frame() const { return frame_; }

  /// The place above (x, y) of the frame, along its normal; nullopt beside the glass.
  [[nodiscard]] std::optional<GlassPoint> at(const glm::dvec2& xy_mm) const;

  /// Where a line meets the glass, of the crossings the one found from `near`; nullopt beside the glass. The
  /// line runs to both sides of the origin.
  [[nodiscard]] std::optional<GlassPoint> meet(const glm::dvec3& origin_mm, const glm::dvec3& direction,
                                               const GlassPoint& near) const;

  /// The place with these parameters, whether the outline holds it or not.
  [[nodiscard]] GlassPoint place(int face, const glm::dvec2& uv) const;
  [[nodiscard]] bool on_glass(int face, const glm::dvec2& uv) const;

  /// Closed outlines in frame coordinates, first corner not repeated, longest first: chords between exact
  /// points of the border, as fine as the mirror's mesh.
  [[nodiscard]] std::span<const std::vector<glm::dvec2>> outlines() const { return outlines_; }
  /// The same places in space.
  [[nodiscard]] std::span<const std::vector<glm::dvec3>> borders() const { return borders_; }

  [[nodiscard]] glm::dvec2 low_mm() const { return low_; }  ///< extent of the outline, frame coordinates
  [[nodiscard]] glm::dvec2 high_mm() const { return high_; }

 private:
  [[nodiscard]] glm::dvec2 frame_xy(const glm::dvec3& point_mm) const;
  [[nodiscard]] std::optional<GlassPoint> meet_face(int face, const Ray& line, const glm::dvec2& start) const;
  [[nodiscard]] std::optional<glm::dvec2> nearest_vertex(int face, const glm::dvec2& xy) const;

  Optic optic_;
  GlassFrame frame_{};
  std::vector<std::vector<glm::dvec2>> outlines_;
  std::vector<std::vector<glm::dvec3>> borders_;
  glm::dvec2 low_{0}, high_{0};
};

/// Length that is positive inside the outlines (even-odd rule) and negative outside: distance to the nearest
/// edge, mm.
[[nodiscard]] double distance_inside_mm(std::span<const std::vector<glm::dvec2>> outlines,
                                        const glm::dvec2& xy);

/// Width of the widest upright rectangle of that height inside the outlines, 0 where none fits. To 0.1 mm.
[[nodiscard]] double widest_rectangle_mm(std::span<const std::vector<glm::dvec2>> outlines, double height_mm);

/// Length of the longest upright segment inside the outlines. To 0.1 mm.
[[nodiscard]] double longest_upright_mm(std::span<const std::vector<glm::dvec2>> outlines);

}  // namespace catoptra::optics
