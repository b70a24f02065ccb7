#include "render/src/ray_tracer_chain.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "optics/vertex_hits.h"
#include "render/frame.h"
#include "render/src/lens_rays.h"
#include "render/src/ray_tracer_chain_query.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = TracedChains::kLanes;

optics::LensSideView side_of_mirror(const optics::Optic& mirror) {
  return {mirror.faces, &mirror.mesh};
}

/// Sense of the normals on the side that reflects.
double reflecting_sense(const optics::Optic& mirror) {
  return mirror.flip ? -1 : 1;
}

/// Whether a ray with that product of its direction and the triangle's normal meets a side that does not
/// reflect.
bool is_dark_side(const optics::Optic& mirror, float facing) {
  return !mirror.two_sided && (facing < 0) == mirror.flip;
}

float facing(const optics::RayPacket16& p, int i) {
  return p.normal_x[i] * p.direction_x[i] + p.normal_y[i] * p.direction_y[i] +
         p.normal_z[i] * p.direction_z[i];
}

/// What the lanes show if nothing more happens to them.
void write_ends(const ChainLanes& lanes, ChainEnds& ends) {
  for (int i = 0; i < kLanes; ++i) {
    if (!lanes.left.active[i]) continue;
    const glm::dvec3 point = lanes.beams.point.at(i), direction = lanes.beams.direction.at(i);
    const bool sky = lanes.rays.object[i] == optics::kNoHit;
    const double way = lanes.offset_mm + double(lanes.rays.t_max[i]);
    ends.position[i] =
        sky ? glm::vec4(glm::vec3(direction), 0) : glm::vec4(glm::vec3(point + way * direction), 1);
    ends.surface[i] = glm::vec3(point);
    ends.direction[i] = glm::vec3(direction);
    ends.normal[i] =
        glm::normalize(glm::vec3(lanes.rays.normal_x[i], lanes.rays.normal_y[i], lanes.rays.normal_z[i]));
    ends.bounces[i] = lanes.bounces[i];
    ends.path[i] = lanes.path[i];
  }
}

/// A lens that lets no light through shows as a body where it is met.
void write_blocked_end(const ChainLanes& from, int i, const MetLanes& entry, ChainEnds& ends) {
  ends.position[i] = glm::vec4(glm::vec3(entry.point.at(i)), 1);
  ends.surface[i] = glm::vec3(from.beams.point.at(i));
  ends.direction[i] = glm::vec3(from.beams.direction.at(i));
  ends.normal[i] = glm::vec3(entry.normal.at(i));
  ends.bounces[i] = from.bounces[i];
  ends.path[i] = from.path[i];
}

}  // namespace

TracedChains::TracedChains(const Scene& scene, const optics::RayScene& rays, const ShadingScene& shading,
                           const TracedLenses& lenses, const TracedPlanars& planars)
    : scene_(scene), rays_(rays), shading_(shading), lenses_(lenses), planars_(planars) {
  mirrors_.resize(scene.optics.size());
  own_sine_.assign(scene.optics.size(), -1);
  for (std::size_t i = 0; i < scene.optics.size(); ++i) optic_changed(i);
}

void TracedChains::optic_changed(std::size_t index) {
  const optics::Optic& optic = scene_.optics[index];
  if (optic.kind == optics::OpticKind::mirror) {
    mirrors_[index] = std::make_unique<Mirror>();
    own_sine_[index] = own_sight_sine(optic.mesh, reflecting_sense(optic));
  }
  possible_ = depth() > 1 && (scene_.optics.size() > 1 || lenses_.possible_next() ||
                              std::ranges::any_of(own_sine_, [](double sine) { return sine > 0; }));
}

bool TracedChains::find_next(const optics::RayPacket16& hits, const LeftOptics& left, MetOptics& met) const {
  const auto first_optic = static_cast<std::uint32_t>(scene_.surroundings.size());
  bool found = false;
  int own = -1;  // a mirror that some lane may see again
  for (int i = 0; i < kLanes; ++i) {
    met.optic[i] = -1;
    if (!left.active[i]) continue;
    const bool by_mirror = scene_.optics[std::size_t(left.optic[i])].kind == optics::OpticKind::mirror;
    if (by_mirror && left.sees_own[i]) own = left.optic[i];
    if (hits.object[i] == optics::kNoHit || hits.object[i] < first_optic) continue;
    const int optic = int(hits.object[i] - first_optic);
    if (is_dark_side(scene_.optics[std::size_t(optic)], facing(hits, i))) continue;
    found = true;
    set_met(hits, i, optic, optics::LensSide::front, met);
  }
  for (std::size_t mirror = 0; own >= 0 && mirror < mirrors_.size(); ++mirror) {
    bool asked[kLanes], any = false;
    for (int i = 0; i < kLanes; ++i)
      any |= asked[i] =
          mirrors_[mirror] && left.active[i] && left.sees_own[i] && left.optic[i] == int(mirror);
    if (!any) continue;
    const optics::Optic& optic = scene_.optics[mirror];
    const OwnSide side{rays_, first_optic + std::uint32_t(mirror), side_of_mirror(optic),
                       reflecting_sense(optic)};
    found |= find_own(side, int(mirror), optics::LensSide::front, hits, asked, met);
  }
  found |= lenses_.find_next(hits, left, met);
  return planars_.find_next(hits, left, met) || found;
}

