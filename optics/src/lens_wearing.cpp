#include "optics/src/lens_wearing.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::optics {

Axes lens_axes(const LensFrame& frame) {
  return {frame.x, frame.y, frame.z};
}

// The lens is turned by R = R_y(wrap) R_x(pantoscopic), so the wearer's axes are the lens's turned by R^-1.
Axes wearer_axes(const LensFrame& frame, const WearingPosition& position) {
  const double towards = position.eye == Eye::right ? -1 : 1;
  const double cp = std::cos(position.pantoscopic_rad), sp = std::sin(position.pantoscopic_rad),
               cw = std::cos(position.wrap_rad), sw = towards * std::sin(position.wrap_rad);
  // Rows of R: the lens's coordinates of the wearer's axes.
  const Axes lens = lens_axes(frame);
  return {lens.to_model({cw, sw * sp, sw * cp}), lens.to_model({0, cp, -sp}),
          lens.to_model({-sw, cw * sp, cw * cp})};
}

LensFrame wearer_frame(const LensFrame& lens, const WearingPosition& position) {
  const Axes axes = wearer_axes(lens, position);
  return {lens.front_vertex_mm, lens.back_vertex_mm, axes.x, axes.y, axes.z};
}

glm::dvec3 gaze_direction(const Axes& axes, const glm::dvec2& gaze_rad) {
  return glm::normalize(axes.to_model({std::tan(gaze_rad.x), std::tan(gaze_rad.y), 1}));
}

glm::dvec2 gaze_of(const Axes& axes, const glm::dvec3& d) {
  const glm::dvec3 v = axes.from_model(d);
  if (v.z > 0) return {std::atan(v.x / v.z), std::atan(v.y / v.z)};  // half the time of what follows
  return {std::atan2(v.x, v.z), std::atan2(v.y, v.z)};
}

LensFrame lens_frame(const cad_import::LensGeometry& geometry, const glm::dvec3& up) {
  LensFrame frame;
  frame.front_vertex_mm = geometry.front_vertex_mm;
  frame.back_vertex_mm = geometry.back_vertex_mm;
  frame.z = geometry.axis;
  for (const glm::dvec3& candidate : {up, glm::dvec3(0, 0, 1), glm::dvec3(0, 1, 0)}) {
    const glm::dvec3 y = candidate - frame.z * glm::dot(candidate, frame.z);
    if (glm::length(y) <= 1e-6 * glm::length(candidate)) continue;
    frame.y = glm::normalize(y);
    break;
  }
  frame.x = glm::cross(frame.y, frame.z);
  return frame;
}

std::vector<glm::dvec2> gaze_grid(double max_rad, double step_rad) {
  if (!(step_rad > 0) || !(max_rad >= 0) || !(max_rad < 1.5))
    throw Error("", "grid of gaze directions", "needs 0 <= greatest angle < 86 degrees and a step above 0",
                "give for example 40 and 2 degrees");
  const int steps = int(std::floor(max_rad / step_rad + 1e-9));
  std::vector<glm::dvec2> grid;
  for (int j = steps; j >= -steps; --j)
    for (int i = -steps; i <= steps; ++i) {
      const glm::dvec2 gaze{i * step_rad, j * step_rad};
      const double tangent = std::hypot(std::tan(gaze.x), std::tan(gaze.y));
      if (std::atan(tangent) <= max_rad + 1e-9) grid.push_back(gaze);
    }
  return grid;
}

}  // namespace catoptra::optics
