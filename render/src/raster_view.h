// A camera as the raster passes need it: rotation and projection about an origin kept in double precision.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "optics/placement.h"
#include "optics/virtual_view.h"
#include "render/scene.h"

namespace catoptra::render {

/// Right-handed eye space (x right, y up, -z ahead); clip depth reversed: near -> 1, far -> 0.
struct RasterView {
  glm::dvec3 origin_mm{0};                    ///< the eye; for a parallel projection, the origin of eye space
  glm::dmat3 rotation{1};                     ///< world axes to eye axes
  glm::dmat4 projection{1};                   ///< eye space to clip space
  glm::ivec2 size{1, 1};                      ///< pixels
  glm::ivec2 corner{0, 0};                    ///< of what is drawn, in the target: column and row
  float depth_of_far = 0, depth_of_near = 1;  ///< what is stored for clip depth 0 and 1; the greater hides
  /// What lies on the other side of a plane is not drawn: of a point p relative to the origin, in world axes,
  /// only dot(keep, (p, 1)) >= 0 is.
  glm::dvec4 keep{0, 0, 0, 1};
  bool bottom_row_first = false;  ///< row 0 of what is drawn is the bottom one (cube maps), else the top one

  [[nodiscard]] bool keeps_all() const { return keep == glm::dvec4(0, 0, 0, 1); }

  /// World position relative to the origin -> clip space.
  [[nodiscard]] glm::dmat4 clip_from_relative() const;

  /// Pixel coordinates (x right, y down, pixel centres at 0.5) of a world point; z > 0 where it lies ahead.
  [[nodiscard]] glm::dvec3 pixel(const glm::dvec3& point_mm) const;

  /// World direction seen at normalised device coordinates (x, y): center + x * dx + y * dy, not normalised.
  struct Directions {
    glm::dvec3 center, dx, dy;
  };
  [[nodiscard]] Directions directions() const;
};

/// The same view in the frame of an optic, and a view in that frame in the world.
[[nodiscard]] RasterView in_own_frame(RasterView view, const optics::Placement& placement);
[[nodiscard]] optics::VirtualView placed(optics::VirtualView view, const optics::Placement& placement);

/// The picture's view, camera.shift included: infinite far plane, near plane at kCameraNear. `offset_px`
/// moves the place in every pixel at which the scene is sampled: of a sample camera.offset_px.
[[nodiscard]] RasterView camera_view(const Camera& camera, glm::ivec2 size, glm::dvec2 offset_px = {0, 0});

/// The same view with the samples moved by `offset_px`, +x right, +y down.
[[nodiscard]] RasterView with_sample_offset(RasterView view, glm::dvec2 offset_px);

/// The reflection map's view; `offset_px` as above, in texels. Where it also shows a zooming region, the
/// reversed one has the lower half of the stored depths.
[[nodiscard]] RasterView map_view(const optics::VirtualView& view, glm::ivec2 size,
                                  glm::dvec2 offset_px = {0, 0});

/// The zooming region of the same map, texel by texel, to be drawn over it: it has the upper half of the
/// stored depths, turned round, since what is farther from the viewpoint is met first. `rotation` is a
/// reflection (VirtualView::zooming_view_matrix). Requires view.zooms().
[[nodiscard]] RasterView zooming_view(const optics::VirtualView& view, glm::ivec2 size,
                                      glm::dvec2 offset_px = {0, 0});

/// Face `face` (in OpenGL's order +x, -x, +y, -y, +z, -z) of a cube map around `center_mm`.
[[nodiscard]] RasterView cube_face_view(const glm::dvec3& center_mm, int face, int size);

/// Nearest visible distance of the camera, mm. Reversed floating-point depth is as precise for 1 mm as for 1
/// m.
inline constexpr double kCameraNear = 1.0;

}  // namespace catoptra::render
