// What becomes of the eye's rays through a lens's vertices, at every wavelength of the picture (paper 4.5).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "optics/lens_path.h"
#include "optics/spectrum.h"
#include "optics/vertex_hits.h"
#include "optics/virtual_view.h"

namespace catoptra::render {

/// Per sample and vertex of the side entered. Beside a vertex whose light passes, one whose light does not
/// has the ray that it would have if the surfaces went on (`faces_eye` is set, `end` tells the reason), since
/// the border of what is seen lies between the two.
struct LensRays {
  optics::LensSide entered = optics::LensSide::front;
  std::vector<optics::SpectralSample> samples;  ///< the reference wavelength first
  std::vector<std::vector<optics::VertexHit>> hits;
  /// The way through the glass, mm, which the border of what is seen has at 0: negative where the surfaces
  /// have crossed before or light is totally reflected, hugely so where nothing is known. That the exit
  /// surface ends is not in it: see LensMask.
  std::vector<std::vector<float>> open;
  /// Per vertex at the reference wavelength, only with what light passes (`faces_eye`); beside those the ray
  /// at the border: together the rays that a map has to hold.
  std::vector<optics::VertexHit> border;

  /// Number of rays that pass, at all wavelengths.
  [[nodiscard]] std::size_t passed() const;
};

[[nodiscard]] bool passes(const optics::VertexHit& hit);

/// spectral_samples() with the middle one, to which geometry belongs, first.
[[nodiscard]] std::vector<optics::SpectralSample> samples_of(const optics::Optic& lens);

/// Without scene hits: depends on the positions of eye and lens alone.
[[nodiscard]] LensRays refract_eye_rays(const optics::Optic& lens, const optics::LensTracer& tracer,
                                        const glm::dvec3& eye_mm);
/// The same from a given side.
[[nodiscard]] LensRays refract_eye_rays(const optics::Optic& lens, const optics::LensTracer& tracer,
                                        const glm::dvec3& eye_mm, optics::LensSide entered);
/// The same of light that comes to the vertices of that side by other optics, about as if from `eye_mm`.
[[nodiscard]] LensRays refract_eye_rays(const optics::Optic& lens, const optics::LensTracer& tracer,
                                        const glm::dvec3& eye_mm, optics::LensSide entered,
                                        std::span<const optics::Arrival> arrivals);

/// Closes vertices whose ray, continued beyond the border, has no place in the map. `patch`: per vertex,
/// which of `views` is its map's; empty: the first.
void close_off_maps(std::vector<optics::VertexHit>& hits, std::span<const std::uint32_t> patch,
                    std::span<const optics::VirtualView> views);

}  // namespace catoptra::render
