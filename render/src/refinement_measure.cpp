#include "render/src/refinement_measure.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::render {
namespace {

using optics::VertexHit;

// Edges that lie outside the picture by this share of its size on one side are left alone.
constexpr double kOffScreen = 0.1;
// Where an optic magnifies, against the direct view, by more than this, what it shows between two pixels is
// less than the error can be told from: near a caustic one pixel shows (nearly) one direction only.
constexpr double kMostMagnification = 20;

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

/// Least squares for the step that changes a value by `wanted`, damped where it changes by less than `least`
/// per mm; in pixels.
double pixels_for(const PicturePlace& place, const glm::dvec3& by_right, const glm::dvec3& by_up,
                  const glm::dvec3& wanted, double least) {
  const double a = glm::dot(by_right, by_right) + least * least, b = glm::dot(by_right, by_up),
               c = glm::dot(by_up, by_up) + least * least, determinant = a * c - b * b;
  const double u = glm::dot(by_right, wanted), v = glm::dot(by_up, wanted);
  const glm::dvec2 moved_mm((c * u - b * v) / determinant, (a * v - b * u) / determinant);
  return glm::length(place.pixels * moved_mm);
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

bool off_screen(const RasterView& camera, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec2 margin = kOffScreen * glm::dvec2(camera.size);
  return (a.z <= 0 || b.z <= 0) || std::max(a.x, b.x) < -margin.x ||
         std::min(a.x, b.x) > camera.size.x + margin.x || std::max(a.y, b.y) < -margin.y ||
         std::min(a.y, b.y) > camera.size.y + margin.y;
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

double map_error_px(const PicturePlace& place, const optics::VirtualView& view, const VertexHit& ray,
                    double near, double eye_distance_mm, glm::dvec2 off) {
  const auto turn = [&](const glm::dvec3& along) {
    const glm::dvec3 t = ray.differential.direction * along + near * (ray.differential.point * along);
    return t - glm::dot(t, ray.direction) * ray.direction;
  };
  // Damped where the turn per mm is below that of the direct view over kMostMagnification.
  return pixels_for(place, turn(place.right), turn(place.up), angle_of(view, ray, near, off),
                    1 / (kMostMagnification * eye_distance_mm));
}

double surface_error_px(const PicturePlace& place, const VertexHit& ray, const glm::dvec3& off_mm) {
  return pixels_for(place, ray.differential.point * place.right, ray.differential.point * place.up, off_mm,
                    1 / kMostMagnification);
}

}  // namespace catoptra::render
