#include "tessellate/src/exact_vertex.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::tessellate {
namespace {

constexpr double kCollapsed =
    1e-5;                          // of the face's size: rounding could turn the normal round at such a place
constexpr double kInwards = 1e-4;  // of the way to the middle of the face

}  // namespace

OpticVertex exact_vertex(const cad_import::Face& face, int face_index, const glm::dvec2& uv,
                         const glm::dvec3& position_mm) {
  const auto& surface = *face.surface;
  const auto domain = surface.domain();
  const auto frame = surface.d1(uv.x, uv.y);
  const double size_u = glm::length(frame.du) * (domain.u_max - domain.u_min);
  const double size_v = glm::length(frame.dv) * (domain.v_max - domain.v_min);
  glm::dvec2 at = uv;
  if (std::min(size_u, size_v) < kCollapsed * std::max(size_u, size_v)) {
    const glm::dvec2 middle(0.5 * (domain.u_min + domain.u_max), 0.5 * (domain.v_min + domain.v_max));
    at += kInwards * (size_u < size_v ? glm::dvec2(0, middle.y - uv.y) : glm::dvec2(middle.x - uv.x, 0));
  }
  const auto curvature = surface.principal_curvatures(at.x, at.y);
  return {position_mm,
          surface.unit_normal(at.x, at.y),
          curvature.k1,
          curvature.k2,
          curvature.direction1,
          face_index,
          uv};
}

}  // namespace catoptra::tessellate
