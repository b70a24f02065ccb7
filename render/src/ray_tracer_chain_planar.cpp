// Both branches of a path at planar glass, and the lit surfaces of planar optics.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/src/ray_tracer_chain.h"
#include "render/src/ray_tracer_chain_query.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = TracedChains::kLanes;

Float4 float4(const glm::vec3& v) {
  return Float4{v.x, v.y, v.z, 0};
}

void copy_end(const ChainEnds& from, int i, ChainEnds& to) {
  to.position[i] = from.position[i];
  to.surface[i] = from.surface[i];
  to.direction[i] = from.direction[i];
  to.normal[i] = from.normal[i];
  to.bounces[i] = from.bounces[i];
  to.path[i] = from.path[i];
}

/// What passes glass from its face at `from` on, of which the lanes show `seen`: fog of the way to what is
/// met next, and tint.
Float4 passed_light(const optics::PlanarMaterial& glass, const ChainLanes& lanes, int i,
                    const glm::dvec3& from, float ambient, const Float4& seen) {
  double way_mm = lanes.next_mm[i];
  if (std::isfinite(way_mm))
    way_mm = glm::length(lanes.beams.point.at(i) + way_mm * lanes.beams.direction.at(i) - from);
  const auto fog = float(optics::fog_share(glass.translucency, way_mm));
  return float4(glass.tint) * ((1 - fog) * seen + fog * ambient * float4(glass.color));
}

}  // namespace

std::size_t TracedChains::pass_glass(const ChainLanes& from, const MetOptics& met, int depth,
                                     Float4 (&radiance)[kLanes], ChainEnds* ends) const {
  int glass[kLanes];
  for (int i = 0; i < kLanes; ++i)
    glass[i] =
        met.optic[i] >= 0 && is_planar_glass(scene_.optics[std::size_t(met.optic[i])]) ? met.optic[i] : -1;
  MetLanes at{}, tilted{};
  planars_.meet(from.beams, glass, at);
  planars_.meet_tilted(from.beams, glass, from.sample, tilted);
  PassedBeams passed;
  planars_.pass(from.beams, at, glass, passed);
  ChainLanes through{}, back{};
  through.sample = back.sample = from.sample;
  through.beams = passed.beams;
  reflect_beams(from.beams, tilted, back.beams);
  bool any_through = false, any_back = false;
  for (int i = 0; i < kLanes; ++i) {
    through.left.optic[i] = back.left.optic[i] = -1;
    if (glass[i] < 0) continue;
    through.wavelength[i] = back.wavelength[i] = from.wavelength[i];
    if (passed.reflected[i] < 1) set_left(from, i, glass[i], optics::LensSide::front, through);
    if (passed.reflected[i] > 0) set_left(from, i, glass[i], optics::LensSide::front, back);
    any_through |= through.left.active[i];
    any_back |= back.left.active[i];
  }
  std::size_t rays = 0;
  Float4 seen_through[kLanes] = {}, seen_back[kLanes] = {};
  ChainEnds reflected;
  if (any_through) {
    load_rays(through);
    rays += leave(through, depth - 1, seen_through, ends);
  }
  if (any_back) {
    load_rays(back);
    rays += leave(back, depth - 1, seen_back, ends ? &reflected : nullptr);
  }
  for (int i = 0; i < kLanes; ++i) {
    if (glass[i] < 0) continue;
    const auto share = float(passed.reflected[i]);
    radiance[i] = Float4{};
    if (back.left.active[i]) radiance[i] += share * seen_back[i];
    if (through.left.active[i])
      radiance[i] += (1 - share) * passed_light(scene_.optics[std::size_t(glass[i])].material, through, i,
                                                at.point.at(i), scene_.environment.ambient, seen_through[i]);
    if (ends && !through.left.active[i]) copy_end(reflected, i, *ends);
  }
  return rays;
}

void TracedChains::add_surfaces(const ChainLanes& from, const MetOptics& met,
                                Float4 (&radiance)[kLanes]) const {
  const auto first_optic = static_cast<std::uint32_t>(scene_.surroundings.size());
  ShadeLanes shade;
  int lit[kLanes];
  bool any = false;
  for (int i = 0; i < kLanes; ++i) {
    const bool here =
        met.optic[i] >= 0 && scene_.optics[std::size_t(met.optic[i])].material.material_alpha > 0;
    lit[i] = here ? met.optic[i] : -1;
    any |= here;
  }
  if (!any) return;
  MetLanes at{};
  planars_.meet(from.beams, lit, at);
  float way_mm[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    shade.active[i] = shade.own_color[i] = lit[i] >= 0;
    const glm::vec3 position(at.point.at(i)), normal(at.normal.at(i)),
        direction = shade.active[i] ? glm::vec3(from.beams.direction.at(i)) : glm::vec3(1, 0, 0);
    shade.position_x[i] = position.x;
    shade.position_y[i] = position.y;
    shade.position_z[i] = position.z;
    shade.normal_x[i] = normal.x;
    shade.normal_y[i] = normal.y;
    shade.normal_z[i] = normal.z;
    shade.direction_x[i] = direction.x;
    shade.direction_y[i] = direction.y;
    shade.direction_z[i] = direction.z;
    shade.u[i] = shade.active[i] ? met.u[i] : 0;
    shade.v[i] = shade.active[i] ? met.v[i] : 0;
    shade.triangle[i] = shade.active[i] ? met.triangle[i] : 0;
    shade.object[i] = shade.active[i] ? first_optic + std::uint32_t(lit[i]) : optics::kNoHit;
    way_mm[i] = float(at.distance[i]);
  }
  set_areas(from.beams, way_mm, shade.footprint);
  for (int i = 0; i < kLanes; ++i)
    if (!shade.active[i]) shade.footprint[i] = 0;
  shading_.shade(shade);
  for (int i = 0; i < kLanes; ++i) {
    if (!shade.active[i]) continue;
    const auto alpha = float(scene_.optics[std::size_t(lit[i])].material.material_alpha);
    radiance[i] = (1 - alpha) * radiance[i] + alpha * shade.radiance[i];
  }
}

}  // namespace catoptra::render
