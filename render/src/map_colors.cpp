#include "render/src/map_colors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

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
  float stored[4][kLanes];                   ///< depth
  std::uint32_t red_green[4][kLanes], blue[4][kLanes];
  float column[kLanes], row[kLanes];  ///< in texels, centres at halves
  std::int32_t possible[kLanes];
  std::int32_t any;  ///< not 0: some are possible
};

/// How far the colour's place is from the point met, along right, up and ahead.
struct alignas(64) MapColors::Moves {
  float sum[kLanes];  ///< of the weights of the texels that count
  float x[kLanes], y[kLanes], z[kLanes];
};

void MapColors::clear(std::size_t optics) {
  maps_.resize(optics);
  for (auto& maps : maps_) maps.clear();
  texels_ = 0;
}

void MapColors::reserve(std::size_t texels) {
  if (texels <= capacity_) return;
  // Without a first value: every texel is read from the GPU.
  auto depths = std::make_unique_for_overwrite<float[]>(texels);
  auto colors = std::make_unique_for_overwrite<std::uint64_t[]>(texels);
  std::copy_n(depths_.get(), texels_, depths.get());
  std::copy_n(colors_.get(), texels_, colors.get());
  depths_ = std::move(depths);
  colors_ = std::move(colors);
  capacity_ = texels;
}

