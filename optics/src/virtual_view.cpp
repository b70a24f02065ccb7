#include "optics/virtual_view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "cad_import/error.h"

namespace catoptra::optics {
namespace {

// The widest volume, rad: beyond it a plane map spends nearly all texels on its border.
constexpr double kWidestFov = 150.0 / 180.0 * 3.14159265358979323846;

// Relative anisotropy of the curvatures below which a surface counts as a sphere or plane without principal
// directions.
constexpr double kUmbilic = 1e-3;

// The lines of the vertices that show something, in one or several wavelengths.
struct Bundle {
  std::vector<glm::dvec3> points, directions;
  std::vector<std::size_t> hits;      // index in the hits
  std::vector<std::size_t> vertices;  // index in the mesh
};

Bundle bundle_of(const Optic& optic, const tessellate::OpticArrays& mesh, std::span<const VertexHit> hits) {
  const std::size_t count = mesh.vertices.size();
  if (hits.empty() || count == 0 || hits.size() % count != 0)
    throw Error(
        "", optic.name,
        "has " + std::to_string(count) + " vertices but " + std::to_string(hits.size()) + " traced rays");
  Bundle bundle;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i].faces_eye) continue;
    bundle.points.push_back(hits[i].surface_point_mm);
    bundle.directions.push_back(hits[i].direction);
    bundle.hits.push_back(i);
    bundle.vertices.push_back(i % count);
  }
  if (bundle.points.empty())
    throw Error(
        "", optic.name,
        optic.kind == OpticKind::lens ? "no ray from the eye passes it" : "no part of it faces the eye",
        optic.kind == OpticKind::lens ? "move the eye, or turn the lens"
                                      : "move the eye, or flip the mirror");
  return bundle;
}

// A symmetric 2 x 2 tensor in the plane across `axis`, summed from axial directions (d and -d are the same).
struct PlaneTensor {
  glm::dvec3 e1, e2;
  double xx = 0, xy = 0, yy = 0;

  void add(const glm::dvec3& v, double weight) {
    const double x = glm::dot(v, e1), y = glm::dot(v, e2);
    xx += weight * x * x;
    xy += weight * x * y;
    yy += weight * y * y;
  }
  double anisotropy() const { return 2 * std::hypot(0.5 * (xx - yy), xy); }
  glm::dvec3 largest_direction() const {
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    return std::cos(angle) * e1 + std::sin(angle) * e2;
  }
};

PlaneTensor tensor_across(const glm::dvec3& axis) {
  const glm::dvec3 helper = std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 e1 = glm::normalize(glm::cross(axis, helper));
  return {e1, glm::cross(e1, axis)};
}

// Up along the direction of least curvature (paper 4.3), averaged over the vertices that face the eye with
// the difference of the curvatures as weight. Planes and spheres have none: there up is across the longer
// side of the optic.
glm::dvec3 up_vector(const tessellate::OpticArrays& mesh, const Bundle& bundle, const glm::dvec3& axis) {
  PlaneTensor most_curved = tensor_across(axis), extent = tensor_across(axis);
  double curvature = 0;
  glm::dvec3 centroid{0};
  for (const auto& p : bundle.points) centroid += p / static_cast<double>(bundle.points.size());
  for (const std::size_t i : bundle.vertices) {
    const auto& vertex = mesh.vertices[i];
    most_curved.add(vertex.direction1, vertex.k1 - vertex.k2);
    extent.add(vertex.position_mm - centroid, 1);
    curvature += std::abs(vertex.k1) + std::abs(vertex.k2);
  }
  glm::dvec3 right = tensor_across(axis).e1;
  if (most_curved.anisotropy() > kUmbilic * curvature)
    right = most_curved.largest_direction();
  else if (extent.anisotropy() > kUmbilic * (extent.xx + extent.yy))
    right = extent.largest_direction();
  const glm::dvec3 up = glm::normalize(glm::cross(right, axis));
  // Of the two senses the one nearer to the world's up, so that the map does not turn over while the eye
  // moves.
  return glm::dot(up, tensor_across(axis).e2) < 0 ? -up : up;
}

