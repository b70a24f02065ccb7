// By how many pixels what interpolation shows on an optic is off the exact ray (docs/decisions/0008).
#pragma once

#include <array>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "optics/vertex_hits.h"
#include "optics/virtual_view.h"
#include "render/src/raster_view.h"

namespace catoptra::render {

/// How the picture moves with a point of the optic.
struct PicturePlace {
  glm::dvec3 right{0}, up{0};  ///< unit, across the eye's ray
  glm::dmat2 pixels{0};        ///< pixels per mm of movement along them
};
[[nodiscard]] PicturePlace picture_place(const RasterView& camera, const glm::dvec3& at_mm);

/// Whether a triangle between three places in the picture (pixels, and depth) lies outside it on one side.
[[nodiscard]] bool off_screen(const RasterView& camera, const std::array<glm::dvec3, 3>& corners);

/// 1 / distance from the optic to what the ray meets; 0: the sky.
[[nodiscard]] double nearness(const optics::VertexHit& hit);

/// The exact ray, to second order, through a place `offset_mm` beside that of `middle`. It is given a hit at
/// 1 / `near`: not the scene's own, so that where the ends of an edge meet different things no step of depth
/// passes for an error of interpolation.
[[nodiscard]] optics::VertexHit ray_through(const optics::VertexHit& middle, const glm::dvec3& offset_mm,
                                            double near);

/// Map coordinates shown (homogeneous) less those of `ray` (not homogeneous).
[[nodiscard]] glm::dvec2 map_off(const optics::VirtualView& view, const glm::dvec3& shown,
                                 const optics::VertexHit& ray);

/// The step on the picture, in pixels, over which the exact rays turn as far as from `ray` to what is shown
/// instead, from where the map shows it: `off` in map coordinates.
[[nodiscard]] double map_error_px(const PicturePlace& place, const optics::VirtualView& view,
                                  const optics::VertexHit& ray, double near, double eye_distance_mm,
                                  glm::dvec2 off);

/// The step on the picture, in pixels, over which the rays' points on the optic move by `off_mm`.
[[nodiscard]] double surface_error_px(const PicturePlace& place, const optics::VertexHit& ray,
                                      const glm::dvec3& off_mm);

}  // namespace catoptra::render
