#include "render/src/raster_chunks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>

namespace catoptra::render {
namespace {

// Share of its distance by which a box counts as larger: a thousand times the rounding of a float.
constexpr double kRounding = 1e-4;

using Triangle = std::array<std::uint32_t, 3>;

struct Splitter {
  std::span<const glm::vec3> positions;
  std::size_t largest;
  std::vector<Triangle> triangles;
  std::vector<TriangleChunk> chunks;

  [[nodiscard]] glm::vec3 thrice_middle(const Triangle& t) const {
    return positions[t[0]] + positions[t[1]] + positions[t[2]];
  }

  void add(std::size_t begin, std::size_t end) {
    TriangleChunk chunk{3 * begin, 3 * (end - begin), {}};
    for (std::size_t i = begin; i < end; ++i)
      for (const std::uint32_t vertex : triangles[i]) {
        chunk.box.min = glm::min(chunk.box.min, glm::dvec3(positions[vertex]));
        chunk.box.max = glm::max(chunk.box.max, glm::dvec3(positions[vertex]));
      }
    chunks.push_back(chunk);
  }

  void split(std::size_t begin, std::size_t end) {
    if (end - begin <= largest) {
      if (end > begin) add(begin, end);
      return;
    }
    glm::vec3 low = thrice_middle(triangles[begin]), high = low;
    for (std::size_t i = begin; i < end; ++i) {
      low = glm::min(low, thrice_middle(triangles[i]));
      high = glm::max(high, thrice_middle(triangles[i]));
    }
    const glm::vec3 side = high - low;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    // Stable, so that every implementation of the library gives the same order.
    const auto at = [&](std::size_t i) { return triangles.begin() + static_cast<std::ptrdiff_t>(i); };
    std::stable_sort(at(begin), at(end), [&](const Triangle& a, const Triangle& b) {
      return thrice_middle(a)[axis] < thrice_middle(b)[axis];
    });
    const std::size_t middle = begin + (end - begin) / 2;
    split(begin, middle);
    split(middle, end);
  }
};

/// Left, right, bottom, top, near and far: not negative inside the view, of positions relative to its origin.
std::array<glm::dvec4, 6> sides_of(const RasterView& view) {
  const glm::dmat4 rows = glm::transpose(view.clip_from_relative());
  return {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
          rows[3] - rows[1], rows[3] - rows[2], rows[2]};
}

using Polygon = std::vector<glm::dvec3>;

/// The part of a convex polygon on which a linear function is not negative.
void clip(Polygon& polygon, const glm::dvec4& side, Polygon& scratch) {
  scratch.clear();
  const auto value = [&](const glm::dvec3& p) { return glm::dot(glm::dvec3(side), p) + side.w; };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = value(a), at_b = value(b);
    if (at_a >= 0) scratch.push_back(a);
    if ((at_a < 0) != (at_b < 0)) scratch.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
  polygon.swap(scratch);
}

/// The least distance along `ahead`, from the origin, of what lies in a box and inside all `sides`; infinite
/// where nothing does. A linear function is least at a corner of that body, and all its corners but the tip
/// of the view lie on the box's faces.
double nearest_seen(const glm::dvec3& middle, const glm::dvec3& half, std::span<const glm::dvec4> sides,
                    const glm::dvec3& ahead) {
  if (glm::all(glm::lessThanEqual(glm::abs(middle), half))) return 0;
  double nearest = std::numeric_limits<double>::infinity();
  Polygon face, scratch;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      glm::dvec3 out(0), u(0), v(0);
      out[axis] = sign * half[axis];
      u[(axis + 1) % 3] = half[(axis + 1) % 3];
      v[(axis + 2) % 3] = half[(axis + 2) % 3];
      const glm::dvec3 centre = middle + out;
      face.assign({centre - u - v, centre + u - v, centre + u + v, centre - u + v});
      for (const glm::dvec4& side : sides) clip(face, side, scratch);
      for (const glm::dvec3& p : face) nearest = std::min(nearest, glm::dot(p, ahead));
    }
  return nearest;
}

}  // namespace

std::vector<TriangleChunk> chunk_triangles(std::span<const glm::vec3> positions,
                                           std::span<std::uint32_t> indices, std::size_t largest) {
  Splitter splitter{positions, std::max<std::size_t>(1, largest), {}, {}};
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    splitter.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  splitter.split(0, splitter.triangles.size());
  for (std::size_t t = 0; t < splitter.triangles.size(); ++t)
    std::copy(splitter.triangles[t].begin(), splitter.triangles[t].end(),
              indices.begin() + std::ptrdiff_t(3 * t));
  return std::move(splitter.chunks);
}

BoxInView box_in_view(const RasterView& view, const cad_import::BoundingBox& box) {
  const glm::dvec3 middle = 0.5 * (box.min + box.max) - view.origin_mm;
  const double room = kRounding * (glm::length(middle) + 0.5 * glm::length(box.max - box.min));
  const glm::dvec3 half = 0.5 * (box.max - box.min) + room;
  const auto sides = sides_of(view);
  for (const glm::dvec4& side : sides)
    // A linear function over the box is largest at the corner to which its gradient points.
    if (glm::dot(glm::dvec3(side), middle) + side.w + glm::dot(glm::abs(glm::dvec3(side)), half) < 0)
      return {};
  if (glm::dot(glm::dvec3(view.keep), middle) + view.keep.w +
          glm::dot(glm::abs(glm::dvec3(view.keep)), half) <
      0)
    return {};
  const glm::dvec3 ahead = -glm::transpose(view.rotation)[2];
  const double nearest = nearest_seen(middle, half, {sides.data(), 4}, ahead);
  return {std::isfinite(nearest), nearest - room};
}

double nearest_triangle_mm(const RasterView& view, std::span<const glm::vec3> positions,
                           std::span<const std::uint32_t> indices) {
  const auto sides = sides_of(view);
  const glm::dvec3 ahead = -glm::transpose(view.rotation)[2];
  double nearest = std::numeric_limits<double>::infinity();
  Polygon triangle, scratch;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    triangle.clear();
    double room = 0;
    for (std::size_t k = i; k < i + 3; ++k) {
      triangle.push_back(glm::dvec3(positions[indices[k]]) - view.origin_mm);
      room = std::max(room, kRounding * glm::length(triangle.back()));
    }
    for (std::size_t k = 0; k < 4; ++k) {
      // The sides moved outwards by the room for rounding.
      const glm::dvec4& side = sides[k];
      clip(triangle, glm::dvec4(glm::dvec3(side), side.w + room * glm::length(glm::dvec3(side))), scratch);
    }
    for (const glm::dvec3& p : triangle) nearest = std::min(nearest, glm::dot(p, ahead) - room);
  }
  return nearest;
}

}  // namespace catoptra::render