// Running bounds of tangents (perspective) or lengths (parallel) on the map's plane.
struct Sides {
  double left = kInfinity, right = -kInfinity, bottom = kInfinity, top = -kInfinity;

  void hold(double x, double y) {
    left = std::min(left, x);
    right = std::max(right, x);
    bottom = std::min(bottom, y);
    top = std::max(top, y);
  }
};

void set_sides(VirtualView& view, Sides sides, double margin) {
  // A map of no width (a single ray, a line of them) still needs some.
  const double least = 1e-6 * std::max({1.0, std::abs(sides.left), std::abs(sides.top)});
  const double border_x = std::max(margin * (sides.right - sides.left), least);
  const double border_y = std::max(margin * (sides.top - sides.bottom), least);
  view.left = sides.left - border_x;
  view.right_side = sides.right + border_x;
  view.bottom = sides.bottom - border_y;
  view.top = sides.top + border_y;
}

double farthest_depth(const VirtualView& view, const cad_import::BoundingBox& box) {
  double farthest = -kInfinity;
  if (box.empty()) return farthest;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                       corner & 4 ? box.max.z : box.min.z};
    farthest = std::max(farthest, glm::dot(p - view.viewpoint_mm, view.direction));
  }
  return farthest;
}

void set_far(VirtualView& view, const cad_import::BoundingBox& box) {
  const double farthest = farthest_depth(view, box);
  const double room = std::max(1.0, 0.01 * std::abs(farthest));
  view.far_mm = std::max(std::isfinite(farthest) ? farthest + room : 0.0, 2 * view.near_mm + 1);
}

void make_parallel(VirtualView& view, const Bundle& bundle, const cad_import::BoundingBox& box,
                   double margin) {
  view.projection = MapProjection::parallel;
  double nearest = kInfinity;
  for (const auto& p : bundle.points)
    nearest = std::min(nearest, glm::dot(p - view.viewpoint_mm, view.direction));
  view.viewpoint_mm += (nearest - 1) * view.direction;  // 1 mm before the optic's nearest vertex
  view.near_mm = 0;
  set_far(view, box);
  Sides sides;
  for (std::size_t i = 0; i < bundle.points.size(); ++i)
    for (const double t : {0.0, view.far_mm}) {
      const glm::dvec3 p = bundle.points[i] + t * bundle.directions[i] - view.viewpoint_mm;
      sides.hold(glm::dot(p, view.right), glm::dot(p, view.up));
    }
  set_sides(view, sides, margin);
}

// Where the regions on both sides of the point at which rays converge start. Every line passes the viewpoint
// at some distance, and just beyond and before it those distances fill the whole view; farther off they
// hardly widen it, but what stands nearer is lost. So: as near as the nearest thing that a vertex sees asks
// for, but no farther than where the misses widen the map by half.
void set_near_planes(VirtualView& view, const Bundle& bundle, std::span<const VertexHit> hits) {
  double miss = 0, slope = 0, nearest_beyond = kInfinity, nearest_before = kInfinity, farthest_before = 0;
  for (std::size_t i = 0; i < bundle.points.size(); ++i) {
    const glm::dvec3& d = bundle.directions[i];
    const glm::dvec3 start = bundle.points[i] - view.viewpoint_mm;
    const double along = glm::dot(d, view.direction);
    miss = std::max(miss, glm::length(glm::cross(start, d)));
    if (along > 0) slope = std::max(slope, glm::length(d - along * view.direction) / along);
    farthest_before = std::max(farthest_before, -glm::dot(start, view.direction));
    const VertexHit& hit = hits[bundle.hits[i]];
    if (!hit.scene_hit) continue;
    const double depth = glm::dot(hit.hit_point_mm - view.viewpoint_mm, view.direction);
    (depth > 0 ? nearest_beyond : nearest_before) =
        std::min(depth > 0 ? nearest_beyond : nearest_before, std::abs(depth));
  }
  const double wider = miss / std::max(0.25 * slope, 1e-9);
  view.near_mm = std::max({1.0, miss, std::min(wider, 0.5 * nearest_beyond)});
  view.zooming_near_mm = std::max({1.0, miss, std::min(wider, 0.5 * nearest_before)});
  // A little farther than the optic, whose facets may sag.
  view.zooming_far_mm = 1.01 * farthest_before + 1;
}

