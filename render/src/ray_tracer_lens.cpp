#include "render/src/ray_tracer_lens.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>

#include "optics/exact_hit.h"
#include "optics/vertex_hits.h"
#include "render/src/lens_rays.h"
#include "render/src/ray_tracer_chain_query.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = LensLanes::kLanes;

void set_ray(optics::RayPacket16& packet, int i, const glm::dvec3& origin, const glm::dvec3& direction,
             float t_max) {
  packet.origin_x[i] = float(origin.x);
  packet.origin_y[i] = float(origin.y);
  packet.origin_z[i] = float(origin.z);
  packet.direction_x[i] = float(direction.x);
  packet.direction_y[i] = float(direction.y);
  packet.direction_z[i] = float(direction.z);
  packet.t_min[i] = 0;
  packet.t_max[i] = t_max;
}

/// Whether any of the lanes `asked` may meet the box before its t_max; lanes that cannot are taken out.
/// Slabs.
bool reaches(const optics::RayPacket16& rays, const cad_import::BoundingBox& box, bool (&asked)[kLanes]) {
  constexpr float kMargin_mm = 0.1f;
  const glm::vec3 low = glm::vec3(box.min) - kMargin_mm, high = glm::vec3(box.max) + kMargin_mm;
  bool any = false;
  for (int i = 0; i < kLanes; ++i) {
    float first = rays.t_min[i], last = rays.t_max[i];
    const auto slab = [&](float origin, float direction, float a, float b) {
      const float inverse = 1 / (direction == 0 ? 1e-30f : direction);
      const float t0 = (a - origin) * inverse, t1 = (b - origin) * inverse;
      first = std::max(first, std::min(t0, t1));
      last = std::min(last, std::max(t0, t1));
    };
    slab(rays.origin_x[i], rays.direction_x[i], low.x, high.x);
    slab(rays.origin_y[i], rays.direction_y[i], low.y, high.y);
    slab(rays.origin_z[i], rays.direction_z[i], low.z, high.z);
    asked[i] = asked[i] && first <= last;
    any |= asked[i];
  }
  return any;
}

}  // namespace

TracedLenses::Lens::Lens(std::size_t index, const optics::Optic& lens)
    : optic(index), tracer(lens), samples(samples_of(lens)) {
  front.add_optic(lens.mesh);
  back.add_optic(lens.back.mesh);
  front.commit();
  back.commit();
  for (const optics::SpectralSample& sample : samples)
    indices.push_back(optics::lens_indices(lens, sample.wavelength_nm));
  for (const auto* mesh : {&lens.mesh, &lens.back.mesh})
    for (const auto& vertex : mesh->vertices) {
      box.min = glm::min(box.min, vertex.position_mm);
      box.max = glm::max(box.max, vertex.position_mm);
    }
  own_sine[0] = own_sight_sine(lens.mesh, 1);
  own_sine[1] = own_sight_sine(lens.back.mesh, 1);
}

void TracedLenses::Lens::fit_patches(const optics::Optic& lens) {
  // Isolated: a thread that waits here must not take up work that waits here itself.
  std::call_once(fitted, [&] {
    tbb::this_task_arena::isolate([&] {
      front_patches = std::make_unique<LensSidePatches>(optics::side_of(lens, optics::LensSide::front));
      back_patches = std::make_unique<LensSidePatches>(optics::side_of(lens, optics::LensSide::back));
    });
  });
}

const optics::RayScene& TracedLenses::Lens::scene(optics::LensSide side) const {
  return side == optics::LensSide::front ? front : back;
}

const LensSidePatches& TracedLenses::Lens::patches(optics::LensSide side) const {
  return side == optics::LensSide::front ? *front_patches : *back_patches;
}

TracedLenses::TracedLenses(const Scene& scene) : scene_(scene), by_optic_(scene.optics.size(), nullptr) {
  for (std::size_t i = 0; i < scene.optics.size(); ++i) {
    if (scene.optics[i].kind != optics::OpticKind::lens) continue;
    lenses_.push_back(std::make_unique<Lens>(i, scene.optics[i]));
    by_optic_[i] = lenses_.back().get();
  }
  number_wavelengths();
}

