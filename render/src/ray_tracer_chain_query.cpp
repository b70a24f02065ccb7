#include "render/src/ray_tracer_chain_query.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "optics/exact_hit.h"
#include "render/frame.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = LeftOptics::kLanes;

constexpr int kMaxOwnHits = 8;  // times a ray may pass through the optic it comes from

/// A bounce nearer than this to the one before is that one itself, found again: mm.
constexpr double kLeastWay_mm = 0.1;

/// To behind a hit.
void pass(optics::RayPacket16& query, int i, float t_max) {
  query.t_min[i] = query.t_max[i] * (1 + 1e-6f) + 1e-3f;
  query.t_max[i] = t_max;
}

float facing(const optics::RayPacket16& p, int i) {
  return p.normal_x[i] * p.direction_x[i] + p.normal_y[i] * p.direction_y[i] +
         p.normal_z[i] * p.direction_z[i];
}

/// Whether the exact surface is met there too, from the side that the rays leave to.
bool is_exact(const OwnSide& own, const optics::RayPacket16& query, int i) {
  const optics::Ray ray{{query.origin_x[i], query.origin_y[i], query.origin_z[i]},
                        {query.direction_x[i], query.direction_y[i], query.direction_z[i]},
                        kLeastWay_mm};
  const optics::Hit hit{
      double(query.t_max[i]), 0, query.triangle[i], {double(query.u[i]), double(query.v[i])}};
  const auto exact = optics::exact_hit(own.side.faces, *own.side.mesh, ray, hit);
  return exact && own.sense * glm::dot(exact->normal, ray.direction) < 0;
}

}  // namespace

void load_rays(ChainLanes& lanes) {
  for (int i = 0; i < kLanes; ++i) {
    const bool active = lanes.left.active[i];
    const glm::dvec3 origin = active ? lanes.beams.point.at(i) : glm::dvec3(0),
                     direction = active ? lanes.beams.direction.at(i) : glm::dvec3(1, 0, 0);
    lanes.rays.origin_x[i] = float(origin.x);
    lanes.rays.origin_y[i] = float(origin.y);
    lanes.rays.origin_z[i] = float(origin.z);
    lanes.rays.direction_x[i] = float(direction.x);
    lanes.rays.direction_y[i] = float(direction.y);
    lanes.rays.direction_z[i] = float(direction.z);
    lanes.rays.t_min[i] = 0;
    lanes.rays.t_max[i] = active ? std::numeric_limits<float>::infinity() : -1.0f;
  }
}

void set_left(const ChainLanes& from, int i, int optic, optics::LensSide side, ChainLanes& to) {
  to.left.active[i] = true;
  to.left.optic[i] = optic;
  to.left.side[i] = side;
  to.bounces[i] = std::uint8_t(from.bounces[i] + 1);
  to.path[i] = path_after(from.path[i], optic);
}

void copy_hit(const optics::RayPacket16& from, int i, optics::RayPacket16& to) {
  to.origin_x[i] = from.origin_x[i];
  to.origin_y[i] = from.origin_y[i];
  to.origin_z[i] = from.origin_z[i];
  to.direction_x[i] = from.direction_x[i];
  to.direction_y[i] = from.direction_y[i];
  to.direction_z[i] = from.direction_z[i];
  to.t_max[i] = from.t_max[i];
  to.normal_x[i] = from.normal_x[i];
  to.normal_y[i] = from.normal_y[i];
  to.normal_z[i] = from.normal_z[i];
  to.u[i] = from.u[i];
  to.v[i] = from.v[i];
  to.triangle[i] = from.triangle[i];
  to.object[i] = from.object[i];
}

void set_met(const optics::RayPacket16& hits, int lane, int optic, optics::LensSide entered, MetOptics& met) {
  met.optic[lane] = optic;
  met.entered[lane] = entered;
  met.distance[lane] = hits.t_max[lane];
  met.u[lane] = hits.u[lane];
  met.v[lane] = hits.v[lane];
  met.triangle[lane] = hits.triangle[lane];
}

