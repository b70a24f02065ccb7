#include "render/src/lens_rays.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::render {
namespace {

using optics::LensPathEnd;
using optics::VertexHit;

// Corner vertices may have none but continued neighbours.
constexpr int kContinuedRings = 2;

float way_through(const VertexHit& hit, const glm::dvec3& vertex_mm) {
  if (!hit.faces_eye) return -1e6f;
  const double way = glm::dot(hit.surface_point_mm - vertex_mm, hit.from_eye);
  return static_cast<float>(hit.end == LensPathEnd::total_reflection ? -std::abs(way) : way);
}

/// Calls `edge(from, to)` for both directions of every triangle's edges.
template <typename Edge>
void for_each_edge(const tessellate::OpticArrays& mesh, const Edge& edge) {
  for (const auto& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle.vertices[k], b = triangle.vertices[(k + 1) % 3];
      edge(a, b);
      edge(b, a);
    }
}

/// Gives vertices beside those with a ray the mean of what these rays' differentials ask for.
void continue_beyond_border(const tessellate::OpticArrays& mesh, std::vector<VertexHit>& hits) {
  std::vector<VertexHit> sums(hits.size());
  std::vector<int> counts(hits.size(), 0);
  for_each_edge(mesh, [&](std::uint32_t from, std::uint32_t to) {
    // Where the surface looks away from the eye it cannot be continued.
    if (!hits[from].faces_eye || hits[to].faces_eye || hits[to].end == LensPathEnd::missed) return;
    const VertexHit& known = hits[from];
    const glm::dvec3 step = mesh.vertices[to].position_mm - mesh.vertices[from].position_mm;
    VertexHit& sum = sums[to];
    sum.surface_point_mm += known.surface_point_mm + known.differential.point * step;
    sum.direction += known.direction + known.differential.direction * step;
    sum.differential.point += known.differential.point;
    sum.differential.direction += known.differential.direction;
    sum.transmittance =
        counts[to]++ == 0 ? known.transmittance : std::max(sum.transmittance, known.transmittance);
  });
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double count = counts[i];
    if (counts[i] == 0 || !(glm::length(sums[i].direction) > 0)) continue;
    VertexHit& hit = hits[i];
    hit.surface_point_mm = sums[i].surface_point_mm / count;
    hit.direction = glm::normalize(sums[i].direction);
    hit.differential = {sums[i].differential.point / count, sums[i].differential.direction / count};
    hit.transmittance = sums[i].transmittance;
    hit.faces_eye = true;
  }
}

/// The share of the way from a passing vertex to one that does not, up to which light passes, rounded up to
/// the next 1/16.
double passing_share(const optics::LensTracer& tracer, optics::LensSide entered,
                     const optics::LensIndices& indices, const glm::dvec3& eye_mm, const glm::dvec3& from_mm,
                     const glm::dvec3& to_mm) {
  double passed = 0, blocked = 1;
  while (blocked - passed > 1.0 / 16) {
    const double middle = 0.5 * (passed + blocked);
    const glm::dvec3 towards = glm::normalize(from_mm + middle * (to_mm - from_mm) - eye_mm);
    (tracer.trace({eye_mm, towards}, entered, indices).end == LensPathEnd::passed ? passed : blocked) =
        middle;
  }
  return blocked;
}

