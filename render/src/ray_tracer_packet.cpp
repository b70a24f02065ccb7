#include "render/src/ray_tracer_packet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "optics/vertex_hits.h"
#include "render/src/lens_rays.h"
#include "render/src/ray_tracer_chain_query.h"
#include "render/src/ray_tracer_packet_lanes.h"
#include "render/src/shading_vector_clones.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = PixelPacket::kLanes;
static_assert(kLanes == ShadeLanes::kLanes && kLanes == MirrorLanes::kLanes);

/// Eye rays in double precision, unit. `stretch`: how much longer they are along the camera's axis; on entry
/// `mirror.start` is a depth, on return a distance.
CATOPTRA_VECTOR_CLONES void aim_mirror_rays(const CameraRays& camera, const double (&column)[kLanes],
                                            const double (&row)[kLanes], double (&stretch)[kLanes],
                                            MirrorLanes& mirror) {
  const glm::dvec3 corner = camera.corner, dx = camera.dx, dy = camera.dy;
  for (int i = 0; i < kLanes; ++i) {
    const double x = corner.x + column[i] * dx.x + row[i] * dy.x,
                 y = corner.y + column[i] * dx.y + row[i] * dy.y;
    const double z = corner.z + column[i] * dx.z + row[i] * dy.z, length = std::sqrt(x * x + y * y + z * z);
    stretch[i] = length;
    mirror.direction_x[i] = x / length;
    mirror.direction_y[i] = y / length;
    mirror.direction_z[i] = z / length;
    mirror.start[i] *= length;
  }
}

/// Of the triangle that lane `i` has met; anything where it has met none.
glm::vec3 unit_normal(const optics::RayPacket16& hits, int i) {
  return glm::normalize(glm::vec3(hits.normal_x[i], hits.normal_y[i], hits.normal_z[i]));
}

/// Where its light does not pass, a lens counts as a body like any other.
void write_lens_geometry(const PixelPacket& pixels, const LensLanes& lanes, const RefractedLanes& out,
                         Frame& frame) {
  for (int i = 0; i < kLanes; ++i) {
    if (!pixels.active[i] || lanes.optic[i] < 0) continue;
    const std::size_t at = index_of(pixels, i, frame);
    const bool passed = out.passed[i];
    const glm::dvec3 exit = out.beams.point.at(i), direction = out.beams.direction.at(i);
    const double way = optics::kSelfHitDistance_mm + double(out.rays.t_max[i]);
    frame.position[at] = !passed ? glm::vec4(glm::vec3(lanes.entry.point.at(i)), 1)
                         : out.rays.object[i] == optics::kNoHit
                             ? glm::vec4(glm::vec3(direction), 0)
                             : glm::vec4(glm::vec3(exit + way * direction), 1);
    frame.surface[at] = passed ? glm::vec3(exit) : glm::vec3(0);
    frame.direction[at] = passed ? glm::vec3(direction) : glm::vec3(0);
    frame.optic_id[at] = passed ? lanes.optic[i] : -1;
    frame.bounces[at] = passed ? 1 : 0;
    frame.path[at] = passed ? path_after(0, lanes.optic[i]) : 0;
  }
}

SecondaryPacket secondary_packet(const optics::RayPacket16& rays, bool others) {
  SecondaryPacket packet;
  std::copy_n(rays.origin_x, kLanes, packet.origin_x);
  std::copy_n(rays.origin_y, kLanes, packet.origin_y);
  std::copy_n(rays.origin_z, kLanes, packet.origin_z);
  std::copy_n(rays.direction_x, kLanes, packet.direction_x);
  std::copy_n(rays.direction_y, kLanes, packet.direction_y);
  std::copy_n(rays.direction_z, kLanes, packet.direction_z);
  std::copy_n(rays.t_max, kLanes, packet.t_max);
  packet.others = others;
  return packet;
}

}  // namespace