void TracedLenses::number_wavelengths() {
  wavelengths_nm_.clear();
  for (const auto& lens : lenses_) {
    lens->wavelengths.clear();
    for (const optics::SpectralSample& sample : lens->samples) {
      const auto found = std::ranges::find(wavelengths_nm_, sample.wavelength_nm);
      lens->wavelengths.push_back(int(found - wavelengths_nm_.begin()));
      if (found == wavelengths_nm_.end()) wavelengths_nm_.push_back(sample.wavelength_nm);
    }
  }
  for (const auto& lens : lenses_) {
    lens->indices_at.clear();
    for (const double nm : wavelengths_nm_)
      lens->indices_at.push_back(optics::lens_indices(scene_.optics[lens->optic], nm));
  }
}

int TracedLenses::wavelength(std::size_t index, std::size_t sample) const {
  const Lens& lens = *by_optic_[index];
  return lens.samples.size() > 1 ? lens.wavelengths[sample] : -1;
}

glm::mat3 TracedLenses::weight(std::size_t index, std::size_t sample) const {
  return glm::mat3(by_optic_[index]->samples[sample].weight);
}

const optics::LensIndices* TracedLenses::indices(std::size_t index, std::size_t sample) const {
  const Lens& lens = *by_optic_[index];
  return sample < lens.indices.size() ? &lens.indices[sample] : nullptr;
}

const optics::LensIndices* TracedLenses::indices_at(std::size_t index, int wavelength) const {
  const Lens& lens = *by_optic_[index];
  return lens.samples.size() > 1 && wavelength >= 0 ? &lens.indices_at[std::size_t(wavelength)]
                                                    : &lens.indices[0];
}

void TracedLenses::optic_changed(std::size_t index) {
  for (auto& lens : lenses_)
    if (lens->optic == index)
      by_optic_[index] = (lens = std::make_unique<Lens>(index, scene_.optics[index])).get();
  number_wavelengths();
}

std::vector<optics::LensSide> TracedLenses::entered_from(const glm::dvec3& eye_mm) const {
  std::vector<optics::LensSide> entered;
  for (const auto& lens : lenses_) {
    lens->fit_patches(scene_.optics[lens->optic]);
    entered.push_back(optics::side_towards(scene_.optics[lens->optic], eye_mm));
  }
  return entered;
}

void TracedLenses::find(const std::vector<optics::LensSide>& entered, optics::RayPacket16& first,
                        LensLanes& lanes) const {
  lanes.any = false;
  if (lenses_.empty()) return;
  std::fill(std::begin(lanes.optic), std::end(lanes.optic), -1);
  for (std::size_t k = 0; k < lenses_.size(); ++k) {
    const Lens& lens = *lenses_[k];
    optics::RayPacket16 query = first;  // no farther than what has been met so far
    lens.scene(entered[k]).intersect16(query, optics::kOptics, true);
    for (int i = 0; i < kLanes; ++i) {
      if (query.object[i] == optics::kNoHit) continue;
      lanes.any = true;
      lanes.optic[i] = int(lens.optic);
      lanes.entered[i] = entered[k];
      lanes.depth[i] = first.t_max[i] = query.t_max[i];
      lanes.triangle[i] = query.triangle[i];
      lanes.u[i] = query.u[i];
      lanes.v[i] = query.v[i];
      first.object[i] = optics::kNoHit;
    }
  }
}

void TracedLenses::enter(const CameraRays& camera, const double (&column)[kLanes],
                         const double (&row)[kLanes], LensLanes& lanes) const {
  if (!lanes.any) return;
  double distance[kLanes];
  aim_beams(camera, column, row, distance, lanes.eye);
  for (int i = 0; i < kLanes; ++i)
    if (lanes.optic[i] >= 0) distance[i] *= double(lanes.depth[i]);
  meet_entries(distance, lanes);
}

