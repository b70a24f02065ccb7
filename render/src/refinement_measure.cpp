#include "render/src/refinement_measure.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <span>

#include "optics/map_coordinates.h"
#include "render/src/turn_steps.h"

namespace catoptra::render {
namespace {

using optics::VertexHit;

// Triangles that lie outside the picture by so much on one side are left alone: samples within pixels and
// filters reach that far.
constexpr double kOffScreen_px = 4;

/// Angle, as a vector across the ray, that `off` in map coordinates stands for.
glm::dvec3 angle_of(const optics::VirtualView& view, const VertexHit& ray, double near, glm::dvec2 off) {
  const glm::dvec3 step =
      off.x * (view.right_side - view.left) * view.right + off.y * (view.top - view.bottom) * view.up;
  // Times the depth in the map, over the distance.
  double scale = near;
  if (view.projection == optics::MapProjection::perspective)
    scale = near > 0 ? std::abs(glm::dot(ray.hit_point_mm - view.viewpoint_mm, view.direction)) * near
                     : std::abs(glm::dot(ray.direction, view.direction));
  const glm::dvec3 angle = scale * step;
  return angle - glm::dot(angle, ray.direction) * ray.direction;
}

/// The step in pixels that changes a value by `wanted` which changes by `by_right` and `by_up` per mm.
double pixels_for(const PicturePlace& place, const glm::dvec3& by_right, const glm::dvec3& by_up,
                  const glm::dvec3& wanted, double least_per_mm) {
  const glm::dmat2 mm = glm::inverse(place.pixels);
  const double mm_per_px = std::sqrt(std::abs(glm::determinant(mm)));
  return steps_to_turn(mm[0].x * by_right + mm[0].y * by_up, mm[1].x * by_right + mm[1].y * by_up, wanted,
                       least_per_mm * mm_per_px);
}

}  // namespace

PicturePlace picture_place(const RasterView& camera, const glm::dvec3& at_mm) {
  const glm::dvec3 ray = glm::normalize(at_mm - camera.origin_mm);
  const glm::dvec3 other = std::abs(ray.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  PicturePlace place;
  place.right = glm::normalize(glm::cross(ray, other));
  place.up = glm::cross(place.right, ray);
  const double step = 1e-4 * glm::distance(at_mm, camera.origin_mm);
  const auto change = [&](const glm::dvec3& along) {
    return glm::dvec2(camera.pixel(at_mm + step * along) - camera.pixel(at_mm - step * along)) / (2 * step);
  };
  place.pixels = glm::dmat2(change(place.right), change(place.up));
  return place;
}

bool off_screen(const RasterView& camera, const std::array<glm::dvec3, 3>& corners) {
  glm::dvec3 low = corners[0], high = corners[0];
  for (const glm::dvec3& corner : corners) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  return low.z <= 0 || high.x < -kOffScreen_px || low.x > camera.size.x + kOffScreen_px ||
         high.y < -kOffScreen_px || low.y > camera.size.y + kOffScreen_px;
}

double nearness(const VertexHit& hit) {
  return hit.scene_hit ? 1 / std::max(hit.scene_hit.t_mm, optics::kSelfHitDistance_mm) : 0;
}

VertexHit ray_through(const VertexHit& middle, const glm::dvec3& offset_mm, double near) {
  VertexHit ray = middle;
  ray.surface_point_mm += middle.differential.point * offset_mm;
  ray.direction = glm::normalize(middle.direction + middle.differential.direction * offset_mm);
  ray.scene_hit = {};
  if (!(near > 0)) return ray;
  ray.scene_hit.t_mm = 1 / near;
  ray.scene_hit.object = 0;
  ray.hit_point_mm = ray.surface_point_mm + ray.direction / near;
  return ray;
}

glm::dvec2 map_off(const optics::VirtualView& view, const glm::dvec3& shown, const VertexHit& ray) {
  const glm::dvec3 exact = optics::map_coordinates_like(std::span(&shown, 1), std::span(&ray, 1), view)[0];
  return glm::dvec2(shown) / shown.z - glm::dvec2(exact) / exact.z;
}

double map_error_px(const PicturePlace& place, const optics::VirtualView& view, const VertexHit& ray,
                    double near, double eye_distance_mm, glm::dvec2 off) {
  const auto turn = [&](const glm::dvec3& along) {
    const glm::dvec3 t = ray.differential.direction * along + near * (ray.differential.point * along);
    return t - glm::dot(t, ray.direction) * ray.direction;
  };
  return pixels_for(place, turn(place.right), turn(place.up), angle_of(view, ray, near, off),
                    1 / (kMostMagnification * eye_distance_mm));
}

double surface_error_px(const PicturePlace& place, const VertexHit& ray, const glm::dvec3& off_mm) {
  const glm::dvec3 by_right = ray.differential.point * place.right, by_up = ray.differential.point * place.up,
                   normal = glm::cross(by_right, by_up);
  const double area = glm::length(normal);
  if (!(area > 0)) return 0;  // a point: nothing moves on it
  const glm::dvec3 n = normal / area;
  return pixels_for(place, by_right, by_up, off_mm - glm::dot(off_mm, n) * n, 1 / kMostMagnification);
}

}  // namespace catoptra::render