PacketTracer::PacketTracer(const Scene& scene, const SceneTextures& textures, const optics::RayScene& rays)
    : scene_(scene),
      rays_(rays),
      shading_(scene, textures),
      lenses_(scene),
      chains_(scene, rays, shading_, lenses_) {
  for (const optics::Optic& optic : scene.optics) {
    const bool mirror = optic.kind == optics::OpticKind::mirror;
    mirrors_.push_back(mirror ? std::make_unique<ExactMirror>(optic) : nullptr);
    tints_.push_back(Float4{optic.reflectance.r, optic.reflectance.g, optic.reflectance.b, 1});
  }
}

void PacketTracer::optic_changed(std::size_t index) {
  shading_.optic_changed(index);
  if (mirrors_[index]) mirrors_[index] = std::make_unique<ExactMirror>(scene_.optics[index]);
  lenses_.optic_changed(index);
  chains_.optic_changed(index);
}

/// Lanes that a lens stands before the nearest hit of keep none: refract() gives them their colour.
void PacketTracer::primary(const PacketView& view, const PixelPacket& pixels, glm::dvec2 offset,
                           Packet& p) const {
  const CameraRays& camera = view.camera;
  const glm::vec3 corner(camera.corner + offset.x * camera.dx + offset.y * camera.dy), dx(camera.dx),
      dy(camera.dy);
  const glm::vec3 eye(camera.eye_mm);
  for (int i = 0; i < kLanes; ++i) {
    const auto column = float(pixels.column[i]), row = float(pixels.row[i]);
    p.first.origin_x[i] = eye.x;
    p.first.origin_y[i] = eye.y;
    p.first.origin_z[i] = eye.z;
    p.first.direction_x[i] = corner.x + column * dx.x + row * dy.x;
    p.first.direction_y[i] = corner.y + column * dx.y + row * dy.y;
    p.first.direction_z[i] = corner.z + column * dx.z + row * dy.z;
    p.first.t_min[i] = 0;
    p.first.t_max[i] = pixels.active[i] ? std::numeric_limits<float>::infinity() : -1.0f;
    p.column[i] = pixels.column[i] + offset.x;
    p.row[i] = pixels.row[i] + offset.y;
  }
  rays_.intersect16(p.first, optics::kEverything, true);
  lenses_.find(view.entered, p.first, p.lens);
}

/// Finds the lanes that show a reflecting side. Returns whether there are any.
bool PacketTracer::find_mirrors(Packet& p) const {
  const auto first_optic = static_cast<std::uint32_t>(scene_.surroundings.size());
  p.any_mirror = false;
  for (int i = 0; i < kLanes; ++i) {
    p.optic[i] = -1;
    const std::uint32_t object = p.first.object[i];
    if (object == optics::kNoHit || object < first_optic) continue;
    const float facing = p.first.normal_x[i] * p.first.direction_x[i] +
                         p.first.normal_y[i] * p.first.direction_y[i] +
                         p.first.normal_z[i] * p.first.direction_z[i];
    const int optic = int(object - first_optic);
    if ((facing < 0) == scene_.optics[std::size_t(optic)].flip) continue;
    p.optic[i] = optic;
    p.any_mirror = true;
    p.mirror.triangle[i] = p.first.triangle[i];
    p.mirror.u[i] = p.first.u[i];
    p.mirror.v[i] = p.first.v[i];
  }
  return p.any_mirror;
}

/// Hits and reflects exactly where a mirror shows, and queries the reflected rays.
void PacketTracer::reflect(const CameraRays& camera, Packet& p) const {
  if (!find_mirrors(p)) return;
  for (int i = 0; i < kLanes; ++i) p.mirror.start[i] = p.optic[i] >= 0 ? p.first.t_max[i] : 1.0;
  aim_mirror_rays(camera, p.column, p.row, p.stretch, p.mirror);
  for (std::size_t optic = 0; optic < mirrors_.size(); ++optic) {
    bool any = false;
    for (int i = 0; i < kLanes; ++i) any |= p.mirror.active[i] = p.optic[i] == int(optic);
    if (any) mirrors_[optic]->reflect(camera.eye_mm, p.mirror);
  }
  load_reflected(p);
  if (scene_.optics.size() > 1)
    query_past_own(rays_, static_cast<std::uint32_t>(scene_.surroundings.size()), p.optic, p.second);
  else
    rays_.intersect16(p.second, optics::kSurroundings, true);
}

