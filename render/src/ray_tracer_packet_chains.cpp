// How a packet's rays go on from the first optic to the next.
#include <algorithm>
#include <glm/geometric.hpp>

#include "optics/vertex_hits.h"
#include "render/src/ray_tracer_packet_lanes.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = PixelPacket::kLanes;

/// The first optic of each lane that is followed.
void set_first(const LeftOptics& left, ChainLanes& from) {
  from.left = left;
  for (int i = 0; i < kLanes; ++i) {
    from.bounces[i] = 1;
    from.path[i] = path_after(0, left.optic[i]);
    from.wavelength[i] = -1;
  }
}

}  // namespace

std::size_t PacketTracer::follow_mirrors(const CameraRays& camera, const PixelPacket& pixels, Packet& p,
                                         Frame* geometry) const {
  LeftOptics left;
  const MirrorLanes& mirror = p.mirror;
  for (int i = 0; i < kLanes; ++i) {
    left.active[i] = pixels.active[i] && p.optic[i] >= 0;
    left.optic[i] = left.active[i] ? p.optic[i] : -1;
    if (!left.active[i]) continue;
    left.side[i] = optics::LensSide::front;
    // r - d = 2 cos n.
    const glm::dvec3 d(mirror.direction_x[i], mirror.direction_y[i], mirror.direction_z[i]),
        r(mirror.out.reflected_x[i], mirror.out.reflected_y[i], mirror.out.reflected_z[i]);
    left.sees_own[i] = chains_.sees_own(std::size_t(left.optic[i]), 0.5 * glm::length(r - d));
  }
  MetOptics met;
  if (!chains_.find_next(p.second, left, met)) return 0;
  // The beams with all their differentials, which few packets need.
  ChainLanes from;
  set_first(left, from);
  from.sample = p.sample;
  from.rays = p.second;
  BeamLanes eye;
  double stretch[kLanes];
  aim_beams(camera, p.column, p.row, stretch, eye);
  MetOptics first;
  for (int i = 0; i < kLanes; ++i) {
    first.optic[i] = met.optic[i] >= 0 ? left.optic[i] : -1;
    first.distance[i] = float(mirror.out.distance[i]);
    first.u[i] = mirror.u[i];
    first.v[i] = mirror.v[i];
    first.triangle[i] = mirror.triangle[i];
  }
  MetLanes at;
  chains_.meet_mirrors(eye, first, at);
  reflect_beams(eye, at, from.beams);
  return follow(pixels, from, met, p.shade, p.traced, geometry);
}

std::size_t PacketTracer::follow_lenses(const PixelPacket& pixels, Packet& p, std::size_t sample,
                                        RefractedLanes& out, Frame* geometry) const {
  LeftOptics left;
  for (int i = 0; i < kLanes; ++i) {
    left.active[i] = pixels.active[i] && out.passed[i];
    left.optic[i] = left.active[i] ? p.lens.optic[i] : -1;
    if (!left.active[i]) continue;
    left.side[i] = optics::other_side(p.lens.entered[i]);
    left.sees_own[i] = lenses_.sees_own(std::size_t(left.optic[i]), left.side[i],
                                        glm::dot(out.beams.direction.at(i), out.exit.normal.at(i)));
  }
  MetOptics met;
  if (!chains_.find_next(out.rays, left, met)) return 0;
  ChainLanes from;
  set_first(left, from);
  from.sample = p.sample;
  from.beams = out.beams;
  from.rays = out.rays;
  from.offset_mm = optics::kSelfHitDistance_mm;
  for (int i = 0; i < kLanes; ++i)
    if (left.active[i]) from.wavelength[i] = lenses_.wavelength(std::size_t(left.optic[i]), sample);
  return follow(pixels, from, met, out.shade, p.traced, geometry);
}

std::size_t PacketTracer::follow_planars(const CameraRays& camera, const PixelPacket& pixels, Packet& p,
                                         Frame* geometry) const {
  ChainLanes from{};
  from.sample = p.sample;
  double stretch[kLanes];
  aim_beams(camera, p.column, p.row, stretch, from.beams);
  MetOptics met = p.planar;
  for (int i = 0; i < kLanes; ++i) {
    from.left.optic[i] = from.wavelength[i] = -1;
    if (met.optic[i] >= 0) met.distance[i] = float(stretch[i] * double(met.distance[i]));
  }
  ChainEnds ends;
  const std::size_t rays = chains_.follow(from, met, chains_.depth(), p.color, geometry ? &ends : nullptr);
  for (int i = 0; i < kLanes; ++i) {
    if (met.optic[i] < 0) continue;
    p.traced[i] = true;
    if (geometry) geometry->optic_id[index_of(pixels, i, *geometry)] = met.optic[i];
  }
  if (geometry) write_ends(pixels, met, ends, *geometry);
  return rays;
}

std::size_t PacketTracer::follow(const PixelPacket& pixels, const ChainLanes& from, const MetOptics& met,
                                 ShadeLanes& shade, bool (&traced)[PixelPacket::kLanes],
                                 Frame* geometry) const {
  Float4 seen[kLanes];
  ChainEnds ends;
  const std::size_t rays = chains_.follow(from, met, chains_.depth() - 1, seen, geometry ? &ends : nullptr);
  for (int i = 0; i < kLanes; ++i)
    if (met.optic[i] >= 0) {
      shade.radiance[i] = seen[i];
      traced[i] = true;
    }
  if (geometry) write_ends(pixels, met, ends, *geometry);
  return rays;
}

void PacketTracer::write_ends(const PixelPacket& pixels, const MetOptics& met, const ChainEnds& ends,
                              Frame& frame) {
  for (int i = 0; i < kLanes; ++i) {
    if (!pixels.active[i] || met.optic[i] < 0) continue;
    const std::size_t at = index_of(pixels, i, frame);
    frame.position[at] = ends.position[i];
    frame.surface[at] = ends.surface[i];
    frame.direction[at] = ends.direction[i];
    frame.bounces[at] = ends.bounces[i];
    frame.path[at] = ends.path[i];
  }
}

}  // namespace catoptra::render
