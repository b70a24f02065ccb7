#include "render/src/map_colors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "render/src/pixel_error.h"
#include "render/src/shading_vector_clones.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = MapQueries::kLanes;
constexpr float kTolerance_rad = float(kExactTolerance_arcmin / kArcminPerRad);
// Texels larger than so many pixels, or arcminutes, show a blur. (Two would be the least that any map has
// somewhere: it is made for the mean, and an optic's edges magnify less.)
constexpr float kCoarsest = 3;
// Less of a texel than that says little of its colour.
constexpr float kLeastWeight = 1.0f / 256;
// What float coordinates leave uncertain of the distance of a point from a plane: those of the point and of
// the texel, the distance along the ray and the depth in the map.
constexpr float kRounding = 8 * std::numeric_limits<float>::epsilon();
// A depth at which nothing can lie, and which is not the sky's either.
constexpr float kOtherRegion = -1;
// Half a pixel, of which queries know a part (see set_half_pixels()).
constexpr float kPixelsPerHalf = float(1 / kExactTolerance_px);

static_assert(std::endian::native == std::endian::little, "a texel's red is to be in the lowest bits");

[[gnu::always_inline]] inline float larger(float a, float b) {
  return a > b ? a : b;
}

/// Half precision as a float, exactly. Finite numbers that are not negative.
[[gnu::always_inline]] inline float from_half(std::uint32_t half) {
  return std::bit_cast<float>((half & 0x7fffu) << 13) * 0x1p112f;
}

}  // namespace

/// Where 16 points are in a map, and the four texels around each.
struct alignas(64) MapColors::Places {
  float x[kLanes], y[kLanes], z[kLanes];     ///< along right, up and ahead
  float nx[kLanes], ny[kLanes], nz[kLanes];  ///< unit normal, likewise
  float at_x[kLanes], at_y[kLanes];          ///< slope; of a parallel projection, mm
  float height[kLanes];                      ///< of the triangle's plane over the map's origin
  float off_x[4][kLanes], off_y[4][kLanes];  ///< of the texels' centres from the place, texels
  float weight[4][kLanes];                   ///< 0 beyond the map's border
  std::uint32_t index[4][kLanes];            ///< from the first texel of the map
  float depth[4][kLanes];                    ///< as stored
  std::uint64_t color[4][kLanes];
  float column[kLanes], row[kLanes];  ///< in texels, centres at halves
  std::int32_t possible[kLanes];
};

void MapColors::clear(std::size_t optics) {
  maps_.resize(optics);
  for (auto& maps : maps_) maps.clear();
  colors_.clear();
  depths_.clear();
}

void MapColors::add(std::size_t optic, std::span<const RasterView> views, const RasterTarget& target) {
  const std::size_t first = depths_.size(),
                    count = std::size_t(target.size().x) * std::size_t(target.size().y);
  for (const RasterView& view : views) {
    Map map = map_of(view);
    map.stride = target.size().x;
    map.first = first + std::size_t(view.corner.y) * std::size_t(map.stride) + std::size_t(view.corner.x);
    maps_[optic].push_back(map);
  }
  depths_.resize(first + count);
  colors_.resize(first + count);
  glGetTextureImage(target.depth().id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                    static_cast<GLsizei>(count * sizeof(float)), &depths_[first]);
  glGetTextureImage(target.color().id(), 0, GL_RGBA, GL_HALF_FLOAT,
                    static_cast<GLsizei>(count * sizeof(std::uint64_t)), &colors_[first]);
}

