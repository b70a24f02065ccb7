// The virtual view of a plane mirror, pixel for pixel on the picture's own grid.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>

#include "optics/virtual_view.h"
#include "render/src/raster_view.h"

namespace catoptra::render {

/// Seen in a plane, the scene is the picture of the mirrored camera; so the map can be that camera's picture
/// itself, with one texel per pixel and every texel's sample where the pixel's is. Nothing is then lost in
/// resampling.
struct PlaneView {
  optics::VirtualView view;
  glm::ivec2 texels;  ///< the pixels that the optic's box covers on the screen, and a border of one
};

/// All vertices within 1e-6 mm of one plane, normals within 1e-9 rad.
[[nodiscard]] bool is_plane(const optics::Optic& optic);

/// Nullopt where the optic is not plane (vertices within 1e-6 mm of one plane, normals within 1e-9 rad),
/// reaches beside or behind the eye, is not on the screen, or would need more than 4096 texels a side.
/// `camera`: without sample offset, of any perspective (a map's, too); `fitted`: the optic's view from
/// make_virtual_view, whose viewpoint is kept; `bounds`: of the whole scene.
[[nodiscard]] std::optional<PlaneView> plane_view(const optics::Optic& optic, const RasterView& camera,
                                                  const optics::VirtualView& fitted,
                                                  const cad_import::BoundingBox& bounds);

/// Offset of the samples in the texels of such a map that corresponds to `offset_px` in the pixels: the map
/// runs from right to left.
[[nodiscard]] inline glm::dvec2 plane_view_offset(glm::dvec2 offset_px) {
  return {-offset_px.x, offset_px.y};
}

}  // namespace catoptra::render
