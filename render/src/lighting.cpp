#include "render/src/lighting.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace catoptra::render {
namespace {

using optics::side_of;
using optics::towards;

constexpr int kLanes = LitLanes::kLanes;
constexpr float kUnitDistance2_mm2 = 1e6f;  // intensity is the irradiance at 1 m

/// Each lane's irradiance of a light of unit power by Lambert's cosine law; 0 where it is turned away.
void set_shares(const optics::LightPlace& place, const LitLanes& lanes, float (&share)[kLanes]) {
  const glm::vec3 p(place);
  if (place.w == 0) {
    for (int i = 0; i < kLanes; ++i)
      share[i] = std::max(0.0f, lanes.nx[i] * p.x + lanes.ny[i] * p.y + lanes.nz[i] * p.z);
    return;
  }
  for (int i = 0; i < kLanes; ++i) {
    const float x = p.x - lanes.x[i], y = p.y - lanes.y[i], z = p.z - lanes.z[i];
    const float squared = std::max(1e-6f, x * x + y * y + z * z);
    const float cosine =
        std::max(0.0f, (lanes.nx[i] * x + lanes.ny[i] * y + lanes.nz[i] * z) / std::sqrt(squared));
    share[i] = cosine * (kUnitDistance2_mm2 / squared);
  }
}

void add_shares(const glm::vec3& power, const float (&share)[kLanes], LitLanes& lanes) {
  for (int i = 0; i < kLanes; ++i) {
    lanes.red[i] += power.r * share[i];
    lanes.green[i] += power.g * share[i];
    lanes.blue[i] += power.b * share[i];
  }
}

void set_idle(optics::ShadowPacket16& packet, int i) {
  packet.origin_x[i] = packet.origin_y[i] = packet.origin_z[i] = 0;
  packet.direction_x[i] = packet.direction_y[i] = packet.direction_z[i] = 1;
  packet.t_min[i] = 0;
  packet.t_max[i] = -1;
}

/// From `from` along `way`, as far as that goes or without end.
void set_ray(optics::ShadowPacket16& packet, int i, const glm::dvec3& from, const glm::dvec3& way,
             bool endless) {
  packet.origin_x[i] = float(from.x);
  packet.origin_y[i] = float(from.y);
  packet.origin_z[i] = float(from.z);
  packet.direction_x[i] = float(way.x);
  packet.direction_y[i] = float(way.y);
  packet.direction_z[i] = float(way.z);
  packet.t_min[i] = 0;
  packet.t_max[i] = endless ? std::numeric_limits<float>::infinity() : 1.0f;
}

/// The point moved off its surface to the side of `way`.
glm::dvec3 moved(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& way, double margin) {
  return point + (glm::dot(normal, way) < 0 ? -margin : margin) * normal;
}

/// Light on its way from a point back to the source.
struct Way {
  bool lit[kLanes];
  glm::dvec3 point[kLanes];   ///< where it has come to
  glm::dvec3 normal[kLanes];  ///< of the surface there
  double margin[kLanes];
  glm::dvec3 share[kLanes];
};

/// Starts the way at the lanes that the light may reach, as far as its volume and their normals tell. Returns
/// whether there are any.
bool start_way(const optics::VirtualLight& light, const std::vector<std::vector<glm::dvec4>>& volumes,
               const float (&share)[kLanes], const LitLanes& lanes, Way& way) {
  bool any = false;
  for (int i = 0; i < kLanes; ++i) {
    way.lit[i] = lanes.lit[i] && share[i] > 0 && side_of(light.lit_side, lanes.start[i]) > lanes.margin[i] &&
                 std::ranges::any_of(volumes, [&](const std::vector<glm::dvec4>& planes) {
                   return std::ranges::all_of(
                       planes, [&](const glm::dvec4& plane) { return side_of(plane, lanes.start[i]) >= 0; });
                 });
    if (!way.lit[i]) continue;
    any = true;
    way.point[i] = lanes.start[i];
    way.normal[i] = lanes.flat_normal[i];
    way.margin[i] = lanes.margin[i];
    way.share[i] = glm::dvec3(share[i] * light.gain);
  }
  return any;
}

/// Takes away the light of lanes whose rays are blocked. Returns whether any is left.
bool ask(const optics::RayScene& rays, optics::ShadowPacket16& packet, Way& way) {
  const std::uint32_t blocked = rays.occluded16(packet, optics::kCasters, true);
  bool any = false;
  for (int i = 0; i < kLanes; ++i) {
    if (blocked >> i & 1u) way.lit[i] = false;
    any = any || way.lit[i];
  }
  return any;
}

/// Steps back over the light's face: asks whether the way there is free, and takes the face's share.
bool step_back(const optics::RayScene& rays, const optics::LightFace& face, double margin,
               const optics::VirtualLight& light, const optics::LightPlace& before, Way& way) {
  const glm::dvec3 lit_normal(light.lit_side);
  optics::ShadowPacket16 packet;
  for (int i = 0; i < kLanes; ++i) {
    set_idle(packet, i);
    if (!way.lit[i]) continue;
    const glm::dvec3 to_light = towards(light.place, way.point[i]);
    const glm::dvec3 q = optics::crossing(light.lit_side, light.place, way.point[i]);
    const glm::dvec3 from = moved(way.point[i], way.normal[i], to_light, way.margin[i]);
    set_ray(packet, i, from, q + margin * lit_normal - from, false);
    const double cosine = std::abs(glm::dot(face.normal, glm::normalize(towards(before, q))));
    way.point[i] = q;
    way.normal[i] = face.normal;
    way.margin[i] = margin;
    way.share[i] *= optics::face_share(face, light, cosine);
  }
  return ask(rays, packet, way);
}

/// Whether the light itself is seen from where the way has come to.
bool reach_source(const optics::RayScene& rays, const optics::LightPlace& place, Way& way) {
  optics::ShadowPacket16 packet;
  for (int i = 0; i < kLanes; ++i) {
    set_idle(packet, i);
    if (!way.lit[i]) continue;
    const glm::dvec3 from = moved(way.point[i], way.normal[i], towards(place, way.point[i]), way.margin[i]);
    set_ray(packet, i, from, towards(place, from), place.w == 0);
  }
  return ask(rays, packet, way);
}

double largest_coordinate(const optics::LightFace& face) {
  double largest = 0;
  for (const auto& piece : face.pieces)
    for (const glm::dvec3& p : piece)
      largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return largest;
}

}  // namespace