/// The rays that a map has to hold: for vertices without one of their own, that where light begins to pass.
std::vector<VertexHit> rays_to_border(const optics::Optic& lens, const optics::LensTracer& tracer,
                                      const LensRays& rays, const glm::dvec3& eye_mm) {
  const auto& mesh = *optics::side_of(lens, rays.entered).mesh;
  const auto indices = optics::lens_indices(lens, rays.samples[0].wavelength_nm);
  const std::vector<VertexHit>& hits = rays.hits[0];
  std::vector<VertexHit> border = hits;
  for (VertexHit& hit : border) hit.faces_eye = passes(hit);
  std::vector<double> shares(hits.size(), 0.0);
  for_each_edge(mesh, [&](std::uint32_t from, std::uint32_t to) {
    if (!passes(hits[from]) || passes(hits[to]) || !(rays.open[0][to] > 0)) return;
    const double share = passing_share(tracer, rays.entered, indices, eye_mm, mesh.vertices[from].position_mm,
                                       mesh.vertices[to].position_mm);
    if (!(share > shares[to])) return;
    shares[to] = share;
    const VertexHit &a = hits[from], &b = hits[to];
    border[to].surface_point_mm = a.surface_point_mm + share * (b.surface_point_mm - a.surface_point_mm);
    border[to].direction = glm::normalize(a.direction + share * (b.direction - a.direction));
    border[to].faces_eye = true;
  });
  return border;
}

}  // namespace

bool passes(const VertexHit& hit) {
  return hit.faces_eye && hit.end == LensPathEnd::passed;
}

std::size_t LensRays::passed() const {
  std::size_t count = 0;
  for (const auto& of_sample : hits)
    count += static_cast<std::size_t>(std::count_if(of_sample.begin(), of_sample.end(), passes));
  return count;
}

std::vector<optics::SpectralSample> samples_of(const optics::Optic& lens) {
  auto samples = optics::spectral_samples(lens.wavelengths);
  std::swap(samples[0], samples[samples.size() / 2]);
  return samples;
}

LensRays refract_eye_rays(const optics::Optic& lens, const optics::LensTracer& tracer,
                          const glm::dvec3& eye_mm) {
  return refract_eye_rays(lens, tracer, eye_mm, optics::side_towards(lens, eye_mm));
}

LensRays refract_eye_rays(const optics::Optic& lens, const optics::LensTracer& tracer,
                          const glm::dvec3& eye_mm, optics::LensSide entered) {
  std::vector<optics::Arrival> arrivals;
  for (const auto& vertex : optics::side_of(lens, entered).mesh->vertices)
    arrivals.push_back(optics::arrival_from_eye(eye_mm, vertex.position_mm));
  return refract_eye_rays(lens, tracer, eye_mm, entered, arrivals);
}

LensRays refract_eye_rays(const optics::Optic& lens, const optics::LensTracer& tracer,
                          const glm::dvec3& eye_mm, optics::LensSide entered,
                          std::span<const optics::Arrival> arrivals) {
  LensRays rays{entered, samples_of(lens), {}, {}, {}};
  const auto& mesh = *optics::side_of(lens, rays.entered).mesh;
  for (const optics::SpectralSample& sample : rays.samples) {
    auto hits = optics::refract_vertices(lens, tracer, rays.entered, sample.wavelength_nm, arrivals);
    for (int ring = 0; ring < kContinuedRings; ++ring) continue_beyond_border(mesh, hits);
    auto& open = rays.open.emplace_back();
    for (std::size_t i = 0; i < hits.size(); ++i)
      open.push_back(way_through(hits[i], mesh.vertices[i].position_mm));
    rays.hits.push_back(std::move(hits));
  }
  rays.border = rays_to_border(lens, tracer, rays, eye_mm);
  return rays;
}

void close_off_maps(std::vector<VertexHit>& hits, std::span<const std::uint32_t> patch,
                    std::span<const optics::VirtualView> views) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    VertexHit& hit = hits[i];
    const optics::VirtualView& view = views[patch.empty() ? 0 : patch[i]];
    if (view.projection == optics::MapProjection::parallel || !hit.faces_eye || passes(hit)) continue;
    const glm::dvec3 shown = hit.scene_hit ? hit.hit_point_mm - view.viewpoint_mm : hit.direction;
    constexpr double kGrazing = 0.05;  // sine of the angle above the plane across the view
    const double depth = glm::dot(shown, view.direction), least = kGrazing * glm::length(shown);
    const bool zoomed = hit.scene_hit && view.zooms() && -depth > std::max(least, view.zooming_near_mm);
    hit.faces_eye = depth > least || zoomed;
  }
}

}  // namespace catoptra::render
