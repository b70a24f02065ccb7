// What becomes of the eye's rays through a lens's vertices, at every wavelength of the picture (paper 4.5).
#pragma once

#include <cstdint>
#include <functional>
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

/// How light comes from the eye to any point of the side entered.
using ArrivalAt = std::function<optics::Arrival(const glm::dvec3& point_mm)>;

/// At every vertex of `mesh`.
[[nodiscard]] std::vector<optics::Arrival> arrivals_at(const tessellate::OpticArrays& mesh,
                                                       const ArrivalAt& arrival);

/// Without scene hits: depends on the positions of eye and lens alone.
[[nodiscard]] LensRays refract_eye_rays(const optics::Optic& lens, const optics::LensTracer& tracer,
                                        const glm::dvec3& eye_mm);
/// The same from a given side, of light that comes to it in any way.
[[nodiscard]] LensRays refract_eye_rays(const optics::Optic& lens, const optics::LensTracer& tracer,
                                        optics::LensSide entered, const ArrivalAt& arrival);

/// Gives vertices beside those whose light passes the ray that their neighbours' differentials ask for, the
/// nearest most; what vertices had been given so before is forgotten. `rings`: as many times, each time from
/// those that have one by then.
void continue_beyond_border(const tessellate::OpticArrays& mesh, std::vector<optics::VertexHit>& hits,
                            int rings);
/// So many in a mesh as tessellated, where a corner may have none but continued neighbours. In a refined one
/// a triangle that light passes has a corner where it does.
inline constexpr int kRingsOfTessellated = 2, kRingsOfRefined = 1;

/// LensRays::open of each vertex.
[[nodiscard]] std::vector<float> ways_through(const tessellate::OpticArrays& mesh,
                                              std::span<const optics::VertexHit> hits);

/// Where, on the flat way from a vertex whose light passes to one whose light does not, it stops passing.
struct LensBorder {
  double passed = 0, blocked = 1;  ///< shares of the way between which that is
  optics::LensPath path;           ///< that of `passed`; `end` is missed where the vertex itself is meant
};
/// By bisection, until `passed` and `blocked` are kBorderShare apart.
[[nodiscard]] LensBorder find_border(const optics::LensTracer& tracer, optics::LensSide entered,
                                     const optics::LensIndices& indices, const ArrivalAt& arrival,
                                     const glm::dvec3& passing_mm, const glm::dvec3& blocked_mm);
inline constexpr double kBorderShare = 1.0 / 16;
inline constexpr std::size_t kBorderPaths = 4;  ///< that find_border() traces

/// Closes vertices whose ray, continued beyond the border, has no place in the map. `patch`: per vertex,
/// which of `views` is its map's; empty: the first.
void close_off_maps(std::vector<optics::VertexHit>& hits, std::span<const std::uint32_t> patch,
                    std::span<const optics::VirtualView> views);

}  // namespace catoptra::render