Lighting::Lighting(const Scene& scene, const optics::RayScene& rays) : rays_(rays) {
  set_lights(scene);
}

void Lighting::optic_changed(const Scene& scene) {
  set_lights(scene);
}

void Lighting::set_lights(const Scene& scene) {
  SceneLights lights = scene_lights(scene);
  faces_ = std::move(lights.faces);
  face_margins_.clear();
  for (const optics::LightFace& face : faces_)
    face_margins_.push_back(shadow_margin_mm(largest_coordinate(face)));
  sources_.clear();
  any_shadows_ = false;
  for (LightPoint& point : lights.points) {
    Source& source = sources_.emplace_back(point.place, point.power, point.shadows);
    any_shadows_ = any_shadows_ || point.shadows;
    for (optics::VirtualLight& light : point.virtual_lights) {
      Virtual& packed = source.virtual_lights.emplace_back();
      for (const auto& piece : light.aperture) packed.volumes.push_back(optics::light_volume(light, piece));
      packed.light = std::move(light);
    }
  }
}

/// Takes away the share of lanes from which the light is not seen.
void Lighting::hide(const Source& source, const LitLanes& lanes, float (&share)[kLanes]) const {
  optics::ShadowPacket16 packet;
  bool any = false;
  for (int i = 0; i < kLanes; ++i) {
    set_idle(packet, i);
    if (!lanes.lit[i] || share[i] <= 0) continue;
    any = true;
    const glm::dvec3 from =
        moved(lanes.start[i], lanes.flat_normal[i], towards(source.place, lanes.start[i]), lanes.margin[i]);
    set_ray(packet, i, from, towards(source.place, from), source.place.w == 0);
  }
  if (!any) return;
  const std::uint32_t blocked = rays_.occluded16(packet, optics::kCasters, true);
  for (int i = 0; i < kLanes; ++i)
    if (blocked >> i & 1u) share[i] = 0;
}

void Lighting::add_virtual(const Source& source, std::size_t index, LitLanes& lanes) const {
  const Virtual& last = source.virtual_lights[index];
  float share[kLanes];
  set_shares(last.light.place, lanes, share);
  Way way;
  if (!start_way(last.light, last.volumes, share, lanes, way)) return;
  for (int i = int(index); i >= 0;) {
    const optics::VirtualLight& light = source.virtual_lights[std::size_t(i)].light;
    const optics::LightPlace& before =
        light.before < 0 ? source.place : source.virtual_lights[std::size_t(light.before)].light.place;
    if (!step_back(rays_, faces_[light.face], face_margins_[light.face], light, before, way)) return;
    i = light.before;
  }
  if (!reach_source(rays_, source.place, way)) return;
  for (int i = 0; i < kLanes; ++i) {
    if (!way.lit[i]) continue;
    lanes.red[i] += source.power.r * float(way.share[i].r);
    lanes.green[i] += source.power.g * float(way.share[i].g);
    lanes.blue[i] += source.power.b * float(way.share[i].b);
  }
}

void Lighting::add(LitLanes& lanes) const {
  for (const Source& source : sources_) {
    float share[kLanes];
    set_shares(source.place, lanes, share);
    if (source.shadows) hide(source, lanes, share);
    add_shares(source.power, share, lanes);
    for (std::size_t i = 0; i < source.virtual_lights.size(); ++i) add_virtual(source, i, lanes);
  }
}

}  // namespace catoptra::render
