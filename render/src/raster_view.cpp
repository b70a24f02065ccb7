#include "render/src/raster_view.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/src/sampling.h"

namespace catoptra::render {
namespace {

/// Rows are the eye's axes in the world.
glm::dmat3 rotation_from_axes(const glm::dvec3& right, const glm::dvec3& up, const glm::dvec3& ahead) {
  return glm::transpose(glm::dmat3(right, up, -ahead));
}

/// Perspective with reversed depth and no far plane: depth = near / distance.
glm::dmat4 infinite_perspective(double tan_half_x, double tan_half_y, double near_mm) {
  glm::dmat4 m(0);
  m[0][0] = 1 / tan_half_x;
  m[1][1] = 1 / tan_half_y;
  m[2][3] = -1;
  m[3][2] = near_mm;
  return m;
}

/// Moves the picture so that each pixel's centre shows what was at `offset_px` from it. Clip y runs against
/// pixel y.
void offset_samples(glm::dmat4& projection, glm::ivec2 size, glm::dvec2 offset_px) {
  for (int column = 0; column < 4; ++column) {
    projection[column][0] -= 2 * offset_px.x / size.x * projection[column][3];
    projection[column][1] += 2 * offset_px.y / size.y * projection[column][3];
  }
}

RasterView view_by(const glm::dmat4& eye_from_world, const glm::dmat4& projection, glm::ivec2 size,
                   glm::dvec2 offset_px) {
  RasterView raster;
  raster.rotation = glm::dmat3(eye_from_world);
  raster.origin_mm = -(glm::transpose(raster.rotation) * glm::dvec3(eye_from_world[3]));
  raster.projection = projection;
  raster.size = size;
  offset_samples(raster.projection, size, offset_px);
  return raster;
}

}  // namespace

glm::dmat4 RasterView::clip_from_relative() const {
  return projection * glm::dmat4(rotation);
}

glm::dvec3 RasterView::pixel(const glm::dvec3& point_mm) const {
  const glm::dvec4 clip = clip_from_relative() * glm::dvec4(point_mm - origin_mm, 1);
  return {(0.5 + 0.5 * clip.x / clip.w) * size.x, (0.5 - 0.5 * clip.y / clip.w) * size.y, clip.w};
}

RasterView::Directions RasterView::directions() const {
  const glm::dmat3 to_world = glm::transpose(rotation);
  if (projection[2][3] == 0) return {to_world * glm::dvec3(0, 0, -1), glm::dvec3(0), glm::dvec3(0)};
  const bool skewed = projection[1][0] != 0 || projection[0][1] != 0 || projection[0][3] != 0 ||
                      projection[1][3] != 0 || projection[2][3] != -1;
  if (skewed) {
    // Any projective picture (of light that glass has refracted): directions d with image * d = (x, y, 1).
    const glm::dmat4 clip = clip_from_relative();
    const auto row = [&](int r) { return glm::dvec3(clip[0][r], clip[1][r], clip[2][r]); };
    const glm::dmat3 direction_of = glm::inverse(glm::transpose(glm::dmat3(row(0), row(1), row(3))));
    return {direction_of[2], direction_of[0], direction_of[1]};
  }
  // Perspective: clip x = p00 x + p20 z, clip w = -z; solved for the eye-space direction with z = -1.
  const auto eye = [&](double x, double y) {
    return glm::dvec3((x + projection[2][0]) / projection[0][0], (y + projection[2][1]) / projection[1][1],
                      -1);
  };
  const glm::dvec3 center = to_world * eye(0, 0);
  return {center, to_world * eye(1, 0) - center, to_world * eye(0, 1) - center};
}

RasterView in_own_frame(RasterView view, const optics::Placement& placement) {
  view.origin_mm = placement.own_point(view.origin_mm);
  view.rotation = view.rotation * placement.rotation;
  view.keep = glm::dvec4(placement.own_direction(glm::dvec3(view.keep)), view.keep.w);
  return view;
}

optics::VirtualView placed(optics::VirtualView view, const optics::Placement& placement) {
  view.viewpoint_mm = placement.point(view.viewpoint_mm);
  view.direction = placement.direction(view.direction);
  view.up = placement.direction(view.up);
  view.right = placement.direction(view.right);
  return view;
}

RasterView camera_view(const Camera& camera, glm::ivec2 size, glm::dvec2 offset_px) {
  const CameraAxes axes = camera_axes(camera);
  const double tan_half = std::tan(camera.fov_rad / 2);
  RasterView view;
  view.origin_mm = camera.eye_mm;
  view.rotation = rotation_from_axes(axes.right, axes.up, axes.forward);
  view.projection = infinite_perspective(tan_half * size.x / size.y, tan_half, kCameraNear);
  // Eye space has z = -1 where the tangents are x and y: see directions().
  view.projection[2][0] = view.projection[0][0] * camera.shift.x;
  view.projection[2][1] = view.projection[1][1] * camera.shift.y;
  view.size = size;
  offset_samples(view.projection, size, offset_px);
  return view;
}

RasterView with_sample_offset(RasterView view, glm::dvec2 offset_px) {
  offset_samples(view.projection, view.size, offset_px);
  return view;
}

RasterView map_view(const optics::VirtualView& view, glm::ivec2 size, glm::dvec2 offset_px) {
  RasterView raster = view_by(view.view_matrix(), view.projection_matrix(), size, offset_px);
  if (view.zooms()) raster.depth_of_near = 0.5f;
  return raster;
}

RasterView zooming_view(const optics::VirtualView& view, glm::ivec2 size, glm::dvec2 offset_px) {
  RasterView raster = view_by(view.zooming_view_matrix(), view.zooming_projection_matrix(), size, offset_px);
  raster.depth_of_near = 0.5f;
  raster.depth_of_far = 1;
  return raster;
}

RasterView cube_face_view(const glm::dvec3& center_mm, int face, int size) {
  // OpenGL 4.5, table 8.19: on face +x the texture's s runs along -z and t along -y, and so on: left-handed
  // where row 0 is the top, so that a right-handed view has t for its up vector and fills the bottom row
  // first.
  struct Axes {
    glm::dvec3 ahead, s, t;
  };
  static constexpr std::array<Axes, 6> kFaces{{{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                               {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                               {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                               {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                               {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},
                                               {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}}};
  const Axes& axes = kFaces.at(static_cast<std::size_t>(face));
  RasterView view;
  view.origin_mm = center_mm;
  view.rotation = rotation_from_axes(axes.s, axes.t, axes.ahead);
  view.projection = infinite_perspective(1, 1, kCameraNear);
  view.size = {size, size};
  view.bottom_row_first = true;
  return view;
}

}  // namespace catoptra::render
