// What reflection maps know of points of the scene: their colour where the map's viewpoint sees them. By it
// mode exact takes colours from the maps of mode pvrr (docs/decisions/0009-exact-mode.md).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "render/src/raster_target.h"
#include "render/src/raster_view.h"

namespace catoptra::render {

/// What 16 exact rays meet behind an optic. Structure of arrays.
struct alignas(64) MapQueries {
  static constexpr int kLanes = 16;
  float point_x[kLanes], point_y[kLanes], point_z[kLanes];              ///< mm; of the sky the direction
  float direction_x[kLanes], direction_y[kLanes], direction_z[kLanes];  ///< of the ray, unit
  float normal_x[kLanes], normal_y[kLanes], normal_z[kLanes];  ///< of the triangle met, of any length
  float distance[kLanes];       ///< along the ray from the optic to the point, mm; of the sky 1
  float half_pixel[kLanes];     ///< half the least width of the pixel's beam there, mm; of the sky, rad
  std::int32_t sky[kLanes];     ///< 1: the ray meets nothing
  std::int32_t wanted[kLanes];  ///< 1: the lane is in question; find() sets 0 where it has an answer
};

struct alignas(64) MapAnswers {
  static constexpr int kLanes = MapQueries::kLanes;
  std::int32_t found[kLanes];                      ///< 1: the rest is set
  float red[kLanes], green[kLanes], blue[kLanes];  ///< radiance
  /// The place (or, of the sky, the unit direction) whose colour it is, within the tolerance of
  /// pixel_error.h.
  float shown_x[kLanes], shown_y[kLanes], shown_z[kLanes];
};

/// Copies of maps on the CPU, any number per optic.
class MapColors {
 public:
  /// No map. Keeps its memory.
  void clear(std::size_t optics);
  /// Adds what `target` shows, which was drawn as `views` (sample offset included), each in its place.
  void add(std::size_t optic, std::span<const RasterView> views, const RasterTarget& target);

  /// The colours of what the rays meet, where a map of `optic` has seen it: where at least one of the four
  /// texels around its place lies in the plane of the triangle met and is seen from the same side, or both
  /// are sky. Others, which show what stands before or behind it, do not count. No answer where that moves
  /// the place of the colour by more than 1 arcmin and more than half a pixel, where no texel shows it, and
  /// where the map is too coarse for the pixel.
  void find(std::size_t optic, MapQueries& queries, MapAnswers& answers) const;

 private:
  struct Map {
    glm::vec3 origin_mm, right, up, ahead;
    bool perspective;
    float scale_x, scale_y, shift_x, shift_y;  ///< texel = scale * slope + shift, slope = (right, up) / depth
    float depth_factor, depth_shift;  ///< depth = factor / (stored - shift); parallel: factor * (...)
    /// Depths stored for clip depth 0 and 1: only those between them belong to this view.
    float depth_of_far, depth_of_near;
    float sense;  ///< 1, or -1 in a zooming region: rays come towards the viewpoint there
    glm::ivec2 size;
    int stride;         ///< texels from row to row
    std::size_t first;  ///< index of its first texel
  };
  struct Places;
  struct Moves;

  [[nodiscard]] static Map map_of(const RasterView& view);
  [[nodiscard]] static float clip_depth(const Map& map, float stored);
  static void find_places(const Map& map, const MapQueries& q, Places& p);
  template <bool kPerspective>
  static void find_places_in(const Map& map, const MapQueries& q, Places& p);
  static void judge(const Map& map, const MapQueries& q, Places& p, Moves& moves);
  template <bool kPerspective>
  static void judge_in(const Map& map, const MapQueries& q, Places& p, Moves& moves);
  static void answer(const Map& map, const Places& p, const Moves& moves, MapQueries& queries,
                     MapAnswers& answers);
  void fetch(const Map& map, Places& p) const;
  void reserve(std::size_t texels);

  std::vector<std::vector<Map>> maps_;  ///< by optic
  std::size_t texels_ = 0, capacity_ = 0;
  std::unique_ptr<std::uint64_t[]> colors_;  ///< RGBA, half precision, red in the lowest bits
  std::unique_ptr<float[]> depths_;          ///< reversed; 0: the sky
};

}  // namespace catoptra::render
