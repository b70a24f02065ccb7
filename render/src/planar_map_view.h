// The views of a planar optic's maps, each on the grid of the view that shows the optic.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "optics/planar_view.h"
#include "render/src/raster_view.h"

namespace catoptra::render {

/// A polygon in pixel coordinates of a view.
using PixelPolygon = std::vector<glm::dvec2>;

/// Pixels of a view: from `begin` on, before `end`.
struct PixelRect {
  glm::ivec2 begin{0}, end{0};
  [[nodiscard]] glm::ivec2 size() const { return end - begin; }
};

/// The corners of the convex hull of points of a plane, in order.
[[nodiscard]] std::vector<glm::dvec3> convex_hull(std::span<const glm::dvec3> points,
                                                  const glm::dvec3& normal);

/// The part of a convex polygon that `view` sees: before its eye, within its picture and on the side of
/// RasterView::keep. World positions; fewer than three: none.
[[nodiscard]] std::vector<glm::dvec3> seen_part(const RasterView& view, std::span<const glm::dvec3> polygon);

/// In pixel coordinates; every point lies before the eye.
[[nodiscard]] PixelPolygon in_pixels(const RasterView& view, std::span<const glm::dvec3> polygon);

/// The part of `polygon` within the convex `window`, which is taken `room_px` wider on each side.
[[nodiscard]] PixelPolygon clipped(const PixelPolygon& polygon, const PixelPolygon& window, double room_px);

/// The point of the convex `polygon` nearest to `place`.
[[nodiscard]] glm::dvec2 nearest_point(const PixelPolygon& polygon, glm::dvec2 place);

/// The pixels that a polygon reaches, with one more on each side for sample offsets, within `size`.
[[nodiscard]] PixelRect pixel_rect(const PixelPolygon& polygon, glm::ivec2 size);

/// The point of the plane that a pixel of `view` shows.
[[nodiscard]] glm::dvec3 point_on_plane(const RasterView& view, const optics::Plane& plane, glm::dvec2 pixel);

/// What becomes of light at a planar optic, seen from one eye.
enum class PlanarWay { reflected, refracted, displaced };
struct PlanarTurn {
  PlanarWay way = PlanarWay::reflected;
  optics::Plane plane;   ///< of the optic; reflected light: of the mirror, which rough faces tilt
  glm::dvec3 eye_mm{0};  ///< refracted and displaced light: its eye
  glm::dvec3 ahead{0};   ///< refracted light: unit axis of its camera
};

/// The map of `turn` on the pixels `rect` of `above` (which has its sample offset): texel (x, y) shows what
/// pixel rect.begin + (x, y) of `above` sees by way of the optic; of reflected light (width - 1 - x, y), so
/// that the view stays right-handed. Stored depth is `near` / w, w being the clip w of `above` continued
/// along the ray: it falls along every ray from the eye on, also after the map of the refracted picture,
/// since that w grows with the distance from the new eye. `keep`: plane before which nothing is drawn, its
/// normal towards what is.
[[nodiscard]] RasterView planar_map_view(const RasterView& above, const PlanarTurn& turn,
                                         const PixelRect& rect, double near, const optics::Plane& keep);

}  // namespace catoptra::render