void PacketTracer::load_reflected(Packet& p) {
  const MirrorRays& rays = p.mirror.out;
  for (int i = 0; i < kLanes; ++i) {
    const bool active = p.optic[i] >= 0;
    p.second.origin_x[i] = active ? float(rays.surface_x[i]) : 0;
    p.second.origin_y[i] = active ? float(rays.surface_y[i]) : 0;
    p.second.origin_z[i] = active ? float(rays.surface_z[i]) : 0;
    p.second.direction_x[i] = active ? float(rays.reflected_x[i]) : 1;
    p.second.direction_y[i] = active ? float(rays.reflected_y[i]) : 1;
    p.second.direction_z[i] = active ? float(rays.reflected_z[i]) : 1;
    p.second.t_min[i] = 0;
    p.second.t_max[i] = active ? std::numeric_limits<float>::infinity() : -1.0f;
  }
}

/// Hands each lane's last hit and the size of its pixel there to shading.
void PacketTracer::set_hits(const CameraRays& camera, Packet& p) const {
  const auto pixel_area = float(camera.pixel * camera.pixel);
  const optics::RayPacket16 &a = p.first, &b = p.second;
  if (!p.any_mirror) {
    for (int i = 0; i < kLanes; ++i) p.shade.footprint[i] = pixel_area * a.t_max[i] * a.t_max[i];
    copy_hits(a, p.shade);
    return;
  }
  bool all = true;
  for (int i = 0; i < kLanes; ++i) {
    const bool mirrored = p.optic[i] >= 0;
    all = all && mirrored;
    const double depth = p.mirror.out.distance[i] / p.stretch[i], s = b.t_max[i];
    const double spread = std::abs(1 + s * (p.mirror.out.wave_sum[i] + s * p.mirror.out.wave_product[i]));
    p.shade.footprint[i] = mirrored
                               ? float(camera.pixel * camera.pixel * depth * depth / p.stretch[i] * spread)
                               : pixel_area * a.t_max[i] * a.t_max[i];
  }
  if (all) {
    copy_hits(b, p.shade);
    return;
  }
  optics::RayPacket16 last = a;
  for (int i = 0; i < kLanes; ++i)
    if (p.optic[i] >= 0) copy_hit(b, i, last);
  copy_hits(last, p.shade);
}

/// Colours (and where asked for, geometry) of the lanes that show lenses: the sum over the wavelengths of
/// what their rays meet. Returns the number of rays behind the lenses.
std::size_t PacketTracer::refract(const PacketView& view, const PixelPacket& pixels, Packet& p,
                                  Frame* geometry) const {
  std::size_t rays = 0;
  lenses_.enter(view.camera, p.column, p.row, p.lens);
  std::fill(std::begin(p.lens.radiance), std::end(p.lens.radiance), Float4{});
  for (std::size_t sample = 0; sample < lenses_.sample_count(p.lens); ++sample) {
    RefractedLanes out;
    lenses_.refract(p.lens, sample, out);
    rays_.intersect16(out.rays, optics::kEverything, true);
    copy_hits(out.rays, out.shade);
    set_areas(out.beams, out.rays.t_max, out.shade.footprint);
    for (int i = 0; i < kLanes; ++i) {
      out.shade.active[i] = out.passed[i];
      if (!out.passed[i]) out.shade.footprint[i] = 0;
      rays += out.passed[i] ? 1 : 0;
    }
    shading_.shade(out.shade);
    if (sample == 0 && geometry) write_lens_geometry(pixels, p.lens, out, *geometry);
    if (chains_.possible()) {
      const GeometrySink sink{sample == 0 ? geometry : nullptr, nullptr};
      rays += follow_lenses(pixels, p, sample, {}, out, sink);
    }
    lenses_.add_colors(sample, out, p.lens);
  }
  return rays;
}