// Holds the part of each ray beyond the near plane, and that in the zooming region: a segment projects to the
// segment between its ends.
void set_perspective_sides(VirtualView& view, const Bundle& bundle, double margin) {
  const double widest = std::tan(0.5 * kWidestFov);
  Sides sides;
  const auto hold = [&](const glm::dvec3& v) {
    const double depth = glm::dot(v, view.direction);
    double x = glm::dot(v, view.right), y = glm::dot(v, view.up);
    const double limit = widest * std::max(depth, 0.0);
    if (std::abs(x) > limit || std::abs(y) > limit) view.fov_clamped = true;
    if (depth > 0) {
      x = std::clamp(x / depth, -widest, widest);
      y = std::clamp(y / depth, -widest, widest);
    } else {  // beside or behind the viewpoint: the border in that direction
      const double scale = widest / std::max({std::abs(x), std::abs(y), 1e-300});
      x *= scale;
      y *= scale;
    }
    sides.hold(x, y);
  };
  for (std::size_t i = 0; i < bundle.points.size(); ++i) {
    const glm::dvec3 start = bundle.points[i] - view.viewpoint_mm, d = bundle.directions[i];
    const double depth = glm::dot(start, view.direction), along = glm::dot(d, view.direction);
    hold(d);
    if (depth >= view.near_mm)
      hold(start);
    else if (along > 0)
      hold(start + (view.near_mm - depth) / along * d);
    if (!view.zooms() || depth > -view.zooming_near_mm || !(along > 0)) continue;
    hold(-start);  // seen from the viewpoint in the opposite direction
    hold(-(start + (-view.zooming_near_mm - depth) / along * d));
  }
  set_sides(view, sides, margin);
  view.fov_rad = {std::atan(view.right_side) - std::atan(view.left),
                  std::atan(view.top) - std::atan(view.bottom)};
}

VirtualView view_of_mesh(const Optic& optic, const tessellate::OpticArrays& mesh,
                         std::span<const VertexHit> hits, const cad_import::BoundingBox& scene_bounds,
                         double margin) {
  const Bundle bundle = bundle_of(optic, mesh, hits);
  const ViewpointFit fit = fit_viewpoint(bundle.points, bundle.directions);
  VirtualView view;
  view.viewpoint_mm = fit.viewpoint_mm;
  view.residual_mm = fit.residual_mm;
  glm::dvec3 sum{0};
  for (const auto& d : bundle.directions) sum += d;
  view.direction = glm::length(sum) > 0 ? glm::normalize(sum) : bundle.directions[0];
  view.up = up_vector(mesh, bundle, view.direction);
  view.right = glm::cross(view.direction, view.up);
  if (fit.parallel) {
    make_parallel(view, bundle, scene_bounds, margin);
    return view;
  }

  double nearest = kInfinity, farthest = 0, distance_along_rays = 0;
  for (std::size_t i = 0; i < bundle.points.size(); ++i) {
    const glm::dvec3 offset = bundle.points[i] - view.viewpoint_mm;
    const double depth = glm::dot(offset, view.direction);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, std::abs(depth));
    distance_along_rays += glm::dot(offset, bundle.directions[i]);
  }
  // Rays that have yet to reach the viewpoint when they leave the optic converge: the map shows what lies
  // beyond it.
  view.beyond_viewpoint = distance_along_rays < 0;
  if (view.beyond_viewpoint)
    set_near_planes(view, bundle, hits);
  else  // nothing that a ray meets is nearer than the nearest point of the optic; facets may sag by a little
    view.near_mm = std::max({0.99 * nearest, 1e-3 * farthest, 1e-3});
  set_far(view, scene_bounds);
  set_perspective_sides(view, bundle, margin);
  return view;
}

}  // namespace

