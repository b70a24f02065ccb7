#include "render/src/map_colors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "render/src/pixel_error.h"

namespace catoptra::render {
namespace {

constexpr float kTolerance_rad = float(kExactTolerance_arcmin / kArcminPerRad);
constexpr std::size_t kChannels = 4;
// Texels larger than so many pixels, or arcminutes, show a blur. (Two would be the least that any map has
// somewhere: it is made for the mean, and an optic's edges magnify less.)
constexpr float kCoarsest = 3;
// Less of a texel than that says little of its colour.
constexpr float kLeastWeight = 1.0f / 256;

/// Half precision as a float, exactly. Finite numbers only.
float from_half(std::uint16_t half) {
  const float magnitude = std::bit_cast<float>(std::uint32_t(half & 0x7fffu) << 13) * 0x1p112f;
  return half & 0x8000u ? -magnitude : magnitude;
}

/// What float coordinates leave uncertain of the distance of a point from a plane, mm: coordinates of the
/// point and of the texel, the distance along the ray and the depth in the map.
float rounding_mm(const glm::vec3& point, float map_depth_mm) {
  constexpr float kRoundings = 8;
  const glm::vec3 a = glm::abs(point);
  return kRoundings * std::numeric_limits<float>::epsilon() *
         std::max({a.x, a.y, a.z, std::abs(map_depth_mm)});
}

}  // namespace

/// The four texels around a place, and their weights in the mean.
struct MapColors::Texels {
  std::size_t index[4];
  glm::vec2 offset[4];  ///< of their centres from the place, texels
  float weight[4];
  bool complete = true;  ///< none is beyond the map's border

