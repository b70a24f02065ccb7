// Packets of hits behind optics that take their colours from maps instead of being shaded: mode exact.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "optics/ray_scene.h"
#include "render/src/map_colors.h"
#include "render/src/ray_tracer_exact.h"
#include "render/src/ray_tracer_lens_side.h"
#include "render/src/shading.h"

namespace catoptra::render {

/// One sample of a picture whose optics take their colours from maps as far as these know them.
struct MappedSample {
  const MapColors& maps;
  std::span<const std::uint8_t> marks;  ///< per pixel; where all of a packet are kOpticPixel, nothing stands
                                        ///< before the optics; or empty
  std::span<std::uint8_t> traced;       ///< per pixel, set to 1: an optic shows there what no map knows
  std::span<std::int32_t> owner;        ///< per pixel, set: the optic that shows there; -1: none
};

/// What maps know of the hits of 16 rays.
struct MapLanes {
  static constexpr int kLanes = ShadeLanes::kLanes;
  bool asked[kLanes] = {};
  MapAnswers answers{};

  [[nodiscard]] bool found(int lane) const { return answers.found[lane] != 0; }
  [[nodiscard]] Float4 radiance(int lane) const {
    return Float4{answers.red[lane], answers.green[lane], answers.blue[lane], 0};
  }
  [[nodiscard]] glm::vec3 shown(int lane) const {
    return {answers.shown_x[lane], answers.shown_y[lane], answers.shown_z[lane]};
  }
};

/// Asks for the colours of what `rays` (unit directions) have met, in lanes whose `optic` is one, by its
/// maps. Hits on other optics, numbers from `first_optic` on, are not in question: what those show depends on
/// the eye. `before_mm`: where the rays start behind the optic. `half_pixel`: see MapQueries.
void find_in_maps(const MapColors& maps, const optics::RayPacket16& rays,
                  const int (&optic)[MapLanes::kLanes], std::uint32_t first_optic, float before_mm,
                  const float (&half_pixel)[MapLanes::kLanes], MapLanes& lanes);

/// Half the least width of each pixel's beam at the hits, mm, less a fifth; behind rays that meet nothing its
/// angle, rad. The fifth: from one pixel to the next the beam's width is another, and pictures can only be
/// judged by such steps.
/// `pixel`: see CameraRays. A beam has its principal widths at right angles: 1 + t k times those at the
/// mirror, k the wavefront's principal curvatures.
void set_half_pixels(const MirrorRays& mirrored, const optics::RayPacket16& rays, double pixel,
                     const double (&stretch)[MapLanes::kLanes], float (&half_pixel)[MapLanes::kLanes]);
/// The same by ray differentials: the least singular value of the change by pixel.
void set_half_pixels(const BeamLanes& beams, const optics::RayPacket16& rays,
                     float (&half_pixel)[MapLanes::kLanes]);

}  // namespace catoptra::render