MapColors::Map MapColors::map_of(const RasterView& view) {
  const glm::dmat3 to_world = glm::transpose(view.rotation);
  const glm::dmat4& p = view.projection;
  Map map;
  map.origin_mm = glm::vec3(view.origin_mm);
  map.right = glm::vec3(to_world[0]);
  map.up = glm::vec3(to_world[1]);
  map.ahead = glm::vec3(-to_world[2]);
  map.perspective = p[2][3] != 0;
  map.size = view.size;
  // Clip x of a perspective: p00 right - p20 depth, over depth; of a parallel projection p00 right + p30.
  const double shift_x = map.perspective ? -p[2][0] : p[3][0], shift_y = map.perspective ? -p[2][1] : p[3][1];
  map.scale_x = float(0.5 * p[0][0] * map.size.x);
  map.scale_y = float(-0.5 * p[1][1] * map.size.y);
  map.shift_x = float((0.5 + 0.5 * shift_x) * map.size.x);
  map.shift_y = float((0.5 - 0.5 * shift_y) * map.size.y);
  map.depth_factor = float(map.perspective ? p[3][2] : -1 / p[2][2]);
  map.depth_shift = float(map.perspective ? -p[2][2] : p[3][2]);
  map.depth_of_far = view.depth_of_far;
  map.depth_of_near = view.depth_of_near;
  map.sense = map.depth_of_near < map.depth_of_far ? -1.0f : 1.0f;
  return map;
}

/// Of a stored depth; kOtherRegion where what is stored belongs to the other view of the same map.
float MapColors::clip_depth(const Map& map, float stored) {
  const float depth = (stored - map.depth_of_far) / (map.depth_of_near - map.depth_of_far);
  // The depth that both views may store is the far end of neither.
  const bool own = depth >= 0 && (map.sense < 0 ? depth < 1 : depth <= 1);
  return own ? depth : kOtherRegion;
}

void MapColors::find(std::size_t optic, MapQueries& queries, MapAnswers& answers) const {
  for (const Map& map : maps_[optic]) {
    Places p;
    find_places(map, queries, p);
    for (int k = 0; k < 4; ++k)
      for (int i = 0; i < kLanes; ++i) {
        p.depth[k][i] = clip_depth(map, depths_[map.first + p.index[k][i]]);
        p.color[k][i] = colors_[map.first + p.index[k][i]];
      }
    MapAnswers of_map;
    judge(map, queries, p, of_map);
    mix(p, of_map);
    for (int i = 0; i < kLanes; ++i) {
      if (!of_map.found[i]) continue;
      queries.wanted[i] = 0;
      answers.found[i] = 1;
      answers.red[i] = of_map.red[i];
      answers.green[i] = of_map.green[i];
      answers.blue[i] = of_map.blue[i];
      answers.shown_x[i] = of_map.shown_x[i];
      answers.shown_y[i] = of_map.shown_y[i];
      answers.shown_z[i] = of_map.shown_z[i];
    }
  }
}

