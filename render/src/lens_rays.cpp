#include "render/src/lens_rays.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::render {
namespace {

using optics::LensPathEnd;
using optics::VertexHit;

constexpr std::size_t kVerticesPerTask = 64;

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

/// Gives vertices beside those with a ray the mean of what these rays' differentials ask for, weighted by the
/// inverse fourth power of their distance: what a differential leaves out grows with its square, and a near
/// neighbour's ray is not to be spoilt by a far one's.
void continue_once(const tessellate::OpticArrays& mesh, std::vector<VertexHit>& hits) {
  std::vector<VertexHit> sums(hits.size());
  std::vector<double> weights(hits.size(), 0);
  for_each_edge(mesh, [&](std::uint32_t from, std::uint32_t to) {
    // Where the surface looks away from the eye it cannot be continued.
    if (!hits[from].faces_eye || hits[to].faces_eye || hits[to].end == LensPathEnd::missed) return;
    const VertexHit& known = hits[from];
    const glm::dvec3 step = mesh.vertices[to].position_mm - mesh.vertices[from].position_mm;
    const double squared = glm::dot(step, step);
    if (!(squared > 0)) return;
    const double weight = 1 / (squared * squared);
    VertexHit& sum = sums[to];
    sum.surface_point_mm += weight * (known.surface_point_mm + known.differential.point * step);
    sum.direction += weight * (known.direction + known.differential.direction * step);
    sum.differential.point += weight * known.differential.point;
    sum.differential.direction += weight * known.differential.direction;
    sum.transmittance =
        weights[to] == 0 ? known.transmittance : std::max(sum.transmittance, known.transmittance);
    weights[to] += weight;
  });
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double all = weights[i];
    if (all == 0 || !(glm::length(sums[i].direction) > 0)) continue;
    VertexHit& hit = hits[i];
    hit.surface_point_mm = sums[i].surface_point_mm / all;
    hit.direction = glm::normalize(sums[i].direction);
    hit.differential = {sums[i].differential.point / all, sums[i].differential.direction / all};
    hit.transmittance = sums[i].transmittance;
    hit.faces_eye = true;
  }
}

/// The rays that a map has to hold: for vertices without one of their own, that where light begins to pass.
std::vector<VertexHit> rays_to_border(const optics::Optic& lens, const optics::LensTracer& tracer,
                                      const LensRays& rays, const ArrivalAt& arrival) {
  const auto& mesh = *optics::side_of(lens, rays.entered).mesh;
  const auto indices = optics::lens_indices(lens, rays.samples[0].wavelength_nm);
  const std::vector<VertexHit>& hits = rays.hits[0];
  std::vector<VertexHit> border = hits;
  for (VertexHit& hit : border) hit.faces_eye = passes(hit);
  std::vector<double> shares(hits.size(), 0.0);
  for_each_edge(mesh, [&](std::uint32_t from, std::uint32_t to) {
    if (!passes(hits[from]) || passes(hits[to]) || !(rays.open[0][to] > 0)) return;
    const VertexHit &a = hits[from], &b = hits[to];
    const LensBorder found = find_border(tracer, rays.entered, indices, arrival,
                                         mesh.vertices[from].position_mm, mesh.vertices[to].position_mm);
    if (!(found.blocked > shares[to])) return;
    shares[to] = found.blocked;
    // From the last path that passes on to the first that does not, as the continued ray goes.
    const bool own = found.passed == 0;
    const double rest = found.blocked - found.passed;
    border[to].surface_point_mm = (own ? a.surface_point_mm : found.path.exit.position_mm) +
                                  rest * (b.surface_point_mm - a.surface_point_mm);
    border[to].direction =
        glm::normalize((own ? a.direction : found.path.outside) + rest * (b.direction - a.direction));
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

std::vector<optics::Arrival> arrivals_at(const tessellate::OpticArrays& mesh, const ArrivalAt& arrival) {
  std::vector<optics::Arrival> arrivals(mesh.vertices.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, arrivals.size(), kVerticesPerTask),
                    [&](const auto& some) {
                      for (std::size_t i = some.begin(); i < some.end(); ++i)
                        arrivals[i] = arrival(mesh.vertices[i].position_mm);
                    });
  return arrivals;
}

void continue_beyond_border(const tessellate::OpticArrays& mesh, std::vector<VertexHit>& hits, int rings) {
  for (VertexHit& hit : hits) hit.faces_eye = passes(hit);
  for (int ring = 0; ring < rings; ++ring) continue_once(mesh, hits);
}

std::vector<float> ways_through(const tessellate::OpticArrays& mesh, std::span<const VertexHit> hits) {
  std::vector<float> open;
  open.reserve(hits.size());
  for (std::size_t i = 0; i < hits.size(); ++i)
    open.push_back(way_through(hits[i], mesh.vertices[i].position_mm));
  return open;
}

LensBorder find_border(const optics::LensTracer& tracer, optics::LensSide entered,
                       const optics::LensIndices& indices, const ArrivalAt& arrival,
                       const glm::dvec3& passing_mm, const glm::dvec3& blocked_mm) {
  LensBorder border;
  while (border.blocked - border.passed > kBorderShare) {
    const double middle = 0.5 * (border.passed + border.blocked);
    const optics::Arrival ray = arrival(passing_mm + middle * (blocked_mm - passing_mm));
    const optics::LensPath path = tracer.trace({ray.origin_mm, ray.direction}, entered, indices);
    if (path.end != LensPathEnd::passed) {
      border.blocked = middle;
      continue;
    }
    border.passed = middle;
    border.path = path;
  }
  return border;
}

LensRays refract_eye_rays(const optics::Optic& lens, const optics::LensTracer& tracer,
                          const glm::dvec3& eye_mm) {
  return refract_eye_rays(lens, tracer, optics::side_towards(lens, eye_mm), [&](const glm::dvec3& point_mm) {
    return optics::arrival_from_eye(eye_mm, point_mm);
  });
}

LensRays refract_eye_rays(const optics::Optic& lens, const optics::LensTracer& tracer,
                          optics::LensSide entered, const ArrivalAt& arrival) {
  LensRays rays{entered, samples_of(lens), {}, {}, {}};
  const auto& mesh = *optics::side_of(lens, rays.entered).mesh;
  const std::vector<optics::Arrival> arrivals = arrivals_at(mesh, arrival);
  for (const optics::SpectralSample& sample : rays.samples) {
    auto hits = optics::refract_vertices(lens, tracer, rays.entered, sample.wavelength_nm, arrivals);
    continue_beyond_border(mesh, hits, kRingsOfTessellated);
    rays.open.push_back(ways_through(mesh, hits));
    rays.hits.push_back(std::move(hits));
  }
  rays.border = rays_to_border(lens, tracer, rays, arrival);
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