void TracedLenses::meet_entries(const double (&distance)[kLanes], LensLanes& lanes) const {
  lanes.entry = {};
  for (const auto& lens : lenses_) {
    if (std::ranges::find(lanes.optic, int(lens->optic)) == std::end(lanes.optic)) continue;
    for (const optics::LensSide side : {optics::LensSide::front, optics::LensSide::back}) {
      LensSidePatches::MeshHits hits{};
      bool any = false;
      for (int i = 0; i < kLanes; ++i) {
        hits.active[i] = lanes.optic[i] == int(lens->optic) && lanes.entered[i] == side;
        if (!hits.active[i]) continue;
        any = true;
        hits.distance[i] = distance[i];
        hits.triangle[i] = lanes.triangle[i];
        hits.u[i] = lanes.u[i];
        hits.v[i] = lanes.v[i];
      }
      if (any) lens->patches(side).meet_all(lanes.eye, hits, lanes.entry);
    }
  }
}

std::size_t TracedLenses::sample_count(const LensLanes& lanes) const {
  std::size_t count = 0;
  if (!lanes.any) return count;
  for (const int optic : lanes.optic)
    if (optic >= 0) count = std::max(count, by_optic_[std::size_t(optic)]->samples.size());
  return count;
}

// Exits are looked for as LensTracer does: from a little before the entry on, and what is not met clearly is
// its affair.
void TracedLenses::meet_exits(const Lens& lens, optics::LensSide entered, const LensLanes& lanes,
                              const IndexLanes& indices, const RefractedBeams& inside, MetLanes& exit,
                              bool (&met)[kLanes]) const {
  constexpr double kBeforeEntry_mm = 0.05;
  bool here[kLanes], any = false;
  for (int i = 0; i < kLanes; ++i)
    any |= here[i] = lanes.optic[i] == int(lens.optic) && lanes.entered[i] == entered && indices[i];
  if (!any) return;
  const optics::LensSide left = optics::other_side(entered);
  optics::RayPacket16 query;
  bool active[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    active[i] =
        here[i] && inside.possible[i] && glm::dot(lanes.eye.direction.at(i), lanes.entry.normal.at(i)) < 0;
    set_ray(query, i, {0, 0, 0}, {1, 0, 0}, -1);
    if (!active[i]) continue;
    const glm::dvec3 direction = inside.beams.direction.at(i);
    set_ray(query, i, inside.beams.point.at(i) - kBeforeEntry_mm * direction, direction,
            std::numeric_limits<float>::infinity());
  }
  lens.scene(left).intersect16(query, optics::kOptics, true);
  LensSidePatches::MeshHits hits{};
  for (int i = 0; i < kLanes; ++i) {
    hits.active[i] = active[i] && query.object[i] != optics::kNoHit;
    if (!hits.active[i]) continue;
    hits.distance[i] = double(query.t_max[i]) - kBeforeEntry_mm;
    hits.triangle[i] = query.triangle[i];
    hits.u[i] = query.u[i];
    hits.v[i] = query.v[i];
  }
  bool solved[kLanes];
  lens.patches(left).meet(inside.beams, hits, exit, solved);
  const optics::LensSideView side = optics::side_of(scene_.optics[lens.optic], left);
  for (int i = 0; i < kLanes; ++i) {
    if (!active[i]) continue;
    const glm::dvec3 direction = inside.beams.direction.at(i);
    met[i] = solved[i] && exit.distance[i] >= 0 && glm::dot(exit.normal.at(i), direction) > 0;
    if (met[i]) continue;
    optics::ExactHit entry;
    entry.position_mm = lanes.entry.point.at(i);
    entry.normal = lanes.entry.normal.at(i);
    const optics::LensPath path = lens.tracer.trace_from({lanes.eye.point.at(i), lanes.eye.direction.at(i)},
                                                         entry, entered, *indices[i]);
    met[i] = path.end == optics::LensPathEnd::passed;
    if (met[i]) meet_vertex(exact_side_point(side, path.exit), inside.beams, i, exit);
  }
}

void TracedLenses::refract(const LensLanes& lanes, std::size_t sample, RefractedLanes& out) const {
  IndexLanes by_lane = {};
  for (int i = 0; i < kLanes; ++i)
    if (lanes.optic[i] >= 0) by_lane[i] = indices(std::size_t(lanes.optic[i]), sample);
  refract(lanes, by_lane, out);
}

