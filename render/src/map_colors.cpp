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
// Half a pixel, of which queries know a part (see set_half_pixels()).
constexpr float kPixelsPerHalf = float(1 / kExactTolerance_px);

static_assert(std::endian::native == std::endian::little, "a texel's red is to be in the lowest bits");

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
  std::uint32_t index[4][kLanes];            ///< within the map
  float depth[4][kLanes];                    ///< as stored
  std::uint64_t color[4][kLanes];
  std::int32_t possible[kLanes];
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
  map.origin_mm = glm::vec3(view.origin_mm);
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
  colors_.resize(map.first + count);
  glGetTextureImage(target.depth().id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                    static_cast<GLsizei>(count * sizeof(float)), &depths_[map.first]);
  glGetTextureImage(target.color().id(), 0, GL_RGBA, GL_HALF_FLOAT,
                    static_cast<GLsizei>(count * sizeof(std::uint64_t)), &colors_[map.first]);
}

void MapColors::find(std::size_t optic, MapQueries& queries, MapAnswers& answers) const {
  for (const Map& map : maps_[optic]) {
    Places p;
    find_places(map, queries, p);
    for (int k = 0; k < 4; ++k)
      for (int i = 0; i < kLanes; ++i) {
        p.depth[k][i] = depths_[map.first + p.index[k][i]];
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

CATOPTRA_VECTOR_CLONES void MapColors::find_places(const Map& map, const MapQueries& q, Places& p) {
  const glm::vec3 o = map.origin_mm, r = map.right, u = map.up, a = map.ahead;
  const bool perspective = map.perspective;
  const int last_x = map.size.x - 1, last_y = map.size.y - 1, width = map.size.x;
  const float wide = float(map.size.x), high = float(map.size.y);
  for (int i = 0; i < kLanes; ++i) {
    const bool sky = q.sky[i] != 0;
    const float dx = sky ? q.point_x[i] : q.point_x[i] - o.x, dy = sky ? q.point_y[i] : q.point_y[i] - o.y,
                dz = sky ? q.point_z[i] : q.point_z[i] - o.z;
    const float x = dx * r.x + dy * r.y + dz * r.z, y = dx * u.x + dy * u.y + dz * u.z,
                z = dx * a.x + dy * a.y + dz * a.z;
    const float gx = q.normal_x[i], gy = q.normal_y[i], gz = q.normal_z[i];
    const float per_length = 1 / std::sqrt(gx * gx + gy * gy + gz * gz);
    const float nx = (gx * r.x + gy * r.y + gz * r.z) * per_length,
                ny = (gx * u.x + gy * u.y + gz * u.z) * per_length,
                nz = (gx * a.x + gy * a.y + gz * a.z) * per_length;
    const float height = nx * x + ny * y + nz * z;
    const float facing = gx * q.direction_x[i] + gy * q.direction_y[i] + gz * q.direction_z[i];
    const float per_depth = perspective ? 1 / z : 1.0f;
    const float at_x = x * per_depth, at_y = y * per_depth;
    const float column = map.scale_x * at_x + map.shift_x, row = map.scale_y * at_y + map.shift_y;
    // The map has to see the side that the ray meets. A parallel map shows the sky of one direction.
    const bool seen = sky ? perspective : (perspective ? height : nz) * facing > 0;
    const bool inside = column >= 0 && row >= 0 && column <= wide && row <= high;
    const bool possible = q.wanted[i] != 0 && (!perspective || z > 0) && seen && inside;
    p.x[i] = x;
    p.y[i] = y;
    p.z[i] = z;
    p.nx[i] = nx;
    p.ny[i] = ny;
    p.nz[i] = nz;
    p.height[i] = height;
    p.at_x[i] = at_x;
    p.at_y[i] = at_y;
    p.possible[i] = possible;
    const float from_left = possible ? column : 0.0f, from_top = possible ? row : 0.0f;
    const int left = int(from_left + 0.5f) - 1, top = int(from_top + 0.5f) - 1;
    const float right = from_left - (float(left) + 0.5f), down = from_top - (float(top) + 0.5f);
    for (int k = 0; k < 4; ++k) {
      const int cx = left + k % 2, cy = top + k / 2;
      const bool in_map = cx >= 0 && cy >= 0 && cx <= last_x && cy <= last_y;
      const int bx = std::min(std::max(cx, 0), last_x), by = std::min(std::max(cy, 0), last_y);
      p.index[k][i] = std::uint32_t(by * width + bx);
      p.off_x[k][i] = float(k % 2) - right;
      p.off_y[k][i] = float(k / 2) - down;
      p.weight[k][i] = in_map ? (k % 2 ? right : 1 - right) * (k / 2 ? down : 1 - down) : 0.0f;
    }
  }
}

/// Leaves weights to the texels that show what the ray meets. The colour is their mean, so its place is the mean of
/// theirs.
CATOPTRA_VECTOR_CLONES void MapColors::judge(const Map& map, const MapQueries& q, Places& p,
                                             MapAnswers& answers) {
  const bool perspective = map.perspective;
  const float per_x = 1 / map.scale_x, per_y = 1 / map.scale_y;
  const glm::vec3 r = map.right, u = map.up, a = map.ahead;
  for (int i = 0; i < kLanes; ++i) {
    const bool sky = q.sky[i] != 0;
    const float x = p.x[i], y = p.y[i], z = p.z[i], distance = q.distance[i];
    const float largest = std::max(std::max(std::abs(q.point_x[i]), std::abs(q.point_y[i])),
                                   std::max(std::abs(q.point_z[i]), std::abs(z)));
    const float allowed = kTolerance_rad * distance + kRounding * largest;
    float sum = 0, moved_x = 0, moved_y = 0, moved_z = 0;
    for (int k = 0; k < 4; ++k) {
      const float side_x = p.at_x[i] + p.off_x[k][i] * per_x, side_y = p.at_y[i] + p.off_y[k][i] * per_y;
      const float stored = p.depth[k][i], shifted = stored - map.depth_shift;
      const float met = perspective ? map.depth_factor / shifted : map.depth_factor * shifted;
      const float depth = sky ? z : met, lateral = perspective ? depth : 1.0f;
      const float sx = lateral * side_x, sy = lateral * side_y;
      const float out = p.nx[i] * sx + p.ny[i] * sy + p.nz[i] * depth - p.height[i];
      const bool same = sky ? stored == 0 : stored != 0 && std::abs(out) <= allowed;
      const float weight = same ? p.weight[k][i] : 0.0f;
      p.weight[k][i] = weight;
      sum += weight;
      moved_x += weight > 0 ? weight * (sx - x) : 0.0f;
      moved_y += weight > 0 ? weight * (sy - y) : 0.0f;
      moved_z += weight > 0 ? weight * (depth - z) : 0.0f;
    }
    const float per_sum = 1 / std::max(sum, kLeastWeight);
    moved_x *= per_sum;
    moved_y *= per_sum;
    moved_z *= per_sum;
    for (int k = 0; k < 4; ++k) p.weight[k][i] *= per_sum;
    const float dx = q.direction_x[i], dy = q.direction_y[i], dz = q.direction_z[i];
    const float d_right = dx * r.x + dy * r.y + dz * r.z, d_up = dx * u.x + dy * u.y + dz * u.z,
                d_ahead = dx * a.x + dy * a.y + dz * a.z;
    const float along = moved_x * d_right + moved_y * d_up + moved_z * d_ahead;
    const float across_x = moved_x - along * d_right, across_y = moved_y - along * d_up,
                across_z = moved_z - along * d_ahead;
    const float across2 = across_x * across_x + across_y * across_y + across_z * across_z;
    const float angle = kTolerance_rad * distance, limit = std::max(angle, q.half_pixel[i]);
    // A texel's sides, across the ray.
    const float side_x = std::abs(per_x) * std::sqrt(std::max(0.0f, 1 - d_right * d_right)),
                side_y = std::abs(per_y) * std::sqrt(std::max(0.0f, 1 - d_up * d_up));
    const float texel = (perspective ? z : 1.0f) * std::max(side_x, side_y);
    answers.found[i] = p.possible[i] && sum >= kLeastWeight && across2 <= limit * limit &&
                       texel <= kCoarsest * std::max(angle, kPixelsPerHalf * q.half_pixel[i]);
    const float shown_x = q.point_x[i] + moved_x * r.x + moved_y * u.x + moved_z * a.x,
                shown_y = q.point_y[i] + moved_x * r.y + moved_y * u.y + moved_z * a.y,
                shown_z = q.point_z[i] + moved_x * r.z + moved_y * u.z + moved_z * a.z;
    const float scale =
        sky ? 1 / std::sqrt(shown_x * shown_x + shown_y * shown_y + shown_z * shown_z) : 1.0f;
    answers.shown_x[i] = scale * shown_x;
    answers.shown_y[i] = scale * shown_y;
    answers.shown_z[i] = scale * shown_z;
  }
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
