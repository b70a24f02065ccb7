#include "render/src/virtual_shadows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::render {
namespace {

using optics::ConvexPolygon;
using optics::LightPlace;
using optics::side_of;
using optics::towards;
using optics::VirtualLight;

// Casters have to be so far from a face, mm: the face itself, which the mesh has in floats, casts none.
constexpr double kClearOfFace_mm = 0.01;

/// The plane moved so that less lies on its positive side.
glm::dvec4 moved_in(const glm::dvec4& plane, double by_mm) {
  return plane - glm::dvec4(0, 0, 0, by_mm);
}

/// Four planes, positive inside, about all that passes between a light and an aperture: through the light and
/// the sides of a rectangle about the aperture, somewhat larger.
std::vector<glm::dvec4> pyramid(const LightPlace& place, const VirtualLight& through) {
  const glm::dvec3 n(through.lit_side);
  const glm::dvec3 u =
      glm::normalize(glm::cross(n, std::abs(n.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
  const glm::dvec3 v = glm::cross(n, u);
  glm::dvec2 low(1e300), high(-1e300);
  for (const ConvexPolygon& piece : through.aperture)
    for (const glm::dvec3& p : piece) {
      low = glm::min(low, glm::dvec2(glm::dot(p, u), glm::dot(p, v)));
      high = glm::max(high, glm::dvec2(glm::dot(p, u), glm::dot(p, v)));
    }
  const glm::dvec2 room = 0.01 * (high - low) + glm::dvec2(kClearOfFace_mm);
  low -= room;
  high += room;
  const auto at = [&](double x, double y) { return x * u + y * v - through.lit_side.w * n; };
  const ConvexPolygon corners{at(low.x, low.y), at(high.x, low.y), at(high.x, high.y), at(low.x, high.y)};
  const glm::dvec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  std::vector<glm::dvec4> planes;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % 4];
    const glm::dvec3 across = glm::normalize(glm::cross(towards(place, a), b - a));
    const glm::dvec4 plane(across, -glm::dot(across, a));
    planes.push_back(side_of(plane, middle) > 0 ? plane : -plane);
  }
  return planes;
}

bool beyond(const ConvexPolygon& polygon, const glm::dvec4& plane) {
  return std::ranges::all_of(polygon, [&](const glm::dvec3& p) { return side_of(plane, p) <= 0; });
}

void add_fan(TriangleSoup& soup, const ConvexPolygon& polygon) {
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    for (const std::size_t k : {std::size_t(0), i, i + 1}) soup.emplace_back(polygon[k]);
}

/// Every triangle's part inside all planes.
template <typename Each>
void for_each_inside(const TriangleSoup& soup, std::span<const glm::dvec4> planes, const Each& each) {
  for (std::size_t i = 0; i + 2 < soup.size(); i += 3) {
    ConvexPolygon polygon{glm::dvec3(soup[i]), glm::dvec3(soup[i + 1]), glm::dvec3(soup[i + 2])};
    if (std::ranges::any_of(planes, [&](const glm::dvec4& plane) { return beyond(polygon, plane); }))
      continue;
    for (const glm::dvec4& plane : planes)
      if (!polygon.empty()) polygon = optics::clip(polygon, plane);
    if (!polygon.empty()) each(polygon);
  }
}

class Casters {
 public:
  Casters(std::span<const TriangleSoup> casters, const LightPlace& source,
          std::span<const VirtualLight> lights)
      : casters_(casters), source_(source), lights_(lights) {}

  TriangleSoup of(std::size_t index) const {
    const VirtualLight& light = lights_[index];
    TriangleSoup soup = before_face(index);
    // Only what stands in the light volume; that is cut off at the face alone, so that meshes stay whole.
    const std::vector<glm::dvec4> sides = pyramid(light.place, light);
    const std::vector<glm::dvec4> face{moved_in(light.lit_side, kClearOfFace_mm)};
    for (const TriangleSoup& all : casters_) {
      TriangleSoup near;
      for (std::size_t i = 0; i + 2 < all.size(); i += 3) {
        const ConvexPolygon triangle{glm::dvec3(all[i]), glm::dvec3(all[i + 1]), glm::dvec3(all[i + 2])};
        if (std::ranges::none_of(sides, [&](const glm::dvec4& side) { return beyond(triangle, side); }))
          near.insert(near.end(), all.begin() + std::ptrdiff_t(i), all.begin() + std::ptrdiff_t(i) + 3);
      }
      for_each_inside(near, face, [&](const ConvexPolygon& part) { add_fan(soup, part); });
    }
    return soup;
  }

 private:
  /// Shadows on the face of light `index`, of what stands in the way of the light before.
  TriangleSoup before_face(std::size_t index) const {
    const VirtualLight& light = lights_[index];
    const VirtualLight* before = light.before < 0 ? nullptr : &lights_[std::size_t(light.before)];
    const LightPlace place = before ? before->place : source_;
    // Light comes from the side that a mirror lights, and that glass does not.
    const glm::dvec4 incoming = light.reflected ? light.lit_side : -light.lit_side;
    std::vector<glm::dvec4> planes = pyramid(place, light);
    planes.push_back(moved_in(incoming, kClearOfFace_mm));
    if (before) planes.push_back(moved_in(before->lit_side, kClearOfFace_mm));
    TriangleSoup soup;
    const auto add = [&](ConvexPolygon part) {
      for (glm::dvec3& p : part) p = optics::crossing(light.lit_side, place, p);
      add_fan(soup, part);
    };
    for (const TriangleSoup& all : casters_) for_each_inside(all, planes, add);
    if (!before) return soup;
    planes.pop_back();  // these shadows lie on the face before
    const TriangleSoup carried = before_face(std::size_t(light.before));
    for_each_inside(carried, planes, add);
    return soup;
  }

  std::span<const TriangleSoup> casters_;
  LightPlace source_;
  std::span<const VirtualLight> lights_;
};

}  // namespace

TriangleSoup aperture_triangles(const VirtualLight& light) {
  TriangleSoup soup;
  for (const ConvexPolygon& piece : light.aperture) add_fan(soup, piece);
  return soup;
}

TriangleSoup virtual_light_casters(std::span<const TriangleSoup> casters, const LightPlace& source,
                                   std::span<const VirtualLight> lights, std::size_t index) {
  return Casters(casters, source, lights).of(index);
}

}  // namespace catoptra::render