std::size_t PacketTracer::trace(const PacketView& view, const FrameOptions& options,
                                const PixelPacket& pixels, Frame& frame) const {
  const CameraRays& camera = view.camera;
  Packet p;
  std::copy(std::begin(pixels.active), std::end(pixels.active), std::begin(p.shade.active));
  const int samples = std::max(1, options.samples);
  Float4 sum[kLanes] = {};
  std::size_t rays = 0;
  for (int sample = 0; sample < samples; ++sample) {
    primary(view, pixels, sample_offset(sample, samples), p);
    reflect(camera, p);
    set_hits(camera, p);
    shading_.shade(p.shade);
    const bool geometry = sample == 0 && options.geometry;
    if (geometry) write_geometry(camera, pixels, p, frame);
    if (p.any_mirror && chains_.possible())
      rays += follow_mirrors(camera, pixels, p, {}, {geometry ? &frame : nullptr, nullptr});
    if (p.lens.any) rays += refract(view, pixels, p, geometry ? &frame : nullptr);
    for (int i = 0; i < kLanes; ++i) {
      const bool mirrored = p.optic[i] >= 0;
      if (p.lens.any && p.lens.optic[i] >= 0) {
        sum[i] += p.lens.radiance[i];
        ++rays;
        continue;
      }
      sum[i] += mirrored ? tints_[std::size_t(p.optic[i])] * p.shade.radiance[i] : p.shade.radiance[i];
      rays += pixels.active[i] ? (mirrored ? 2u : 1u) : 0u;
    }
  }
  const float share = 1 / float(samples);
  for (int i = 0; i < kLanes; ++i) {
    if (!pixels.active[i]) continue;
    const Float4 c = share * sum[i];
    frame.color[std::size_t(pixels.row[i]) * std::size_t(frame.width) + std::size_t(pixels.column[i])] =
        glm::vec4(c[0], c[1], c[2], 1);
  }
  return rays;
}

void PacketTracer::write_geometry(const CameraRays& camera, const PixelPacket& pixels, const Packet& p,
                                  Frame& frame) const {
  for (int i = 0; i < kLanes; ++i) {
    if (!pixels.active[i]) continue;
    const std::size_t at = index_of(pixels, i, frame);
    const bool mirrored = p.optic[i] >= 0;
    const optics::RayPacket16& last = mirrored ? p.second : p.first;
    glm::dvec3 origin = camera.eye_mm, direction = camera.direction(p.column[i], p.row[i]);
    if (mirrored) {
      origin = {p.mirror.out.surface_x[i], p.mirror.out.surface_y[i], p.mirror.out.surface_z[i]};
      direction = {p.mirror.out.reflected_x[i], p.mirror.out.reflected_y[i], p.mirror.out.reflected_z[i]};
    }
    const bool sky = last.object[i] == optics::kNoHit;
    frame.position[at] = sky ? glm::vec4(glm::vec3(glm::normalize(direction)), 0)
                             : glm::vec4(glm::vec3(origin + double(last.t_max[i]) * direction), 1);
    frame.surface[at] = mirrored ? glm::vec3(origin) : glm::vec3(0);
    frame.direction[at] = mirrored ? glm::vec3(direction) : glm::vec3(0);
    frame.optic_id[at] = p.optic[i];
    frame.bounces[at] = mirrored ? 1 : 0;
    frame.path[at] = mirrored ? path_after(0, p.optic[i]) : 0;
  }
}

std::size_t PacketTracer::trace_exact(const PacketView& view, glm::dvec2 offset_px, std::size_t extreme,
                                      const PixelPacket& pixels, ExactPixels& exact) const {
  Packet p;
  primary(view, pixels, offset_px, p);
  reflect(view.camera, p);
  std::size_t rays = 0;
  PixelPacket mirrored = pixels;
  for (int i = 0; i < kLanes; ++i) {
    rays += pixels.active[i] ? (p.optic[i] >= 0 ? 2u : 1u) : 0u;
    mirrored.active[i] = pixels.active[i] && p.optic[i] >= 0;
    if (mirrored.active[i]) exact.normal[index_of(pixels, i, exact.frame)] = unit_normal(p.second, i);
  }
  if (p.any_mirror) {
    write_geometry(view.camera, mirrored, p, exact.frame);
    if (chains_.possible())
      rays += follow_mirrors(view.camera, pixels, p, {false, extreme}, {&exact.frame, &exact.normal});
  }
  return p.lens.any ? rays + refract_exact(view, extreme, pixels, p, exact) : rays;
}