void TracedChains::meet_mirrors(const BeamLanes& beams, const MetOptics& met, MetLanes& at) const {
  at = {};
  for (std::size_t index = 0; index < mirrors_.size(); ++index) {
    if (!mirrors_[index] || std::ranges::find(met.optic, int(index)) == std::end(met.optic)) continue;
    Mirror& mirror = *mirrors_[index];
    // Isolated: a thread that waits here must not take up work that waits here itself.
    std::call_once(mirror.fitted, [&] {
      tbb::this_task_arena::isolate(
          [&] { mirror.patches = std::make_unique<LensSidePatches>(side_of_mirror(scene_.optics[index])); });
    });
    LensSidePatches::MeshHits hits{};
    for (int i = 0; i < kLanes; ++i) {
      hits.active[i] = met.optic[i] == int(index);
      if (!hits.active[i]) continue;
      hits.distance[i] = double(met.distance[i]);
      hits.triangle[i] = met.triangle[i];
      hits.u[i] = met.u[i];
      hits.v[i] = met.v[i];
    }
    mirror.patches->meet_all(beams, hits, at);
  }
}

std::size_t TracedChains::follow(const ChainLanes& from, const MetOptics& met, int depth,
                                 Float4 (&radiance)[kLanes], ChainEnds* ends) const {
  bool any_mirror = false, any_lens = false, any_glass = false;
  for (const int optic : met.optic) {
    if (optic < 0) continue;
    const optics::Optic& next = scene_.optics[std::size_t(optic)];
    (is_planar_glass(next) ? any_glass : mirrors_[std::size_t(optic)] ? any_mirror : any_lens) = true;
  }
  const std::size_t rays = (any_mirror ? reflect(from, met, depth, radiance, ends) : 0) +
                           (any_lens ? refract(from, met, depth, radiance, ends) : 0) +
                           (any_glass ? pass_glass(from, met, depth, radiance, ends) : 0);
  if (planars_.any_surface()) add_surfaces(from, met, radiance);
  return rays;
}

std::size_t TracedChains::reflect(const ChainLanes& from, const MetOptics& met, int depth,
                                  Float4 (&radiance)[kLanes], ChainEnds* ends) const {
  MetLanes at;
  meet_mirrors(from.beams, met, at);
  if (planars_.any_special()) planars_.meet_tilted(from.beams, met.optic, from.sample, at);
  ChainLanes to{};
  to.sample = from.sample;
  reflect_beams(from.beams, at, to.beams);
  for (int i = 0; i < kLanes; ++i) {
    to.left.optic[i] = -1;
    if (met.optic[i] < 0 || !mirrors_[std::size_t(met.optic[i])]) continue;
    set_left(from, i, met.optic[i], optics::LensSide::front, to);
    to.left.sees_own[i] =
        sees_own(std::size_t(met.optic[i]), glm::dot(to.beams.direction.at(i), at.normal.at(i)));
    to.wavelength[i] = from.wavelength[i];
  }
  load_rays(to);
  Float4 seen[kLanes] = {};
  const std::size_t rays = leave(to, depth - 1, seen, ends);
  for (int i = 0; i < kLanes; ++i) {
    if (!to.left.active[i]) continue;
    const glm::vec3& tint = scene_.optics[std::size_t(met.optic[i])].reflectance;
    radiance[i] = Float4{tint.r, tint.g, tint.b, 1} * seen[i];
  }
  return rays;
}