void copy_hits(const optics::RayPacket16& from, ShadeLanes& to) {
  for (int i = 0; i < kLanes; ++i) {
    to.position_x[i] = from.origin_x[i] + from.t_max[i] * from.direction_x[i];
    to.position_y[i] = from.origin_y[i] + from.t_max[i] * from.direction_y[i];
    to.position_z[i] = from.origin_z[i] + from.t_max[i] * from.direction_z[i];
  }
  std::copy_n(from.direction_x, kLanes, to.direction_x);
  std::copy_n(from.direction_y, kLanes, to.direction_y);
  std::copy_n(from.direction_z, kLanes, to.direction_z);
  std::copy_n(from.normal_x, kLanes, to.normal_x);
  std::copy_n(from.normal_y, kLanes, to.normal_y);
  std::copy_n(from.normal_z, kLanes, to.normal_z);
  std::copy_n(from.u, kLanes, to.u);
  std::copy_n(from.v, kLanes, to.v);
  std::copy_n(from.object, kLanes, to.object);
  std::copy_n(from.triangle, kLanes, to.triangle);
}

void query_past_own(const optics::RayScene& scene, std::uint32_t first_optic, const int (&optic)[kLanes],
                    optics::RayPacket16& packet) {
  optics::RayPacket16 query = packet;
  for (int round = 0; round <= kMaxOwnHits; ++round) {
    scene.intersect16(query, round < kMaxOwnHits ? optics::kEverything : optics::kSurroundings, true);
    bool again = false;
    for (int i = 0; i < kLanes; ++i) {
      if (query.t_max[i] < query.t_min[i]) continue;  // done before, or never active
      if (query.object[i] != optics::kNoHit && int(query.object[i]) == int(first_optic) + optic[i]) {
        pass(query, i, std::numeric_limits<float>::infinity());
        again = true;
        continue;
      }
      copy_hit(query, i, packet);
      query.t_max[i] = query.t_min[i] - 1;
    }
    if (!again) return;
  }
}

double own_sight_sine(const tessellate::OpticArrays& mesh, double sense) {
  constexpr std::size_t kFrom = 128, kTo = 512;
  constexpr double kFlat = 1e-3;  // sine below which nothing is seen of a surface
  const std::size_t count = mesh.vertices.size();
  const std::size_t from_step = std::max<std::size_t>(1, count / kFrom),
                    to_step = std::max<std::size_t>(1, count / kTo);
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  double largest = 0, curvature = 0;
  for (std::size_t a = 0; a < count; ++a) {
    const tessellate::OpticVertex& p = mesh.vertices[a];
    low = glm::min(low, p.position_mm);
    high = glm::max(high, p.position_mm);
    curvature = std::max(curvature, sense > 0 ? -p.k2 : p.k1);  // of the hollow side
    if (a % from_step != 0) continue;
    for (std::size_t b = 0; b < count; b += to_step) {
      const glm::dvec3 way = mesh.vertices[b].position_mm - p.position_mm;
      const double length = glm::length(way);
      if (length > 0) largest = std::max(largest, sense * glm::dot(way, p.normal) / length);
    }
  }
  // An arc's chord rises by half of its turn: the same for hollows between the vertices taken, which lie
  // about 1/16 of the optic apart.
  if (count > 0) largest = std::max(largest, std::min(0.05, 0.5 * curvature * glm::length(high - low) / 16));
  constexpr double kShare = 1.25, kMore = 0.02;  // for the same reason
  return largest > kFlat ? kShare * largest + kMore : -1;
}

bool find_own(const OwnSide& own, int optic, optics::LensSide entered, const optics::RayPacket16& rays,
              const bool (&asked)[kLanes], MetOptics& met) {
  optics::RayPacket16 query = rays;
  bool waiting = false, found = false;
  float limit[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    limit[i] = met.optic[i] >= 0 ? std::min(rays.t_max[i], met.distance[i]) : rays.t_max[i];
    query.t_max[i] = asked[i] ? limit[i] : query.t_min[i] - 1;
    waiting |= asked[i];
  }
  for (int round = 0; waiting && round < kMaxOwnHits; ++round) {
    own.scene.intersect16(query, optics::kOptics, true);
    waiting = false;
    for (int i = 0; i < kLanes; ++i) {
      if (query.t_max[i] < query.t_min[i]) continue;
      const bool own_hit = query.object[i] == own.object;
      const bool right_side = own_hit && own.sense * facing(query, i) < 0;
      if (own_hit && !(right_side && is_exact(own, query, i))) {
        pass(query, i, limit[i]);
        waiting = waiting || query.t_max[i] >= query.t_min[i];
        continue;
      }
      if (own_hit) {
        found = true;
        set_met(query, i, optic, entered, met);
      }
      query.t_max[i] = query.t_min[i] - 1;
    }
  }
  return found;
}

}  // namespace catoptra::render
