#include "optics/view_regions.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::optics {
namespace {

/// Signed area, across the ray, of what one square millimetre across the eye's ray has become `distance_mm`
/// behind the optic (per square of that distance where it is infinite).
double beam_area(const VertexHit& hit, double distance_mm) {
  const glm::dvec3 helper = std::abs(hit.from_eye.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 e1 = glm::normalize(glm::cross(hit.from_eye, helper)), e2 = glm::cross(hit.from_eye, e1);
  const glm::dmat3 moved = std::isfinite(distance_mm)
                               ? hit.differential.point + distance_mm * hit.differential.direction
                               : hit.differential.direction;
  return glm::dot(hit.direction, glm::cross(moved * e1, moved * e2));
}

bool crossed_once(const VertexHit& hit) {
  const double distance = hit.scene_hit ? hit.scene_hit.t_mm : kInfinity;
  return beam_area(hit, 0) * beam_area(hit, distance) < 0;
}

/// Whether the ray is off the viewpoint by too much of the map's width at that depth.
bool passes_wide(const VertexHit& hit, const VirtualView& view, double depth_mm) {
  const double miss = glm::length(glm::cross(hit.surface_point_mm - view.viewpoint_mm, hit.direction));
  const double half_width = 0.5 * depth_mm * std::max(view.right_side - view.left, view.top - view.bottom);
  return miss > kCloseCrossing * half_width;
}

}  // namespace

ViewRegions& ViewRegions::operator+=(const ViewRegions& other) {
  vertices += other.vertices;
  zooming += other.zooming;
  close += other.close;
  crossed_once += other.crossed_once;
  return *this;
}

ViewRegions view_regions(std::span<const VertexHit> hits, const VirtualView& view) {
  ViewRegions regions;
  for (const VertexHit& hit : hits) {
    if (!hit.faces_eye || hit.end != LensPathEnd::passed) continue;
    ++regions.vertices;
    regions.crossed_once += crossed_once(hit);
    if (!hit.scene_hit || !view.beyond_viewpoint) continue;
    const double depth = glm::dot(hit.hit_point_mm - view.viewpoint_mm, view.direction);
    const bool zooming = view.zooms() && depth <= -view.zooming_near_mm;
    regions.zooming += zooming;
    regions.close += (!zooming && depth < view.near_mm) || passes_wide(hit, view, std::abs(depth));
  }
  return regions;
}

}  // namespace catoptra::optics