std::size_t TracedChains::refract(const ChainLanes& from, const MetOptics& met, int depth,
                                  Float4 (&radiance)[kLanes], ChainEnds* ends) const {
  LensLanes lanes;
  lanes.any = true;
  lanes.eye = from.beams;
  double distance[kLanes] = {};
  std::size_t passes = 1;
  for (int i = 0; i < kLanes; ++i) {
    const bool lens =
        met.optic[i] >= 0 && scene_.optics[std::size_t(met.optic[i])].kind == optics::OpticKind::lens;
    lanes.optic[i] = lens ? met.optic[i] : -1;
    if (!lens) continue;
    lanes.entered[i] = met.entered[i];
    lanes.u[i] = met.u[i];
    lanes.v[i] = met.v[i];
    lanes.triangle[i] = met.triangle[i];
    distance[i] = from.offset_mm + double(met.distance[i]);
    radiance[i] = Float4{};
    if (from.wavelength[i] < 0)
      passes = std::max(passes, lenses_.sample_count_of(std::size_t(lanes.optic[i])));
  }
  lenses_.meet_entries(distance, lanes);
  std::size_t rays = 0;
  for (std::size_t pass = 0; pass < passes; ++pass)
    rays += refract_pass(from, lanes, pass, depth, radiance, pass == 0 ? ends : nullptr);
  return rays;
}

std::size_t TracedChains::refract_pass(const ChainLanes& from, const LensLanes& lanes, std::size_t pass,
                                       int depth, Float4 (&radiance)[kLanes], ChainEnds* ends) const {
  TracedLenses::IndexLanes indices = {};
  bool splits[kLanes];
  std::size_t sample[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    if (lanes.optic[i] < 0) continue;
    const auto optic = std::size_t(lanes.optic[i]);
    const std::size_t count = lenses_.sample_count_of(optic);
    splits[i] = from.wavelength[i] < 0 && count > 1;
    sample[i] = splits[i] ? pass : 0;
    if (splits[i])
      indices[i] = lenses_.indices(optic, sample[i]);
    else if (pass == 0)
      indices[i] = lenses_.indices_at(optic, from.wavelength[i]);
  }
  RefractedLanes out;
  lenses_.refract(lanes, indices, out);
  ChainLanes to{};
  to.sample = from.sample;
  to.beams = out.beams;
  to.rays = out.rays;
  to.offset_mm = optics::kSelfHitDistance_mm;
  for (int i = 0; i < kLanes; ++i) {
    to.left.optic[i] = -1;
    if (!out.passed[i]) continue;
    const optics::LensSide side = optics::other_side(lanes.entered[i]);
    set_left(from, i, lanes.optic[i], side, to);
    to.left.sees_own[i] = lenses_.sees_own(std::size_t(lanes.optic[i]), side,
                                           glm::dot(out.beams.direction.at(i), out.exit.normal.at(i)));
    to.wavelength[i] =
        splits[i] ? lenses_.wavelength(std::size_t(lanes.optic[i]), sample[i]) : from.wavelength[i];
  }
  Float4 seen[kLanes] = {};
  const std::size_t rays = leave(to, depth - 1, seen, ends);
  for (int i = 0; i < kLanes; ++i) {
    if (!indices[i]) continue;
    if (ends && !out.passed[i]) write_blocked_end(from, i, lanes.entry, *ends);
    const optics::Optic& lens = scene_.optics[std::size_t(lanes.optic[i])];
    glm::vec3 color = out.passed[i] ? out.transmittance[i] * glm::vec3(seen[i][0], seen[i][1], seen[i][2])
                                    : scene_.environment.ambient * lens.rim_color;
    if (splits[i]) color = lenses_.weight(std::size_t(lanes.optic[i]), sample[i]) * color;
    radiance[i] += Float4{color.r, color.g, color.b, 0};
  }
  return rays;
}

std::size_t TracedChains::leave(ChainLanes& to, int depth, Float4 (&seen)[kLanes], ChainEnds* ends) const {
  query_past_own(rays_, static_cast<std::uint32_t>(scene_.surroundings.size()), to.left.optic, to.rays);
  std::size_t rays = 0;
  for (const bool active : to.left.active) rays += active ? 1 : 0;
  shade(to, seen);
  if (ends) write_ends(to, *ends);
  std::copy_n(to.rays.t_max, kLanes, to.next_mm);
  MetOptics met;
  if (depth <= 0 || !find_next(to.rays, to.left, met)) return rays;
  for (int i = 0; i < kLanes; ++i)
    if (met.optic[i] >= 0) to.next_mm[i] = met.distance[i];
  return rays + follow(to, met, depth, seen, ends);
}

void TracedChains::shade(const ChainLanes& lanes, Float4 (&seen)[kLanes]) const {
  ShadeLanes shade;
  copy_hits(lanes.rays, shade);
  set_areas(lanes.beams, lanes.rays.t_max, shade.footprint);
  for (int i = 0; i < kLanes; ++i) {
    shade.active[i] = lanes.left.active[i];
    if (!shade.active[i]) shade.footprint[i] = 0;
  }
  shading_.shade(shade);
  std::copy_n(shade.radiance, kLanes, seen);
}

}  // namespace catoptra::render