VirtualView make_virtual_view(const Optic& optic, std::span<const VertexHit> hits,
                              const cad_import::BoundingBox& scene_bounds, double margin) {
  return view_of_mesh(optic, optic.mesh, hits, scene_bounds, margin);
}

VirtualView make_virtual_view(const Optic& optic, const tessellate::OpticArrays& mesh,
                              std::span<const VertexHit> hits, const cad_import::BoundingBox& scene_bounds,
                              double margin) {
  return view_of_mesh(optic, mesh, hits, scene_bounds, margin);
}

VirtualView make_virtual_view(const Optic& lens, LensSide entered, std::span<const VertexHit> hits,
                              const cad_import::BoundingBox& scene_bounds, double margin) {
  return view_of_mesh(lens, *side_of(lens, entered).mesh, hits, scene_bounds, margin);
}

glm::dmat4 VirtualView::view_matrix() const {
  glm::dmat4 m{1};
  const glm::dvec3 rows[3] = {right, up, -direction};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) m[c][r] = rows[r][c];
    m[3][r] = -glm::dot(rows[r], viewpoint_mm);
  }
  return m;
}

glm::dmat4 VirtualView::projection_matrix() const {
  const double width = right_side - left, height = top - bottom, depth = far_mm - near_mm;
  glm::dmat4 m{0};
  m[0][0] = 2 / width;
  m[1][1] = 2 / height;
  if (projection == MapProjection::perspective) {
    m[2][0] = (right_side + left) / width;
    m[2][1] = (top + bottom) / height;
    m[2][2] = near_mm / depth;
    m[3][2] = near_mm * far_mm / depth;
    m[2][3] = -1;
  } else {
    m[3][0] = -(right_side + left) / width;
    m[3][1] = -(top + bottom) / height;
    m[2][2] = 1 / depth;
    m[3][2] = far_mm / depth;
    m[3][3] = 1;
  }
  return m;
}

glm::dmat4 VirtualView::zooming_view_matrix() const {
  glm::dmat4 m = -view_matrix();
  m[3][3] = 1;
  return m;
}

glm::dmat4 VirtualView::zooming_projection_matrix() const {
  VirtualView mirrored = *this;
  mirrored.near_mm = zooming_near_mm;
  mirrored.far_mm = zooming_far_mm;
  return mirrored.projection_matrix();
}

glm::dvec3 VirtualView::project_point(const glm::dvec3& point_mm) const {
  const glm::dvec3 offset = point_mm - viewpoint_mm;
  const double w = projection == MapProjection::perspective ? glm::dot(offset, direction) : 1.0;
  return {(glm::dot(offset, right) - left * w) / (right_side - left),
          (glm::dot(offset, up) - bottom * w) / (top - bottom), w};
}

glm::dvec3 VirtualView::project_direction(const glm::dvec3& d) const {
  const double w = projection == MapProjection::perspective ? glm::dot(d, direction) : 0.0;
  return {(glm::dot(d, right) - left * w) / (right_side - left),
          (glm::dot(d, up) - bottom * w) / (top - bottom), w};
}

Ray VirtualView::map_ray(double s, double t) const {
  const double x = left + s * (right_side - left), y = bottom + t * (top - bottom);
  if (projection == MapProjection::parallel) return {viewpoint_mm + x * right + y * up, direction};
  const glm::dvec3 d = direction + x * right + y * up;
  const double length = glm::length(d);
  return {viewpoint_mm, d / length, near_mm * length};
}

}  // namespace catoptra::optics