template <bool kPerspective>
[[gnu::always_inline]] inline void MapColors::find_places_in(const Map& map, const MapQueries& q, Places& p) {
  const Map m = map;  // a copy, so that no store can be thought to change it
  const float wide = float(m.size.x), high = float(m.size.y);
  for (int i = 0; i < kLanes; ++i) {
    const bool sky = q.sky[i] != 0;
    const float from = sky ? 0.0f : 1.0f;
    const float dx = q.point_x[i] - from * m.origin_mm.x, dy = q.point_y[i] - from * m.origin_mm.y,
                dz = q.point_z[i] - from * m.origin_mm.z;
    const float x = dx * m.right.x + dy * m.right.y + dz * m.right.z,
                y = dx * m.up.x + dy * m.up.y + dz * m.up.z,
                z = dx * m.ahead.x + dy * m.ahead.y + dz * m.ahead.z;
    const float gx = q.normal_x[i], gy = q.normal_y[i], gz = q.normal_z[i];
    const float per_length = 1 / std::sqrt(gx * gx + gy * gy + gz * gz);
    const float nx = (gx * m.right.x + gy * m.right.y + gz * m.right.z) * per_length,
                ny = (gx * m.up.x + gy * m.up.y + gz * m.up.z) * per_length,
                nz = (gx * m.ahead.x + gy * m.ahead.y + gz * m.ahead.z) * per_length;
    const float height = nx * x + ny * y + nz * z;
    const float facing = gx * q.direction_x[i] + gy * q.direction_y[i] + gz * q.direction_z[i];
    const float per_depth = kPerspective ? 1 / z : 1.0f;
    const float column = m.scale_x * (x * per_depth) + m.shift_x,
                row = m.scale_y * (y * per_depth) + m.shift_y;
    // The map has to see the side that the ray meets. A parallel map shows the sky of one direction.
    const float side = m.sense * (kPerspective ? height : nz) * facing;
    const int seen = sky ? int(kPerspective) : int(side > 0);
    const int possible = int(q.wanted[i] != 0) & seen & int(!kPerspective || z > 0) & int(column >= 0) &
                         int(row >= 0) & int(column <= wide) & int(row <= high);
    p.x[i] = x;
    p.y[i] = y;
    p.z[i] = z;
    p.nx[i] = nx;
    p.ny[i] = ny;
    p.nz[i] = nz;
    p.height[i] = height;
    p.at_x[i] = x * per_depth;
    p.at_y[i] = y * per_depth;
    p.possible[i] = possible;
    p.column[i] = possible ? column : 0.0f;
    p.row[i] = possible ? row : 0.0f;
  }
  const int last_x = m.size.x - 1, last_y = m.size.y - 1, stride = m.stride;
  for (int k = 0; k < 4; ++k) {
    const int right = k % 2, down = k / 2;
    for (int i = 0; i < kLanes; ++i) {
      const int cx = int(p.column[i] + 0.5f) - 1 + right, cy = int(p.row[i] + 0.5f) - 1 + down;
      const int bx = cx < 0 ? 0 : cx > last_x ? last_x : cx, by = cy < 0 ? 0 : cy > last_y ? last_y : cy;
      const float off_x = float(cx) + 0.5f - p.column[i], off_y = float(cy) + 0.5f - p.row[i];
      const float weight = (1 - std::abs(off_x)) * (1 - std::abs(off_y));
      p.index[k][i] = std::uint32_t(by * stride + bx);
      p.off_x[k][i] = off_x;
      p.off_y[k][i] = off_y;
      p.weight[k][i] = (bx == cx) & (by == cy) ? weight : 0.0f;
    }
  }
}

CATOPTRA_VECTOR_CLONES void MapColors::find_places(const Map& map, const MapQueries& q, Places& p) {
  if (map.perspective)
    find_places_in<true>(map, q, p);
  else
    find_places_in<false>(map, q, p);
}

