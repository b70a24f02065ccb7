#include "render/src/ray_tracer_packet.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "optics/vertex_hits.h"
#include "render/src/lens_rays.h"
#include "render/src/optic_mask.h"
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

/// Whether every pixel of the packet is known to.
bool show_optics_alone(const PixelPacket& pixels, std::span<const std::uint8_t> marks, const Frame& frame) {
  if (marks.empty()) return false;
  for (int i = 0; i < kLanes; ++i)
    if (pixels.active[i] && marks[index_of(pixels, i, frame)] != kOpticPixel) return false;
  return true;
}

/// Where colours come from maps, what these show.
void write_shown(const PixelPacket& pixels, const MapLanes& found, Frame& frame) {
  for (int i = 0; i < kLanes; ++i) {
    if (!pixels.active[i] || !found.found(i)) continue;
    glm::vec4& position = frame.position[index_of(pixels, i, frame)];
    position = glm::vec4(found.shown(i), position.w);
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
      shading_(scene, textures, rays),
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
                           std::uint32_t mask, Packet& p) const {
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
  rays_.intersect16(p.first, mask, true);
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
std::size_t PacketTracer::refract(const PacketView& view, const PixelPacket& pixels, const MapColors* maps,
                                  Packet& p, Frame* geometry) const {
  const auto first_optic = static_cast<std::uint32_t>(scene_.surroundings.size());
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
    MapLanes found;
    if (maps) {
      float half_pixel[kLanes];
      set_half_pixels(out.beams, out.rays, half_pixel);
      int optic[kLanes];
      for (int i = 0; i < kLanes; ++i) optic[i] = out.passed[i] ? p.lens.optic[i] : -1;
      find_in_maps(*maps, out.rays, optic, first_optic, float(optics::kSelfHitDistance_mm), half_pixel,
                   found);
      for (int i = 0; i < kLanes; ++i) {
        out.shade.active[i] = out.passed[i] && !found.found(i);
        p.traced[i] = p.traced[i] || (found.asked[i] && !found.found(i));
      }
    }
    shading_.shade(out.shade);
    for (int i = 0; i < kLanes; ++i)
      if (found.found(i)) out.shade.radiance[i] = found.radiance(i);
    if (sample == 0 && geometry) {
      write_lens_geometry(pixels, p.lens, out, *geometry);
      write_shown(pixels, found, *geometry);
    }
    if (chains_.possible()) rays += follow_lenses(pixels, p, sample, out, sample == 0 ? geometry : nullptr);
    lenses_.add_colors(sample, out, p.lens);
  }
  return rays;
}

/// The mirrored hits that maps know are not shaded.
void PacketTracer::take_mirrored_colors(const CameraRays& camera, const MapColors& maps, Packet& p) const {
  float half_pixel[kLanes];
  set_half_pixels(p.mirror.out, p.second, camera.pixel, p.stretch, half_pixel);
  find_in_maps(maps, p.second, p.optic, static_cast<std::uint32_t>(scene_.surroundings.size()), 0, half_pixel,
               p.found);
  for (int i = 0; i < kLanes; ++i) {
    p.shade.active[i] = p.shade.active[i] && !p.found.found(i);
    p.traced[i] = p.found.asked[i] && !p.found.found(i);
  }
}

/// Leaves the lanes' colours of one sample in p.color, and with `mapped` in p.traced whether an optic shows
/// what its maps do not know.
std::size_t PacketTracer::trace_sample(const PacketView& view, const FrameOptions& options,
                                       const PixelPacket& pixels, int sample, const MappedSample* mapped,
                                       Frame& frame, Packet& p) const {
  const CameraRays& camera = view.camera;
  std::copy(std::begin(pixels.active), std::end(pixels.active), std::begin(p.shade.active));
  std::fill(std::begin(p.traced), std::end(p.traced), false);
  std::fill(std::begin(p.found.answers.found), std::end(p.found.answers.found), 0);
  const glm::dvec2 offset = sample_offset(sample, std::max(1, options.samples));
  const bool all_optics = mapped && show_optics_alone(pixels, mapped->marks, frame);
  primary(view, pixels, offset, all_optics ? optics::kOptics : optics::kEverything, p);
  reflect(camera, p);
  set_hits(camera, p);
  if (mapped && p.any_mirror) take_mirrored_colors(camera, mapped->maps, p);
  shading_.shade(p.shade);
  for (int i = 0; i < kLanes; ++i)
    if (p.found.found(i)) p.shade.radiance[i] = p.found.radiance(i);
  const bool geometry = sample == 0 && options.geometry;
  if (geometry) {
    write_geometry(camera, pixels, p, frame);
    write_shown(pixels, p.found, frame);
  }
  std::size_t rays = 0;
  if (p.any_mirror && chains_.possible())
    rays += follow_mirrors(camera, pixels, p, geometry ? &frame : nullptr);
  if (p.lens.any)
    rays += refract(view, pixels, mapped ? &mapped->maps : nullptr, p, geometry ? &frame : nullptr);
  for (int i = 0; i < kLanes; ++i) {
    const bool mirrored = p.optic[i] >= 0;
    if (p.lens.any && p.lens.optic[i] >= 0) {
      p.color[i] = p.lens.radiance[i];
      ++rays;
      continue;
    }
    p.color[i] = mirrored ? tints_[std::size_t(p.optic[i])] * p.shade.radiance[i] : p.shade.radiance[i];
    rays += pixels.active[i] ? (mirrored ? 2u : 1u) : 0u;
  }
  return rays;
}

std::size_t PacketTracer::trace(const PacketView& view, const FrameOptions& options,
                                const PixelPacket& pixels, Frame& frame) const {
  Packet p;
  const int samples = std::max(1, options.samples);
  Float4 sum[kLanes] = {};
  std::size_t rays = 0;
  for (int sample = 0; sample < samples; ++sample) {
    rays += trace_sample(view, options, pixels, sample, nullptr, frame, p);
    for (int i = 0; i < kLanes; ++i) sum[i] += p.color[i];
  }
  const float share = 1 / float(samples);
  for (int i = 0; i < kLanes; ++i) {
    if (!pixels.active[i]) continue;
    const Float4 c = share * sum[i];
    frame.color[index_of(pixels, i, frame)] = glm::vec4(c[0], c[1], c[2], 1);
  }
  return rays;
}

std::size_t PacketTracer::trace_mapped(const PacketView& view, const FrameOptions& options,
                                       const PixelPacket& pixels, const MappedSample& mapped,
                                       Frame& frame) const {
  Packet p;
  const std::size_t rays = trace_sample(view, options, pixels, 0, &mapped, frame, p);
  const float share = 1 / float(std::max(1, options.samples));
  for (int i = 0; i < kLanes; ++i) {
    if (!pixels.active[i]) continue;
    const std::size_t at = index_of(pixels, i, frame);
    const Float4 c = share * p.color[i];
    frame.color[at] += glm::vec4(c[0], c[1], c[2], 0);
    if (p.traced[i]) mapped.traced[at] = 1;
    const bool through_lens = p.lens.any && p.lens.optic[i] >= 0;
    if (through_lens || p.optic[i] >= 0) mapped.owner[at] = through_lens ? p.lens.optic[i] : p.optic[i];
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

std::vector<SecondaryPacket> PacketTracer::secondary_rays(const PacketView& view,
                                                          const PixelPacket& pixels) const {
  std::vector<SecondaryPacket> result;
  Packet p;
  primary(view, pixels, {0, 0}, optics::kEverything, p);
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
  primary(view, pixels, {0, 0}, optics::kEverything, p);
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
