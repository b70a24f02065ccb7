#include "render/src/lens_rays.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace catoptra::render {
namespace {

using optics::LensPathEnd;
using optics::VertexHit;

bool passes(const VertexHit& hit) {
  return hit.faces_eye && hit.end == LensPathEnd::passed;
}

/// Gives vertices beside passing ones the mean of what the rays of those ask for by their differentials.
void continue_beyond_border(const tessellate::OpticArrays& mesh, std::vector<VertexHit>& hits) {
  struct Sum {
    VertexHit hit;
    int count = 0;
  };
  std::vector<Sum> sums(hits.size());
  for (const auto& triangle : mesh.triangles)
    for (int k = 0; k < 6; ++k) {
      const std::uint32_t from = triangle.vertices[k % 3], to = triangle.vertices[(k + 1 + k / 3) % 3];
      // Where the surface looks away from the eye it cannot be continued.
      if (!passes(hits[from]) || passes(hits[to]) || hits[to].end == LensPathEnd::missed) continue;
      const VertexHit& known = hits[from];
      const glm::dvec3 step = mesh.vertices[to].position_mm - mesh.vertices[from].position_mm;
      VertexHit& sum = sums[to].hit;
      sum.surface_point_mm += known.surface_point_mm + known.differential.point * step;
      sum.direction += known.direction + known.differential.direction * step;
      sum.differential.point += known.differential.point;
      sum.differential.direction += known.differential.direction;
      sum.transmittance =
          ++sums[to].count == 1 ? known.transmittance : std::max(sum.transmittance, known.transmittance);
    }
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto& [sum, count] = sums[i];
    if (count == 0 || !(glm::length(sum.direction) > 0)) continue;
    VertexHit& hit = hits[i];
    hit.surface_point_mm = sum.surface_point_mm / double(count);
    hit.direction = glm::normalize(sum.direction);
    hit.differential = {sum.differential.point / double(count), sum.differential.direction / double(count)};
    hit.transmittance = sum.transmittance;
    hit.faces_eye = true;
  }
}

}  // namespace

std::size_t LensRays::passed() const {
  std::size_t count = 0;
  for (const auto& of_sample : hits)
    count += static_cast<std::size_t>(std::count_if(of_sample.begin(), of_sample.end(), passes));
  return count;
}

float openness(const VertexHit& hit) {
  constexpr float kClosed = -1e6f;
  return passes(hit) ? 1.0f : hit.faces_eye ? -1.0f : kClosed;
}

std::vector<optics::SpectralSample> samples_of(const optics::Optic& lens) {
  auto samples = optics::spectral_samples(lens.wavelengths);
  std::swap(samples[0], samples[samples.size() / 2]);
  return samples;
}

LensRays refract_eye_rays(const optics::Optic& lens, const optics::LensTracer& tracer,
                          const glm::dvec3& eye_mm) {
  LensRays rays{optics::side_towards(lens, eye_mm), samples_of(lens), {}};
  for (const optics::SpectralSample& sample : rays.samples) {
    auto hits = optics::refract_vertices(lens, tracer, rays.entered, sample.wavelength_nm, eye_mm);
    continue_beyond_border(*optics::side_of(lens, rays.entered).mesh, hits);
    rays.hits.push_back(std::move(hits));
  }
  return rays;
}

}  // namespace catoptra::render
