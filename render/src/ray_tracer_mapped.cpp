#include "render/src/ray_tracer_mapped.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/src/pixel_error.h"
#include "render/src/shading_vector_clones.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = MapLanes::kLanes;
constexpr double kHalf = 0.8 * kExactTolerance_px;  // see set_half_pixels()

bool meets_nothing(const optics::RayPacket16& rays, int i) {
  return rays.object[i] == optics::kNoHit;
}

CATOPTRA_VECTOR_CLONES void set_queries(const optics::RayPacket16& rays, float before_mm,
                                        const float (&half_pixel)[kLanes], MapQueries& queries) {
  MapQueries q;
  for (int i = 0; i < kLanes; ++i) {
    const int sky = rays.object[i] == optics::kNoHit;
    const float x = rays.direction_x[i], y = rays.direction_y[i], z = rays.direction_z[i];
    // Infinity times 0 is no number.
    const float way = sky ? 1.0f : rays.t_max[i], from = float(1 - sky);
    q.sky[i] = sky;
    q.direction_x[i] = x;
    q.direction_y[i] = y;
    q.direction_z[i] = z;
    q.point_x[i] = from * rays.origin_x[i] + way * x;
    q.point_y[i] = from * rays.origin_y[i] + way * y;
    q.point_z[i] = from * rays.origin_z[i] + way * z;
    q.normal_x[i] = rays.normal_x[i];
    q.normal_y[i] = rays.normal_y[i];
    q.normal_z[i] = rays.normal_z[i];
    q.distance[i] = from * before_mm + way;
    q.half_pixel[i] = half_pixel[i];
  }
  queries = q;
}

/// The less of the two singular values of a matrix with these columns, whose directions are across a ray.
double least_singular_value(const glm::dvec3& x, const glm::dvec3& y) {
  const double sum = glm::dot(x, x) + glm::dot(y, y), area = glm::length(glm::cross(x, y));
  const double largest =
      0.5 * (std::sqrt(std::max(0.0, sum + 2 * area)) + std::sqrt(std::max(0.0, sum - 2 * area)));
  return largest > 0 ? area / largest : 0;
}

}  // namespace

void find_in_maps(const MapColors& maps, const optics::RayPacket16& rays, const int (&optic)[kLanes],
                  std::uint32_t first_optic, float before_mm, const float (&half_pixel)[kLanes],
                  MapLanes& lanes) {
  MapQueries queries;
  set_queries(rays, before_mm, half_pixel, queries);
  std::fill(std::begin(lanes.answers.found), std::end(lanes.answers.found), 0);
  bool waiting[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    lanes.asked[i] = optic[i] >= 0;
    waiting[i] = lanes.asked[i] && (meets_nothing(rays, i) || rays.object[i] < first_optic);
  }
  for (int first = 0; first < kLanes; ++first) {
    if (!waiting[first]) continue;
    for (int i = 0; i < kLanes; ++i) {
      const bool now = waiting[i] && optic[i] == optic[first];
      queries.wanted[i] = now;
      if (now) waiting[i] = false;
    }
    maps.find(std::size_t(optic[first]), queries, lanes.answers);
  }
}

CATOPTRA_VECTOR_CLONES void set_half_pixels(const MirrorRays& mirrored, const optics::RayPacket16& rays,
                                            double pixel, const double (&stretch)[kLanes],
                                            float (&half_pixel)[kLanes]) {
  const double half = kHalf * pixel;
  double least[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const double sum = mirrored.wave_sum[i], product = mirrored.wave_product[i];
    const double difference = sum * sum - 4 * product, root = std::sqrt(difference > 0 ? difference : 1e-300);
    const double k1 = 0.5 * (sum - root), k2 = 0.5 * (sum + root);
    const int sky = rays.object[i] == optics::kNoHit;
    const double way = sky ? 1.0f : rays.t_max[i], from = 1 - sky;
    const double a = std::abs(from + way * k1), b = std::abs(from + way * k2);
    least[i] = a < b ? a : b;
  }
  for (int i = 0; i < kLanes; ++i)
    // Off the camera's axis a pixel is narrower, as seen from the eye, by up to the square of the stretch.
    half_pixel[i] = float(half / (stretch[i] * stretch[i]) * mirrored.distance[i] * least[i]);
}

void set_half_pixels(const BeamLanes& beams, const optics::RayPacket16& rays, float (&half_pixel)[kLanes]) {
  for (int i = 0; i < kLanes; ++i) {
    glm::dvec3 right = beams.direction_right.at(i), down = beams.direction_down.at(i);
    if (!meets_nothing(rays, i)) {
      right = beams.point_right.at(i) + double(rays.t_max[i]) * right;
      down = beams.point_down.at(i) + double(rays.t_max[i]) * down;
    }
    const glm::dvec3 d = beams.direction.at(i);
    half_pixel[i] =
        float(kHalf * least_singular_value(right - glm::dot(right, d) * d, down - glm::dot(down, d) * d));
  }
}

}  // namespace catoptra::render
