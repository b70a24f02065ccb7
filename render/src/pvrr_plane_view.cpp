#include "render/src/pvrr_plane_view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "optics/reflection.h"

namespace catoptra::render {
namespace {

constexpr double kFlatness = 1e-6;      // mm
constexpr double kNormalSpread = 1e-9;  // rad
constexpr int kLargest = 4096;
// Depth over distance: a vertex beside or behind the eye, 84 degrees or more off the axis, has no place on
// the map.
constexpr double kLeastDepth = 0.1;

/// Pixels that the optic's box covers, clipped to the picture, with a border of one: begin and end corner.
struct PixelBox {
  glm::dvec2 begin, end;
};

std::optional<PixelBox> pixel_box(const optics::Optic& optic, const RasterView& camera) {
  PixelBox box{glm::dvec2(camera.size), glm::dvec2(0)};
  for (const auto& vertex : optic.mesh.vertices) {
    const glm::dvec3 pixel = camera.pixel(vertex.position_mm);
    if (pixel.z < kLeastDepth * glm::distance(vertex.position_mm, camera.origin_mm)) return std::nullopt;
    box.begin = glm::min(box.begin, glm::dvec2(pixel));
    box.end = glm::max(box.end, glm::dvec2(pixel));
  }
  box.begin = glm::max(glm::floor(box.begin), glm::dvec2(0)) - 1.0;
  box.end = glm::min(glm::ceil(box.end), glm::dvec2(camera.size)) + 1.0;
  if (box.end.x - box.begin.x <= 2 || box.end.y - box.begin.y <= 2) return std::nullopt;
  return box;
}

double nearest_depth(const optics::Optic& optic, const optics::VirtualView& view) {
  double nearest = optics::kInfinity;
  for (const auto& vertex : optic.mesh.vertices)
    nearest = std::min(nearest, glm::dot(vertex.position_mm - view.viewpoint_mm, view.direction));
  // A little before the mirror, so that what touches it is not cut; the optic's own depth cuts the rest.
  return 0.99 * nearest;
}

double farthest_distance(const glm::dvec3& from, const cad_import::BoundingBox& box) {
  double farthest = 0;
  for (int corner = 0; corner < 8; ++corner)
    farthest = std::max(farthest, glm::distance(from, glm::dvec3(corner & 1 ? box.max.x : box.min.x,
                                                                 corner & 2 ? box.max.y : box.min.y,
                                                                 corner & 4 ? box.max.z : box.min.z)));
  return 1.01 * farthest;
}

}  // namespace

bool is_plane(const optics::Optic& optic) {
  const auto& vertices = optic.mesh.vertices;
  if (vertices.empty()) return false;
  const glm::dvec3 &point = vertices[0].position_mm, &normal = vertices[0].normal;
  return std::all_of(vertices.begin(), vertices.end(), [&](const auto& v) {
    return std::abs(glm::dot(v.position_mm - point, normal)) < kFlatness &&
           glm::length(v.normal - normal) < kNormalSpread;
  });
}

std::optional<PlaneView> plane_view(const optics::Optic& optic, const RasterView& camera,
                                    const optics::VirtualView& fitted,
                                    const cad_import::BoundingBox& bounds) {
  if (fitted.projection != optics::MapProjection::perspective || !is_plane(optic)) return std::nullopt;
  // A parallel projection, or the skewed one behind a refractor.
  if (camera.projection[2][3] != -1 || camera.projection[0][3] != 0 || camera.projection[1][3] != 0)
    return std::nullopt;
  const auto box = pixel_box(optic, camera);
  if (!box) return std::nullopt;
  const glm::ivec2 texels(box->end - box->begin);
  if (std::max(texels.x, texels.y) > kLargest) return std::nullopt;

  // The camera's axes mirrored in the plane; since a reflection turns right-handed into left-handed, its
  // right becomes the map's left.
  const glm::dmat3 axes = glm::transpose(camera.rotation);
  const glm::dvec3& normal = optic.mesh.vertices[0].normal;
  PlaneView plane{fitted, texels};
  optics::VirtualView& view = plane.view;
  view.right = -optics::reflect(axes[0], normal);
  view.up = optics::reflect(axes[1], normal);
  view.direction = -optics::reflect(axes[2], normal);

  // Pixel coordinates to tangents, as the camera has them; a map's axis is not in its middle.
  const glm::dmat4& p = camera.projection;
  const auto tangent_x = [&](double x) { return (2 * x / camera.size.x - 1 + p[2][0]) / p[0][0]; };
  const auto tangent_y = [&](double y) { return (1 - 2 * y / camera.size.y + p[2][1]) / p[1][1]; };
  view.left = -tangent_x(box->end.x);
  view.right_side = -tangent_x(box->begin.x);
  view.bottom = tangent_y(box->end.y);
  view.top = tangent_y(box->begin.y);
  view.near_mm = nearest_depth(optic, view);
  view.far_mm = std::max(farthest_distance(view.viewpoint_mm, bounds), 2 * view.near_mm + 1);
  view.fov_rad = {std::atan(view.right_side) - std::atan(view.left),
                  std::atan(view.top) - std::atan(view.bottom)};
  return plane;
}

}  // namespace catoptra::render
