// What becomes of the eye's rays through a lens's vertices, at every wavelength of the picture (paper 4.5).
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "optics/lens_path.h"
#include "optics/spectrum.h"
#include "optics/vertex_hits.h"

namespace catoptra::render {

/// Per sample and vertex of the side entered. Beside a vertex whose light passes, one whose light does not
/// has the ray that it would have if the surfaces went on (`faces_eye` is set, `end` tells the reason), so
/// that the border of what is seen lies between the two.
struct LensRays {
  optics::LensSide entered = optics::LensSide::front;
  std::vector<optics::SpectralSample> samples;  ///< the reference wavelength first
  std::vector<std::vector<optics::VertexHit>> hits;

  /// Number of rays that pass, at all wavelengths.
  [[nodiscard]] std::size_t passed() const;
};

/// Above 0 where the path of a vertex passes; where it does not, the border lies half-way to a vertex of
/// value 1 if the ray is continued, and at that vertex if not.
[[nodiscard]] float openness(const optics::VertexHit& hit);

/// spectral_samples() with the middle one, to which geometry belongs, first.
[[nodiscard]] std::vector<optics::SpectralSample> samples_of(const optics::Optic& lens);

/// Without scene hits: depends on the positions of eye and lens alone.
[[nodiscard]] LensRays refract_eye_rays(const optics::Optic& lens, const optics::LensTracer& tracer,
                                        const glm::dvec3& eye_mm);

}  // namespace catoptra::render