void MapColors::add(std::size_t optic, std::span<const RasterView> views, const RasterTarget& target) {
  const std::size_t first = texels_, count = std::size_t(target.size().x) * std::size_t(target.size().y);
  for (const RasterView& view : views) {
    Map map = map_of(view);
    map.stride = target.size().x;
    map.first = first + std::size_t(view.corner.y) * std::size_t(map.stride) + std::size_t(view.corner.x);
    maps_[optic].push_back(map);
  }
  reserve(first + count);
  texels_ = first + count;
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
[[gnu::always_inline]] inline float MapColors::clip_depth(const Map& map, float stored) {
  const float depth = (stored - map.depth_of_far) / (map.depth_of_near - map.depth_of_far);
  // The depth that both views may store is the far end of neither. A stored depth of 1, the zooming view's
  // far end, is where nothing was drawn.
  const int own = (map.sense < 0 ? int(depth > 0) : int(depth >= 0)) & int(depth < 1);
  return own ? depth : kOtherRegion;
}

void MapColors::find(std::size_t optic, MapQueries& queries, MapAnswers& answers) const {
  for (const Map& map : maps_[optic]) {
    Places p;
    find_places(map, queries, p);
    if (!p.any) continue;
    fetch(map, p);
    Moves moves;
    judge(map, queries, p, moves);
    answer(map, p, moves, queries, answers);
  }
}

/// The texels themselves. (Lanes that ask for nothing fetch the map's corner.)
void MapColors::fetch(const Map& map, Places& p) const {
  const float* const depths = &depths_[map.first];
  const std::uint64_t* const colors = &colors_[map.first];
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < kLanes; ++i) {
      const std::uint32_t at = p.index[k][i];
      const std::uint64_t color = colors[at];
      p.stored[k][i] = depths[at];
      p.red_green[k][i] = std::uint32_t(color);
      p.blue[k][i] = std::uint32_t(color >> 32);
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
  std::int32_t any = 0;
  for (int i = 0; i < kLanes; ++i) any |= p.possible[i];
  p.any = any;
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

/// Leaves weights, of sum 1, to the texels that show what the ray meets. The colour is their mean, so its
/// place is the mean of theirs.
template <bool kPerspective>
[[gnu::always_inline]] inline void MapColors::judge_in(const Map& map, const MapQueries& q, Places& p,
                                                       Moves& moves) {
  const Map m = map;
  const float per_x = 1 / m.scale_x, per_y = 1 / m.scale_y;
  Moves mean{};
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < kLanes; ++i) {
      const int sky = q.sky[i];
      const float stored = clip_depth(m, p.stored[k][i]);
      const float shifted = stored - m.depth_shift, x = p.x[i], y = p.y[i], z = p.z[i];
      const float met = kPerspective ? m.depth_factor / shifted : m.depth_factor * shifted;
      const float depth = sky ? z : met, lateral = kPerspective ? depth : 1.0f;
      const float sx = lateral * (p.at_x[i] + p.off_x[k][i] * per_x),
                  sy = lateral * (p.at_y[i] + p.off_y[k][i] * per_y);
      const float out = std::abs(p.nx[i] * sx + p.ny[i] * sy + p.nz[i] * depth - p.height[i]);
      const float size = larger(larger(std::abs(q.point_x[i]), std::abs(q.point_y[i])),
                                larger(std::abs(q.point_z[i]), std::abs(z)));
      const float allowed = kTolerance_rad * q.distance[i] + kRounding * size;
      const int nothing = stored == 0, in_plane = out <= allowed;
      const int same = (sky & nothing) | ((1 - sky) & (1 - nothing) & in_plane);
      const float before = p.weight[k][i], weight = same ? before : 0.0f;
      // Numbers that mean nothing times 0 need not be 0.
      const float by_x = same ? sx - x : 0.0f, by_y = same ? sy - y : 0.0f, by_z = same ? depth - z : 0.0f;
      p.weight[k][i] = weight;
      mean.sum[i] += weight;
      mean.x[i] += weight * by_x;
      mean.y[i] += weight * by_y;
      mean.z[i] += weight * by_z;
    }
  for (int i = 0; i < kLanes; ++i) {
    const float per_sum = 1 / larger(mean.sum[i], kLeastWeight);
    for (int k = 0; k < 4; ++k) p.weight[k][i] *= per_sum;
    mean.x[i] *= per_sum;
    mean.y[i] *= per_sum;
    mean.z[i] *= per_sum;
  }
  moves = mean;
}

CATOPTRA_VECTOR_CLONES void MapColors::judge(const Map& map, const MapQueries& q, Places& p, Moves& moves) {
  if (map.perspective)
    judge_in<true>(map, q, p, moves);
  else
    judge_in<false>(map, q, p, moves);
}

/// Answers the lanes whose colour lies near enough to the point met.
CATOPTRA_VECTOR_CLONES void MapColors::answer(const Map& map, const Places& p, const Moves& moves,
                                              MapQueries& queries, MapAnswers& answers) {
  const Map m = map;
  const float per_x = std::abs(1 / m.scale_x), per_y = std::abs(1 / m.scale_y);
  const float perspective = m.perspective ? 1 : 0;
  MapAnswers a;
  for (int i = 0; i < kLanes; ++i) {
    const auto sky = float(queries.sky[i]);
    const float mx = moves.x[i], my = moves.y[i], mz = moves.z[i];
    const float dx = queries.direction_x[i], dy = queries.direction_y[i], dz = queries.direction_z[i];
    const float d_right = dx * m.right.x + dy * m.right.y + dz * m.right.z,
                d_up = dx * m.up.x + dy * m.up.y + dz * m.up.z,
                d_ahead = dx * m.ahead.x + dy * m.ahead.y + dz * m.ahead.z;
    const float along = mx * d_right + my * d_up + mz * d_ahead;
    const float ax = mx - along * d_right, ay = my - along * d_up, az = mz - along * d_ahead;
    const float across2 = ax * ax + ay * ay + az * az;
    const float half = queries.half_pixel[i];
    const float angle = kTolerance_rad * queries.distance[i], limit = larger(angle, half);
    // A texel's sides, across the ray. (The amounts, for what rounding leaves below 0; like all that follows
    // without a choice, which would not become vector code.)
    const float side_x = per_x * std::sqrt(std::abs(1 - d_right * d_right)),
                side_y = per_y * std::sqrt(std::abs(1 - d_up * d_up));
    const float depth = perspective * p.z[i] + (1 - perspective), texel = depth * larger(side_x, side_y);
    const int found = p.possible[i] & int(moves.sum[i] >= kLeastWeight) & int(across2 <= limit * limit) &
                      int(texel <= kCoarsest * larger(angle, kPixelsPerHalf * half));
    const float sx = queries.point_x[i] + mx * m.right.x + my * m.up.x + mz * m.ahead.x,
                sy = queries.point_y[i] + mx * m.right.y + my * m.up.y + mz * m.ahead.y,
                sz = queries.point_z[i] + mx * m.right.z + my * m.up.z + mz * m.ahead.z;
    const float squared = sx * sx + sy * sy + sz * sz, scale = 1 / std::sqrt(sky * squared + (1 - sky));
    float red = 0, green = 0, blue = 0;
    for (int k = 0; k < 4; ++k) {
      red += p.weight[k][i] * from_half(p.red_green[k][i]);
      green += p.weight[k][i] * from_half(p.red_green[k][i] >> 16);
      blue += p.weight[k][i] * from_half(p.blue[k][i]);
    }
    a.found[i] = found;
    a.red[i] = red;
    a.green[i] = green;
    a.blue[i] = blue;
    a.shown_x[i] = scale * sx;
    a.shown_y[i] = scale * sy;
    a.shown_z[i] = scale * sz;
  }
  for (int i = 0; i < kLanes; ++i) {
    const int found = a.found[i];
    queries.wanted[i] &= 1 - found;
    answers.found[i] |= found;
    answers.red[i] = found ? a.red[i] : answers.red[i];
    answers.green[i] = found ? a.green[i] : answers.green[i];
    answers.blue[i] = found ? a.blue[i] : answers.blue[i];
    answers.shown_x[i] = found ? a.shown_x[i] : answers.shown_x[i];
    answers.shown_y[i] = found ? a.shown_y[i] : answers.shown_y[i];
    answers.shown_z[i] = found ? a.shown_z[i] : answers.shown_z[i];
  }
}

}  // namespace catoptra::render
