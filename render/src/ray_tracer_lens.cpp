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

namespace catoptra::render {
namespace {

constexpr int kLanes = LensLanes::kLanes;

tessellate::OpticVertex vertex_at(const optics::LensSideView& side, const optics::ExactHit& hit) {
  const auto curvature = side.faces[std::size_t(hit.face)].surface->principal_curvatures(hit.uv.x, hit.uv.y);
  return {hit.position_mm, hit.normal, curvature.k1, curvature.k2, curvature.direction1, hit.face, hit.uv};
}

/// The point of the side's exact surface that belongs to a hit on its mesh.
tessellate::OpticVertex exact_entry(const optics::LensSideView& side, const optics::Ray& ray,
                                    const optics::Hit& mesh_hit) {
  if (const auto hit = optics::exact_hit(side.faces, *side.mesh, ray, mesh_hit)) return vertex_at(side, *hit);
  // The mesh reaches past the trimmed face by less than its chord error: here the mesh itself is the lens.
  const tessellate::OpticTriangle& triangle = side.mesh->triangles[mesh_hit.triangle];
  const auto corner = [&](std::size_t k) -> const tessellate::OpticVertex& {
    return side.mesh->vertices[triangle.vertices[k]];
  };
  const double u = mesh_hit.barycentric.x, v = mesh_hit.barycentric.y, w = 1 - u - v;
  tessellate::OpticVertex entry = corner(w >= u && w >= v ? 0 : u >= v ? 1 : 2);
  entry.position_mm = w * corner(0).position_mm + u * corner(1).position_mm + v * corner(2).position_mm;
  entry.normal = glm::normalize(w * corner(0).normal + u * corner(1).normal + v * corner(2).normal);
  return entry;
}

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

}  // namespace

TracedLenses::Lens::Lens(std::size_t index, const optics::Optic& lens)
    : optic(index), tracer(lens), samples(samples_of(lens)) {
  front.add_optic(lens.mesh);
  back.add_optic(lens.back.mesh);
  front.commit();
  back.commit();
  for (const optics::SpectralSample& sample : samples)
    indices.push_back(optics::lens_indices(lens, sample.wavelength_nm));
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
}

void TracedLenses::optic_changed(std::size_t index) {
  for (auto& lens : lenses_)
    if (lens->optic == index)
      by_optic_[index] = (lens = std::make_unique<Lens>(index, scene_.optics[index])).get();
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
  double stretch[kLanes];
  aim_beams(camera, column, row, stretch, lanes.eye);
  lanes.entry = {};
  for (const auto& lens : lenses_) {
    LensSidePatches::MeshHits hits{};
    const int* some = std::find(lanes.optic, lanes.optic + kLanes, int(lens->optic));
    if (some == lanes.optic + kLanes) continue;
    const optics::LensSide entered = lanes.entered[some - lanes.optic];
    for (int i = 0; i < kLanes; ++i) {
      hits.active[i] = lanes.optic[i] == int(lens->optic);
      if (!hits.active[i]) continue;
      hits.distance[i] = double(lanes.depth[i]) * stretch[i];
      hits.triangle[i] = lanes.triangle[i];
      hits.u[i] = lanes.u[i];
      hits.v[i] = lanes.v[i];
    }
    bool solved[kLanes];
    lens->patches(entered).meet(lanes.eye, hits, lanes.entry, solved);
    const optics::LensSideView side = optics::side_of(scene_.optics[lens->optic], entered);
    for (int i = 0; i < kLanes; ++i) {
      if (!hits.active[i] || (solved[i] && lanes.entry.distance[i] > 0)) continue;
      const optics::Hit hit{hits.distance[i], 0, hits.triangle[i], {double(hits.u[i]), double(hits.v[i])}};
      meet_vertex(exact_entry(side, {camera.eye_mm, lanes.eye.direction.at(i)}, hit), lanes.eye, i,
                  lanes.entry);
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
void TracedLenses::meet_exits(const Lens& lens, const LensLanes& lanes, std::size_t sample,
                              const RefractedBeams& inside, MetLanes& exit, bool (&met)[kLanes]) const {
  constexpr double kBeforeEntry_mm = 0.05;
  const int* some = std::find(lanes.optic, lanes.optic + kLanes, int(lens.optic));
  if (some == lanes.optic + kLanes || sample >= lens.samples.size()) return;
  const optics::LensSide entered = lanes.entered[some - lanes.optic], left = optics::other_side(entered);
  optics::RayPacket16 query;
  bool active[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    active[i] = lanes.optic[i] == int(lens.optic) && inside.possible[i] &&
                glm::dot(lanes.eye.direction.at(i), lanes.entry.normal.at(i)) < 0;
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
                                                         entry, entered, lens.indices[sample]);
    met[i] = path.end == optics::LensPathEnd::passed;
    if (met[i]) meet_vertex(vertex_at(side, path.exit), inside.beams, i, exit);
  }
}

void TracedLenses::refract(const LensLanes& lanes, std::size_t sample, RefractedLanes& out) const {
  double inwards[kLanes], outwards[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    inwards[i] = outwards[i] = 1;
    if (lanes.optic[i] < 0) continue;
    const Lens& lens = *by_optic_[std::size_t(lanes.optic[i])];
    if (sample >= lens.samples.size()) continue;
    inwards[i] = lens.indices[sample].around / lens.indices[sample].lens;
    outwards[i] = 1 / inwards[i];
  }
  RefractedBeams inside, outside;
  refract_beams(lanes.eye, lanes.entry, inwards, inside);
  MetLanes exit{};
  bool met[kLanes] = {};
  for (const auto& lens : lenses_) meet_exits(*lens, lanes, sample, inside, exit, met);
  refract_beams(inside.beams, exit, outwards, outside);
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
