#include "render/src/planar_map_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>

#include "optics/reflection.h"

namespace catoptra::render {
namespace {

// Nothing nearer to the eye than that share of its distance from the polygon's farthest corner is looked at.
constexpr double kLeastDepth = 1e-4;

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Rows x, y and w of clip space, of positions relative to the view's origin.
glm::dmat3 image_of(const RasterView& view) {
  const glm::dmat4 clip = view.clip_from_relative();
  glm::dmat3 image;
  for (int column = 0; column < 3; ++column)
    image[column] = {clip[column][0], clip[column][1], clip[column][3]};
  return image;
}

/// Keeps the part of a convex polygon where `value` is not negative; `value` is linear.
template <typename Point, typename Value>
void keep_part(std::vector<Point>& polygon, const Value& value) {
  std::vector<Point> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = value(a), at_b = value(b);
    if (at_a >= 0) kept.push_back(a);
    if ((at_a < 0) != (at_b < 0)) kept.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
  polygon = std::move(kept);
}

double twice_area(const PixelPolygon& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sum += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return sum;
}

/// The part `rect` of an image of `size` pixels, from right to left where `mirrored`.
glm::dmat3 cropped(glm::ivec2 size, const PixelRect& rect, bool mirrored) {
  const glm::dvec2 factor = glm::dvec2(size) / glm::dvec2(rect.size());
  const double sign = mirrored ? -1 : 1;
  glm::dmat3 crop(1);
  crop[0][0] = sign * factor.x;
  crop[2][0] = sign * (factor.x - 2.0 * rect.begin.x / rect.size().x - 1);
  crop[1][1] = factor.y;
  crop[2][1] = 1 - factor.y + 2.0 * rect.begin.y / rect.size().y;
  return crop;
}

/// Rows are the axes of an eye that looks along `ahead`, turned about it as that of `above` is.
glm::dmat3 axes_along(const glm::dvec3& ahead, const RasterView& above) {
  const glm::dmat3 to_world = glm::transpose(above.rotation);
  glm::dvec3 right = glm::cross(ahead, to_world[1]);
  if (glm::length(right) < 1e-6) right = to_world[0] - glm::dot(to_world[0], ahead) * ahead;
  right = glm::normalize(right);
  return glm::transpose(glm::dmat3(right, glm::cross(right, ahead), -ahead));
}

}  // namespace

std::vector<glm::dvec3> convex_hull(std::span<const glm::dvec3> points, const glm::dvec3& normal) {
  const glm::dvec3 u = glm::normalize(
      glm::cross(normal, std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 v = glm::cross(normal, u);
  std::vector<std::pair<glm::dvec2, glm::dvec3>> sorted;
  for (const glm::dvec3& p : points) sorted.push_back({{glm::dot(p, u), glm::dot(p, v)}, p});
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first.x, a.first.y) < std::pair(b.first.x, b.first.y);
  });
  // Andrew's monotone chain: the lower, then the upper side.
  std::vector<std::pair<glm::dvec2, glm::dvec3>> hull;
  for (const bool upper : {false, true}) {
    const std::size_t first = hull.size();
    for (const auto& p : sorted) {
      while (hull.size() >= first + 2 &&
             cross(hull.back().first - hull[hull.size() - 2].first, p.first - hull.back().first) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    if (!hull.empty()) hull.pop_back();
    if (!upper) std::reverse(sorted.begin(), sorted.end());
  }
  std::vector<glm::dvec3> corners;
  for (const auto& p : hull) corners.push_back(p.second);
  return corners;
}

std::vector<glm::dvec3> seen_part(const RasterView& view, std::span<const glm::dvec3> polygon) {
  const glm::dmat3 image = image_of(view);
  std::vector<glm::dvec3> part;
  for (const glm::dvec3& p : polygon) part.push_back(p - view.origin_mm);
  double farthest = 0;
  for (const glm::dvec3& p : part) farthest = std::max(farthest, (image * p).z);
  keep_part(part, [&](const glm::dvec3& p) { return (image * p).z - kLeastDepth * farthest; });
  for (const int axis : {0, 1})
    for (const double side : {-1.0, 1.0})
      keep_part(part, [&](const glm::dvec3& p) {
        const glm::dvec3 at = image * p;
        return at.z + side * at[axis];
      });
  keep_part(part, [&](const glm::dvec3& p) { return glm::dot(view.keep, glm::dvec4(p, 1)); });
  if (part.size() < 3) return {};
  for (glm::dvec3& p : part) p += view.origin_mm;
  return part;
}

PixelPolygon in_pixels(const RasterView& view, std::span<const glm::dvec3> polygon) {
  PixelPolygon pixels;
  for (const glm::dvec3& p : polygon) pixels.emplace_back(view.pixel(p));
  return pixels;
}

PixelPolygon clipped(const PixelPolygon& polygon, const PixelPolygon& window, double room_px) {
  PixelPolygon part = polygon;
  const double sense = twice_area(window) < 0 ? -1 : 1;
  for (std::size_t i = 0; i < window.size() && !part.empty(); ++i) {
    const glm::dvec2 from = window[i], along = window[(i + 1) % window.size()] - from;
    const double length = glm::length(along);
    if (length < 1e-9) continue;
    keep_part(part, [&](const glm::dvec2& p) { return sense * cross(along, p - from) / length + room_px; });
  }
  return part;
}

glm::dvec2 nearest_point(const PixelPolygon& polygon, glm::dvec2 place) {
  if (clipped({place}, polygon, 0).size() == 1) return place;
  glm::dvec2 nearest(0);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i], along = polygon[(i + 1) % polygon.size()] - a;
    const double square = glm::dot(along, along);
    const glm::dvec2 p =
        square > 0 ? a + std::clamp(glm::dot(place - a, along) / square, 0.0, 1.0) * along : a;
    if (glm::distance(p, place) < best) {
      best = glm::distance(p, place);
      nearest = p;
    }
  }
  return nearest;
}