std::size_t PacketTracer::refract_exact(const PacketView& view, std::size_t extreme,
                                        const PixelPacket& pixels, Packet& p, ExactPixels& exact) const {
  std::size_t rays = 0;
  std::array<std::size_t, kLanes> sample{};  // lenses differ in their number of wavelengths
  for (int i = 0; i < kLanes; ++i)
    if (p.lens.optic[i] >= 0)
      sample[std::size_t(i)] = extreme_sample(lenses_.sample_count_of(std::size_t(p.lens.optic[i])), extreme);
  lenses_.enter(view.camera, p.column, p.row, p.lens);
  PixelPacket waiting = pixels;
  for (int i = 0; i < kLanes; ++i) waiting.active[i] = pixels.active[i] && p.lens.optic[i] >= 0;
  for (int first = 0; first < kLanes; ++first) {
    if (!waiting.active[first]) continue;
    PixelPacket now = waiting;
    for (int i = 0; i < kLanes; ++i) {
      now.active[i] = waiting.active[i] && sample[std::size_t(i)] == sample[std::size_t(first)];
      if (now.active[i]) waiting.active[i] = false;
    }
    RefractedLanes out;
    lenses_.refract(p.lens, sample[std::size_t(first)], out);
    rays_.intersect16(out.rays, optics::kEverything, true);
    write_lens_geometry(now, p.lens, out, exact.frame);
    for (int i = 0; i < kLanes; ++i) {
      if (!now.active[i] || !out.passed[i]) continue;
      exact.normal[index_of(pixels, i, exact.frame)] = unit_normal(out.rays, i);
      ++rays;
    }
    if (chains_.possible())
      rays += follow_lenses(now, p, sample[std::size_t(first)], {false, extreme}, out,
                            {&exact.frame, &exact.normal});
  }
  return rays;
}

std::vector<SecondaryPacket> PacketTracer::secondary_rays(const PacketView& view,
                                                          const PixelPacket& pixels) const {
  std::vector<SecondaryPacket> result;
  Packet p;
  primary(view, pixels, {0, 0}, p);
  reflect(view.camera, p);
  lenses_.enter(view.camera, p.column, p.row, p.lens);
  if (p.any_mirror) result.push_back(secondary_packet(p.second, scene_.optics.size() > 1));
  for (std::size_t sample = 0; sample < lenses_.sample_count(p.lens); ++sample) {
    RefractedLanes out;
    lenses_.refract(p.lens, sample, out);
    result.push_back(secondary_packet(out.rays, true));
  }
  return result;
}

void PacketTracer::query_primary(const PacketView& view, const PixelPacket& pixels) const {
  Packet p;
  primary(view, pixels, {0, 0}, p);
}

void PacketTracer::query_secondary(const SecondaryPacket& secondary) const {
  optics::RayPacket16 packet;
  for (int i = 0; i < kLanes; ++i) {
    packet.origin_x[i] = secondary.origin_x[i];
    packet.origin_y[i] = secondary.origin_y[i];
    packet.origin_z[i] = secondary.origin_z[i];
    packet.direction_x[i] = secondary.direction_x[i];
    packet.direction_y[i] = secondary.direction_y[i];
    packet.direction_z[i] = secondary.direction_z[i];
    packet.t_min[i] = 0;
    packet.t_max[i] = secondary.t_max[i];
  }
  rays_.intersect16(packet, secondary.others ? optics::kEverything : optics::kSurroundings, true);
}

}  // namespace catoptra::render