/// Leaves weights to the texels that show what the ray meets. The colour is their mean, so its place is the
/// mean of theirs.
template <bool kPerspective>
[[gnu::always_inline]] inline void MapColors::judge_in(const Map& map, const MapQueries& q, Places& p,
                                                       MapAnswers& answers) {
  const Map m = map;
  const float per_x = 1 / m.scale_x, per_y = 1 / m.scale_y;
  alignas(64) float sum[kLanes] = {}, moved_x[kLanes] = {}, moved_y[kLanes] = {}, moved_z[kLanes] = {};
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < kLanes; ++i) {
      const bool sky = q.sky[i] != 0;
      const float shifted = p.depth[k][i] - m.depth_shift, x = p.x[i], y = p.y[i], z = p.z[i];
      const float met = kPerspective ? m.depth_factor / shifted : m.depth_factor * shifted;
      const float depth = sky ? z : met, lateral = kPerspective ? depth : 1.0f;
      const float sx = lateral * (p.at_x[i] + p.off_x[k][i] * per_x),
                  sy = lateral * (p.at_y[i] + p.off_y[k][i] * per_y);
      const float out = std::abs(p.nx[i] * sx + p.ny[i] * sy + p.nz[i] * depth - p.height[i]);
      const float size = larger(larger(std::abs(q.point_x[i]), std::abs(q.point_y[i])),
                                larger(std::abs(q.point_z[i]), std::abs(z)));
      const float allowed = kTolerance_rad * q.distance[i] + kRounding * size;
      const int nothing = p.depth[k][i] == 0, in_plane = out <= allowed;
      const int same = sky ? nothing : (1 - nothing) & in_plane;
      const float before = p.weight[k][i], weight = same ? before : 0.0f;
      // Numbers that mean nothing times 0 need not be 0.
      const float by_x = same ? sx - x : 0.0f, by_y = same ? sy - y : 0.0f, by_z = same ? depth - z : 0.0f;
      p.weight[k][i] = weight;
      sum[i] += weight;
      moved_x[i] += weight * by_x;
      moved_y[i] += weight * by_y;
      moved_z[i] += weight * by_z;
    }
  alignas(64) float per_sums[kLanes];
  for (int i = 0; i < kLanes; ++i) per_sums[i] = 1 / larger(sum[i], kLeastWeight);
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < kLanes; ++i) p.weight[k][i] *= per_sums[i];
  for (int i = 0; i < kLanes; ++i) {
    const bool sky = q.sky[i] != 0;
    const float per_sum = per_sums[i];
    const float mx = moved_x[i] * per_sum, my = moved_y[i] * per_sum, mz = moved_z[i] * per_sum;
    const float dx = q.direction_x[i], dy = q.direction_y[i], dz = q.direction_z[i];
    const float d_right = dx * m.right.x + dy * m.right.y + dz * m.right.z,
                d_up = dx * m.up.x + dy * m.up.y + dz * m.up.z,
                d_ahead = dx * m.ahead.x + dy * m.ahead.y + dz * m.ahead.z;
    const float along = mx * d_right + my * d_up + mz * d_ahead;
    const float ax = mx - along * d_right, ay = my - along * d_up, az = mz - along * d_ahead;
    const float across2 = ax * ax + ay * ay + az * az;
    const float angle = kTolerance_rad * q.distance[i], limit = larger(angle, q.half_pixel[i]);
    // A texel's sides, across the ray.
    const float side_x = std::abs(per_x) * std::sqrt(larger(0.0f, 1 - d_right * d_right)),
                side_y = std::abs(per_y) * std::sqrt(larger(0.0f, 1 - d_up * d_up));
    const float texel = (kPerspective ? p.z[i] : 1.0f) * larger(side_x, side_y);
    answers.found[i] = p.possible[i] & int(sum[i] >= kLeastWeight) & int(across2 <= limit * limit) &
                       int(texel <= kCoarsest * larger(angle, kPixelsPerHalf * q.half_pixel[i]));
    const float sx = q.point_x[i] + mx * m.right.x + my * m.up.x + mz * m.ahead.x,
                sy = q.point_y[i] + mx * m.right.y + my * m.up.y + mz * m.ahead.y,
                sz = q.point_z[i] + mx * m.right.z + my * m.up.z + mz * m.ahead.z;
    const float scale = sky ? 1 / std::sqrt(sx * sx + sy * sy + sz * sz) : 1.0f;
    answers.shown_x[i] = scale * sx;
    answers.shown_y[i] = scale * sy;
    answers.shown_z[i] = scale * sz;
  }
}

CATOPTRA_VECTOR_CLONES void MapColors::judge(const Map& map, const MapQueries& q, Places& p,
                                             MapAnswers& answers) {
  if (map.perspective)
    judge_in<true>(map, q, p, answers);
  else
    judge_in<false>(map, q, p, answers);
}

CATOPTRA_VECTOR_CLONES void MapColors::mix(const Places& p, MapAnswers& answers) {
  for (int i = 0; i < kLanes; ++i) {
    float red = 0, green = 0, blue = 0;
    for (int k = 0; k < 4; ++k) {
      const auto low = std::uint32_t(p.color[k][i]), high = std::uint32_t(p.color[k][i] >> 32);
      red += p.weight[k][i] * from_half(low);
      green += p.weight[k][i] * from_half(low >> 16);
      blue += p.weight[k][i] * from_half(high);
    }
    answers.red[i] = red;
    answers.green[i] = green;
    answers.blue[i] = blue;
  }
}

}  // namespace catoptra::render
