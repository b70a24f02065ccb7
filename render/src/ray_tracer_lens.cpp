#include "render/src/ray_tracer_lens.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "optics/exact_hit.h"
#include "render/src/lens_rays.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = LensLanes::kLanes;

/// The point of the side's exact surface that belongs to a hit on its mesh.
tessellate::OpticVertex exact_entry(const optics::LensSideView& side, const optics::Ray& ray,
                                    const optics::Hit& mesh_hit) {
  if (const auto hit = optics::exact_hit(side.faces, *side.mesh, ray, mesh_hit)) {
    const auto curvature =
        side.faces[std::size_t(hit->face)].surface->principal_curvatures(hit->uv.x, hit->uv.y);
    return {hit->position_mm,     hit->normal, curvature.k1, curvature.k2,
            curvature.direction1, hit->face,   hit->uv};
  }
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

double LensBeam::area_mm2(double way_mm) const {
  const glm::dvec3 right = right_mm + way_mm * right_per_mm, down = down_mm + way_mm * down_per_mm;
  return std::abs(glm::dot(glm::cross(right, down), direction));
}

TracedLenses::TracedLenses(const Scene& scene) : scene_(scene), by_optic_(scene.optics.size(), nullptr) {
  for (std::size_t i = 0; i < scene.optics.size(); ++i) {
    if (scene.optics[i].kind != optics::OpticKind::lens) continue;
    lenses_.push_back(make_lens(i));
    by_optic_[i] = lenses_.back().get();
  }
}

std::unique_ptr<TracedLenses::Lens> TracedLenses::make_lens(std::size_t optic) const {
  const optics::Optic& lens = scene_.optics[optic];
  auto made = std::make_unique<Lens>(Lens{optic, optics::LensTracer(lens), {}, {}, samples_of(lens), {}});
  made->front.add_optic(lens.mesh);
  made->back.add_optic(lens.back.mesh);
  made->front.commit();
  made->back.commit();
  for (const optics::SpectralSample& sample : made->samples)
    made->indices.push_back(optics::lens_indices(lens, sample.wavelength_nm));
  return made;
}

void TracedLenses::optic_changed(std::size_t index) {
  for (auto& lens : lenses_)
    if (lens->optic == index) by_optic_[index] = (lens = make_lens(index)).get();
}

std::vector<optics::LensSide> TracedLenses::entered_from(const glm::dvec3& eye_mm) const {
  std::vector<optics::LensSide> entered;
  for (const auto& lens : lenses_)
    entered.push_back(optics::side_towards(scene_.optics[lens->optic], eye_mm));
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
    (entered[k] == optics::LensSide::front ? lens.front : lens.back)
        .intersect16(query, optics::kOptics, true);
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
  for (int i = 0; i < kLanes; ++i) {
    if (lanes.optic[i] < 0) continue;
    const glm::dvec3 d = camera.direction(column[i], row[i]);
    const double stretch = glm::length(d);
    const optics::Hit hit{
        double(lanes.depth[i]) * stretch, 0, lanes.triangle[i], {double(lanes.u[i]), double(lanes.v[i])}};
    const auto side = optics::side_of(scene_.optics[std::size_t(lanes.optic[i])], lanes.entered[i]);
    lanes.entry[i] = exact_entry(side, {camera.eye_mm, d / stretch}, hit);
    const double depth = glm::dot(lanes.entry[i].position_mm - camera.eye_mm, camera.forward);
    lanes.pixel_right_mm[i] = depth * camera.dx;
    lanes.pixel_down_mm[i] = depth * camera.dy;
  }
}

std::size_t TracedLenses::sample_count(const LensLanes& lanes) const {
  std::size_t count = 0;
  if (!lanes.any) return count;
  for (const int optic : lanes.optic)
    if (optic >= 0) count = std::max(count, by_optic_[std::size_t(optic)]->samples.size());
  return count;
}

void TracedLenses::refract(const glm::dvec3& eye_mm, const LensLanes& lanes, std::size_t sample,
                           RefractedLanes& out) const {
  for (int i = 0; i < kLanes; ++i) {
    out.passed[i] = false;
    set_ray(out.rays, i, {0, 0, 0}, {1, 0, 0}, -1);
    if (lanes.optic[i] < 0) continue;
    const Lens& lens = *by_optic_[std::size_t(lanes.optic[i])];
    if (sample >= lens.samples.size()) continue;
    const optics::VertexHit ray =
        optics::refract_vertex(lanes.entry[i], scene_.optics[lens.optic], lens.tracer, lanes.entered[i],
                               lens.indices[sample], eye_mm);
    if (!ray.faces_eye) continue;
    out.passed[i] = true;
    out.exit_mm[i] = ray.surface_point_mm;
    out.transmittance[i] = float(ray.transmittance);
    const optics::RayDifferential& change = ray.differential;
    const glm::dvec3 &right = lanes.pixel_right_mm[i], &down = lanes.pixel_down_mm[i];
    out.beam[i] = {ray.direction, change.point * right, change.point * down, change.direction * right,
                   change.direction * down};
    set_ray(out.rays, i, ray.surface_point_mm + optics::kSelfHitDistance_mm * ray.direction, ray.direction,
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