PixelRect pixel_rect(const PixelPolygon& polygon, glm::ivec2 size) {
  glm::dvec2 begin(size), end(0);
  for (const glm::dvec2& p : polygon) {
    begin = glm::min(begin, p);
    end = glm::max(end, p);
  }
  const PixelRect rect{glm::ivec2(glm::max(glm::floor(begin) - 1.0, glm::dvec2(0))),
                       glm::ivec2(glm::min(glm::ceil(end) + 1.0, glm::dvec2(size)))};
  return {glm::min(rect.begin, rect.end), rect.end};
}

glm::dvec3 point_on_plane(const RasterView& view, const optics::Plane& plane, glm::dvec2 pixel) {
  const glm::dvec3 at(2 * pixel.x / view.size.x - 1, 1 - 2 * pixel.y / view.size.y, 1);
  const glm::dvec3 along = glm::inverse(image_of(view)) * at;
  return view.origin_mm - plane.height_mm(view.origin_mm) / glm::dot(along, plane.normal) * along;
}

RasterView planar_map_view(const RasterView& above, const PlanarTurn& turn, const PixelRect& rect,
                           double near, const optics::Plane& keep) {
  const optics::ProjectiveView seen{above.origin_mm, image_of(above)};
  RasterView map;
  optics::ProjectiveView by_way{turn.eye_mm, seen.image};
  map.rotation = above.rotation;
  if (turn.way == PlanarWay::reflected) {
    by_way = optics::mirrored(seen, turn.plane);
    // The reflection makes the axes left-handed; right becomes left.
    const glm::dmat3 axes = glm::transpose(above.rotation);
    const glm::dvec3& n = turn.plane.normal;
    map.rotation = glm::transpose(
        glm::dmat3(-optics::reflect(axes[0], n), optics::reflect(axes[1], n), optics::reflect(axes[2], n)));
  } else if (turn.way == PlanarWay::refracted) {
    by_way = optics::through(seen, turn.plane, turn.eye_mm);
    map.rotation = axes_along(turn.ahead, above);
  }
  map.origin_mm = by_way.eye_mm;
  map.size = rect.size();
  const glm::dmat3 of_eye_space = cropped(above.size, rect, turn.way == PlanarWay::reflected) * by_way.image *
                                  glm::transpose(map.rotation);
  map.projection = glm::dmat4(0);
  for (int column = 0; column < 3; ++column) {
    map.projection[column][0] = of_eye_space[column][0];
    map.projection[column][1] = of_eye_space[column][1];
    map.projection[column][3] = of_eye_space[column][2];
  }
  map.projection[3][2] = near;
  // What is zero but for rounding is zero, where the camera is as any other.
  if (turn.way != PlanarWay::refracted) {
    const auto clean = [&](int column, int row) {
      if (std::abs(map.projection[column][row]) < 1e-12) map.projection[column][row] = 0;
    };
    clean(1, 0), clean(0, 1), clean(0, 3), clean(1, 3);
    if (std::abs(map.projection[2][3] + 1) < 1e-12) map.projection[2][3] = -1;
  }
  map.keep = glm::dvec4(keep.normal, keep.height_mm(map.origin_mm));
  return map;
}

}  // namespace catoptra::render