void TracedLenses::refract(const LensLanes& lanes, const IndexLanes& indices, RefractedLanes& out) const {
  double inwards[kLanes], outwards[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    inwards[i] = indices[i] ? indices[i]->around / indices[i]->lens : 1;
    outwards[i] = 1 / inwards[i];
  }
  RefractedBeams inside, outside;
  refract_beams(lanes.eye, lanes.entry, inwards, inside);
  out.exit = {};
  bool met[kLanes] = {};
  for (const auto& lens : lenses_)
    for (const optics::LensSide entered : {optics::LensSide::front, optics::LensSide::back})
      meet_exits(*lens, entered, lanes, indices, inside, out.exit, met);
  refract_beams(inside.beams, out.exit, outwards, outside);
  out.beams = outside.beams;
  for (int i = 0; i < kLanes; ++i) {
    out.passed[i] = met[i] && outside.possible[i];
    set_ray(out.rays, i, {0, 0, 0}, {1, 0, 0}, -1);
    if (!out.passed[i]) continue;
    out.transmittance[i] = float(inside.transmittance[i] * outside.transmittance[i]);
    const glm::dvec3 direction = out.beams.direction.at(i);
    set_ray(out.rays, i, out.beams.point.at(i) + optics::kSelfHitDistance_mm * direction, direction,
            std::numeric_limits<float>::infinity());
  }
}

bool TracedLenses::possible_next() const {
  const auto sees_own = [](const auto& lens) { return lens->own_sine[0] > 0 || lens->own_sine[1] > 0; };
  return scene_.optics.size() > 1 ? !lenses_.empty() : std::ranges::any_of(lenses_, sees_own);
}

bool TracedLenses::find_next(const optics::RayPacket16& rays, const LeftOptics& left, MetOptics& met) const {
  bool found = false;
  for (const auto& lens : lenses_) {
    bool others[kLanes], own[kLanes], any_own = false;
    for (int i = 0; i < kLanes; ++i) {
      const bool left_it = left.optic[i] == int(lens->optic);
      others[i] = left.active[i] && !left_it;
      any_own |= own[i] = left.active[i] && left_it && left.sees_own[i];
    }
    for (const optics::LensSide side : {optics::LensSide::front, optics::LensSide::back}) {
      if (any_own) {
        bool here[kLanes];
        for (int i = 0; i < kLanes; ++i) here[i] = own[i] && left.side[i] == side;
        const OwnSide own_side{lens->scene(side), 0, optics::side_of(scene_.optics[lens->optic], side), 1};
        found |= find_own(own_side, int(lens->optic), side, rays, here, met);
      }
      if (reaches(rays, lens->box, others)) found |= find_side(*lens, side, rays, others, met);
    }
  }
  return found;
}

bool TracedLenses::find_side(const Lens& lens, optics::LensSide side, const optics::RayPacket16& rays,
                             const bool (&asked)[kLanes], MetOptics& met) {
  optics::RayPacket16 query = rays;
  for (int i = 0; i < kLanes; ++i) {
    if (!asked[i]) query.t_max[i] = query.t_min[i] - 1;
    if (asked[i] && met.optic[i] >= 0) query.t_max[i] = std::min(query.t_max[i], met.distance[i]);
  }
  lens.scene(side).intersect16(query, optics::kOptics, true);
  bool found = false;
  for (int i = 0; i < kLanes; ++i) {
    if (!asked[i] || query.object[i] == optics::kNoHit) continue;
    found = true;
    set_met(query, i, int(lens.optic), side, met);
  }
  return found;
}

void TracedLenses::add_colors(std::size_t sample, const RefractedLanes& out, LensLanes& lanes) const {
  for (int i = 0; i < kLanes; ++i) {
    if (lanes.optic[i] < 0) continue;
    const Lens& lens = *by_optic_[std::size_t(lanes.optic[i])];
    if (sample >= lens.samples.size()) continue;
    const Float4& seen = out.shade.radiance[i];
    const glm::vec3 color = out.passed[i] ? out.transmittance[i] * glm::vec3(seen[0], seen[1], seen[2])
                                          : scene_.environment.ambient * scene_.optics[lens.optic].rim_color;
    const glm::vec3 weighted = glm::mat3(lens.samples[sample].weight) * color;
    lanes.radiance[i] += Float4{weighted.r, weighted.g, weighted.b, 0};
  }
}

}  // namespace catoptra::render