  /// Leaves those that `keep` (index, offset) accepts. Returns whether all are left; their weights then add
  /// up to 1, and do after normalise().
  template <typename Keep>
  bool filter(const Keep& keep) {
    bool all = complete;
    for (int k = 0; k < 4; ++k) {
      if (keep(index[k], offset[k]) || weight[k] == 0) continue;
      weight[k] = 0;
      all = false;
    }
    return all;
  }
  /// False where too little is left.
  bool normalise() {
    const float sum = weight[0] + weight[1] + weight[2] + weight[3];
    for (float& w : weight) w /= sum;
    return sum >= kLeastWeight;
  }
  [[nodiscard]] glm::vec2 displacement() const {
    glm::vec2 sum(0);
    for (int k = 0; k < 4; ++k) sum += weight[k] * offset[k];
    return sum;
  }
};

void MapColors::clear(std::size_t optics) {
  maps_.resize(optics);
  for (auto& maps : maps_) maps.clear();
  colors_.clear();
  depths_.clear();
}

void MapColors::add(std::size_t optic, const RasterView& view, const RasterTarget& target) {
  const glm::dmat3 to_world = glm::transpose(view.rotation);
  const glm::dmat4& p = view.projection;
  Map map;
  map.origin_mm = view.origin_mm;
  map.right = glm::vec3(to_world[0]);
  map.up = glm::vec3(to_world[1]);
  map.ahead = glm::vec3(-to_world[2]);
  map.perspective = p[2][3] != 0;
  map.size = target.size();
  // Clip x of a perspective: p00 right - p20 depth, over depth; of a parallel projection p00 right + p30.
  const double shift_x = map.perspective ? -p[2][0] : p[3][0], shift_y = map.perspective ? -p[2][1] : p[3][1];
  map.scale_x = float(0.5 * p[0][0] * map.size.x);
  map.scale_y = float(-0.5 * p[1][1] * map.size.y);
  map.shift_x = float((0.5 + 0.5 * shift_x) * map.size.x);
  map.shift_y = float((0.5 - 0.5 * shift_y) * map.size.y);
  map.depth_factor = float(map.perspective ? p[3][2] : -1 / p[2][2]);
  map.depth_shift = float(map.perspective ? -p[2][2] : p[3][2]);
  map.first = depths_.size();
  maps_[optic].push_back(map);
  const std::size_t count = std::size_t(map.size.x) * std::size_t(map.size.y);
  depths_.resize(map.first + count);
  colors_.resize(kChannels * depths_.size());
  glGetTextureImage(target.depth().id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                    static_cast<GLsizei>(count * sizeof(float)), &depths_[map.first]);
  glGetTextureImage(target.color().id(), 0, GL_RGBA, GL_HALF_FLOAT,
                    static_cast<GLsizei>(count * kChannels * sizeof(std::uint16_t)),
                    &colors_[kChannels * map.first]);
}

/// Stored depth of a perspective: shift + factor / depth; of a parallel projection: shift - depth / -factor.
float MapColors::Map::depth_mm(float stored) const {
  return perspective ? depth_factor / (stored - depth_shift) : depth_factor * (stored - depth_shift);
}

std::optional<MapColor> MapColors::find(std::size_t optic, const MapQuery& query) const {
  for (const Map& map : maps_[optic])
    if (auto found = query.sky ? find_sky(map, query) : find_point(map, query)) return found;
  return std::nullopt;
}

/// `place`: along right, up and ahead.
std::optional<MapColors::Texels> MapColors::texels_at(const Map& map, glm::vec3 place) const {
  const float per_depth = map.perspective ? 1 / place.z : 1.0f;
  if (!(place.z > 0)) return std::nullopt;
  const float x = map.scale_x * place.x * per_depth + map.shift_x,
              y = map.scale_y * place.y * per_depth + map.shift_y;
  if (!(x >= 0 && y >= 0 && x <= float(map.size.x) && y <= float(map.size.y))) return std::nullopt;
  const int column = int(x + 0.5f) - 1, row = int(y + 0.5f) - 1;
  const float right = x - (float(column) + 0.5f), down = y - (float(row) + 0.5f);
  Texels texels;
  for (int k = 0; k < 4; ++k) {
    const int i = column + k % 2, j = row + k / 2;
    const bool inside = i >= 0 && j >= 0 && i < map.size.x && j < map.size.y;
    texels.index[k] =
        inside ? map.first + std::size_t(j) * std::size_t(map.size.x) + std::size_t(i) : map.first;
    texels.complete = texels.complete && inside;
    texels.offset[k] = {float(k % 2) - right, float(k / 2) - down};
    texels.weight[k] = inside ? (k % 2 ? right : 1 - right) * (k / 2 ? down : 1 - down) : 0.0f;
  }
  return texels;
}

glm::vec3 MapColors::mean(const Texels& texels) const {
  glm::vec3 sum(0);
  for (int k = 0; k < 4; ++k) {
    const std::uint16_t* c = &colors_[kChannels * texels.index[k]];
    sum += texels.weight[k] * glm::vec3(from_half(c[0]), from_half(c[1]), from_half(c[2]));
  }
  return sum;
}

std::optional<MapColor> MapColors::find_point(const Map& map, const MapQuery& query) const {
  const glm::vec3 from_origin(glm::dvec3(query.point_mm) - map.origin_mm);
  const glm::vec3 place(glm::dot(from_origin, map.right), glm::dot(from_origin, map.up),
                        glm::dot(from_origin, map.ahead));
  auto texels = texels_at(map, place);
  if (!texels) return std::nullopt;
  const glm::vec3 n(glm::dot(query.normal, map.right), glm::dot(query.normal, map.up),
                    glm::dot(query.normal, map.ahead));
  const float height = glm::dot(n, place);  // of the triangle's plane over the map's origin
  // The map has to see the side that the ray meets.
  const float slope = map.perspective ? height : n.z;
  if (!(slope * glm::dot(query.normal, query.direction) > 0)) return std::nullopt;
  const float per_texel_x = 1 / map.scale_x, per_texel_y = 1 / map.scale_y;
  const glm::vec2 at = map.perspective ? glm::vec2(place) / place.z : glm::vec2(place);
  // A texel's sides, across the ray.
  const float along_x = glm::dot(query.direction, map.right), along_y = glm::dot(query.direction, map.up);
  const float texel_mm = (map.perspective ? place.z : 1.0f) *
                         std::max(std::abs(per_texel_x) * std::sqrt(std::max(0.0f, 1 - along_x * along_x)),
                                  std::abs(per_texel_y) * std::sqrt(std::max(0.0f, 1 - along_y * along_y)));
  if (!(texel_mm <= kCoarsest * std::max(kTolerance_rad * query.distance_mm, 2 * query.half_pixel)))
    return std::nullopt;
  const float allowed = kTolerance_rad * query.distance_mm + rounding_mm(query.point_mm, place.z);
  glm::vec3 seen[4];  // what the texels show, along right, up and ahead
  int k = 0;
  const bool all = texels->filter([&](std::size_t index, glm::vec2 offset) {
    glm::vec3& point = seen[k++];
    point = place;
    if (depths_[index] == 0) return false;
    const glm::vec2 side = at + offset * glm::vec2(per_texel_x, per_texel_y);
    const float depth = map.depth_mm(depths_[index]);
    point = map.perspective ? depth * glm::vec3(side, 1) : glm::vec3(side, depth);
    return std::abs(glm::dot(n, point) - height) <= allowed;
  });
  if (!all && !texels->normalise()) return std::nullopt;
  // The colour is the mean of those of the texels left, so its place is the mean of theirs.
  glm::vec3 shown(0);
  for (int i = 0; i < 4; ++i) shown += texels->weight[i] * (seen[i] - place);
  const glm::vec3 moved = shown.x * map.right + shown.y * map.up + shown.z * map.ahead;
  const float across = glm::length(moved - glm::dot(moved, query.direction) * query.direction);
  if (!(across <= std::max(kTolerance_rad * query.distance_mm, query.half_pixel))) return std::nullopt;
  return MapColor{mean(*texels), query.point_mm + moved};
}

std::optional<MapColor> MapColors::find_sky(const Map& map, const MapQuery& query) const {
  auto texels = map.perspective
                    ? texels_at(map, {glm::dot(query.direction, map.right), glm::dot(query.direction, map.up),
                                      glm::dot(query.direction, map.ahead)})
                    : std::nullopt;
  if (!texels) return std::nullopt;
  const bool all = texels->filter([&](std::size_t index, glm::vec2) { return depths_[index] == 0; });
  MapColor found{glm::vec3(0), query.direction};
  if (!all) {
    if (!texels->normalise()) return std::nullopt;
    const glm::vec2 moved = texels->displacement() / glm::vec2(map.scale_x, map.scale_y);
    const glm::vec3 shown =
        query.direction / glm::dot(query.direction, map.ahead) + moved.x * map.right + moved.y * map.up;
    found.shown = glm::normalize(shown);
    if (!(glm::length(found.shown - query.direction) <= std::max(kTolerance_rad, query.half_pixel)))
      return std::nullopt;
  }
  found.radiance = mean(*texels);
  return found;
}

}  // namespace catoptra::render
