// Rays and hits, one at a time (double) and in packets of 16 (float, structure of arrays).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace catoptra::optics {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr std::uint32_t kNoHit = 0xffffffffu;

/// What a query may hit. Combine with |. Casters are what stands in the way of light: surroundings but for
/// their alpha-tested triangles, and those optics that were added as such; kEverything is all that rays meet.
enum ObjectMask : std::uint32_t { kSurroundings = 1u, kOptics = 2u, kEverything = 3u, kCasters = 4u };

struct Ray {
  glm::dvec3 origin_mm;
  glm::dvec3 direction;  ///< unit
  double t_min_mm = 0;
  double t_max_mm = kInfinity;
};

/// Nearest hit. The distance and barycentrics are computed again in double precision from the hit triangle.
struct Hit {
  double t_mm = kInfinity;
  std::uint32_t object = kNoHit;    ///< as RayScene::add_* returned it
  std::uint32_t triangle = kNoHit;  ///< index in that object's triangles
  glm::dvec2 barycentric{0};        ///< weights of the triangle's second and third vertex
  [[nodiscard]] explicit operator bool() const { return object != kNoHit; }
};

/// 16 rays and their hits. Memory layout equals Embree's RTCRayHit16, so that a query copies nothing.
struct alignas(64) RayPacket16 {
  float origin_x[16], origin_y[16], origin_z[16], t_min[16];
  float direction_x[16], direction_y[16], direction_z[16], time[16];
  float t_max[16];  ///< in: farthest distance; out: distance of the hit
  std::uint32_t mask[16], id[16], flags[16];
  float normal_x[16], normal_y[16], normal_z[16];  ///< out: geometric normal, not normalised
  float u[16], v[16];                              ///< out: weights of the triangle's second and third vertex
  std::uint32_t triangle[16], object[16], instance[16];  ///< out: object == kNoHit where nothing was hit
};

/// 16 rays that only ask whether anything is in their way. Memory layout equals Embree's RTCRay16.
struct alignas(64) ShadowPacket16 {
  float origin_x[16], origin_y[16], origin_z[16], t_min[16];
  float direction_x[16], direction_y[16], direction_z[16], time[16];
  float t_max[16];  ///< less than t_min: inactive
  std::uint32_t mask[16], id[16], flags[16];
};

}  // namespace catoptra::optics
