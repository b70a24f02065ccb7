#include "examples/plates/light_stage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <vector>

namespace catoptra::examples {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

/// A ray from `origin` along the unit vector `direction`, as far as `length`.
struct Segment {
  glm::dvec3 origin, direction;
  double length = kForever;
};

/// Slabs: Kay and Kajiya 1986.
bool meets_box(const Segment& ray, const glm::dvec3& low, const glm::dvec3& high) {
  double enter = 0, leave = ray.length;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    if (d == 0) {
      if (o < low[axis] || o > high[axis]) return false;
      continue;
    }
    const double a = (low[axis] - o) / d, b = (high[axis] - o) / d;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave;
}

bool meets_sphere(const Segment& ray, const glm::dvec3& centre, double radius) {
  const double along = std::clamp(glm::dot(centre - ray.origin, ray.direction), 0.0, ray.length);
  return glm::distance(ray.origin + along * ray.direction, centre) < radius;
}

/// Where the ray crosses the face: the distance.
std::optional<double> meets_face(const LightStage& stage, const Segment& ray) {
  if (ray.direction.x == 0) return std::nullopt;
  const double t = -ray.origin.x / ray.direction.x;
  const glm::dvec3 q = ray.origin + t * ray.direction;
  if (t <= 0 || std::abs(q.y) > stage.half_width || q.z < stage.low || q.z > stage.high) return std::nullopt;
  return t;
}

LightStage common_stage() {
  LightStage stage;
  constexpr double kFromUpright = 50 * 0.017453292519943295;  // 50 degrees
  stage.sun = {std::sin(kFromUpright), 0, -std::cos(kFromUpright)};
  stage.half_width = 0.7;
  stage.low = 0.25;
  stage.high = 1.25;
  return stage;
}

}  // namespace

LightStage refraction_stage() {
  LightStage stage = common_stage();
  // All of the cube's shadow falls on the face; its refracted image reaches beyond the face's own shadow.
  stage.cube_low = {-0.66, -0.16, 1.00};
  stage.cube_high = {-0.34, 0.16, 1.32};
  // Within the face's shadow, half of it in the cube's refracted one.
  stage.sphere_centre = {0.82, 0.18, 0.14};
  stage.sphere_radius = 0.14;
  stage.floor_low = {-0.6, -1.0};
  stage.floor_high = {3.0, 1.0};
  return stage;
}

LightStage reflection_stage() {
  LightStage stage = common_stage();
  stage.mirror = true;
  stage.cube_low = {-0.86, -0.16, 1.20};
  stage.cube_high = {-0.54, 0.16, 1.52};
  stage.sphere_centre = {-0.80, 0.16, 0.20};
  stage.sphere_radius = 0.14;
  stage.floor_low = {-2.0, -1.0};
  stage.floor_high = {1.8, 1.0};
  return stage;
}

glm::dvec3 light_from_face(const LightStage& stage) {
  if (stage.mirror) return {-stage.sun.x, stage.sun.y, stage.sun.z};
  // Snell: what lies in the face keeps its direction and is divided by the index.
  const glm::dvec2 across = glm::dvec2(stage.sun.y, stage.sun.z) / stage.ior;
  return {std::sqrt(1 - glm::dot(across, across)), across};
}

FloorLight floor_light(const LightStage& stage, const glm::dvec2& point) {
  const glm::dvec3 p(point, 0);
  const auto cube = [&](const Segment& ray) { return meets_box(ray, stage.cube_low, stage.cube_high); };
  const auto sphere = [&](const Segment& ray) {
    return meets_sphere(ray, stage.sphere_centre, stage.sphere_radius);
  };
  FloorLight light;
  const Segment straight{p, -stage.sun};
  light.face_shadow = meets_face(stage, straight).has_value();
  light.primary = !light.face_shadow && !cube(straight) && !sphere(straight);
  const Segment back{p, -light_from_face(stage)};
  if (const auto t = meets_face(stage, back)) {
    light.from_face = true;
    const Segment after{p, back.direction, *t}, before{p + *t * back.direction, -stage.sun};
    light.cube_shadow = cube(after) || cube(before);
    light.sphere_shadow = sphere(after) || sphere(before);
  }
  return light;
}

int floor_region(const LightStage& stage, const glm::dvec2& point) {
  const FloorLight light = floor_light(stage, point);
  if (!light.from_face) return light.primary ? 1 : light.face_shadow ? 8 : 0;
  if (light.cube_shadow && light.sphere_shadow) return 5;
  if (light.cube_shadow) return light.primary ? 3 : 4;
  if (light.sphere_shadow) return 6;
  return light.primary ? 2 : 7;
}

std::array<LabelPlace, 8> label_places(const LightStage& stage) {
  constexpr double kCell = 0.01;
  const glm::dvec2 size = stage.floor_high - stage.floor_low;
  const int columns = int(std::lround(size.x / kCell)), rows = int(std::lround(size.y / kCell));
  const auto middle = [&](int i, int j) { return stage.floor_low + kCell * glm::dvec2(i + 0.5, j + 0.5); };
  const auto at = [&](int i, int j) { return std::size_t(j) * std::size_t(columns) + std::size_t(i); };
  std::vector<int> region(std::size_t(columns) * std::size_t(rows));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) region[at(i, j)] = floor_region(stage, middle(i, j));
  // side[cell]: of the largest square of one region whose last corner the cell is.
  std::vector<int> side(region.size(), 1);
  std::array<LabelPlace, 8> places;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int r = region[at(i, j)];
      if (i > 0 && j > 0 && region[at(i - 1, j)] == r && region[at(i, j - 1)] == r &&
          region[at(i - 1, j - 1)] == r)
        side[at(i, j)] = 1 + std::min({side[at(i - 1, j)], side[at(i, j - 1)], side[at(i - 1, j - 1)]});
      if (r == 0) continue;
      LabelPlace& place = places[std::size_t(r - 1)];
      const double half = side[at(i, j)] * kCell / 2;
      if (half > place.half_side) place = {middle(i, j) + kCell / 2 - half, half};
    }
  return places;
}

}  // namespace catoptra::examples
