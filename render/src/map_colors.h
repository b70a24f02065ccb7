// What reflection maps know of points of the scene: their colour where the map's viewpoint sees them. By it
// mode exact takes colours from the maps of mode pvrr (docs/decisions/0009-exact-mode.md).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "render/src/raster_target.h"
#include "render/src/raster_view.h"

namespace catoptra::render {

/// What an exact ray meets behind an optic.
struct MapQuery {
  glm::vec3 point_mm{0};   ///< of the surroundings; unused for the sky
  glm::vec3 direction{0};  ///< of the ray, unit
  glm::vec3 normal{0};     ///< unit, of the triangle met, either sense
  float distance_mm = 0;   ///< along the ray from the optic to the point
  float half_pixel = 0;    ///< half the least width of the pixel's beam there, mm; of the sky, rad
  bool sky = false;
};

struct MapColor {
  glm::vec3 radiance{0};
  glm::vec3 shown{0};  ///< the place (or, of the sky, the unit direction) whose colour it is; within the
                       ///< tolerance of pixel_error.h
};

/// Copies of maps on the CPU, any number per optic.
class MapColors {
 public:
  /// No map. Keeps its memory.
  void clear(std::size_t optics);
  /// Adds what `target` shows, which was drawn as `view` (sample offset included).
  void add(std::size_t optic, const RasterView& view, const RasterTarget& target);

  /// The colour of what the ray meets, where a map of `optic` has seen it: where at least one of the four
  /// texels around its place lies in the plane of the triangle met and is seen from the same side. Others,
  /// which show what stands before or behind it, do not count. Where that moves the place of the colour by
  /// more than 1 arcmin and more than half a pixel, and where no texel shows it: nullopt.
  [[nodiscard]] std::optional<MapColor> find(std::size_t optic, const MapQuery& query) const;

 private:
  struct Map {
    glm::dvec3 origin_mm;
    glm::vec3 right, up, ahead;
    bool perspective;
    float scale_x, scale_y, shift_x, shift_y;  ///< texel = scale * slope + shift, slope = (right, up) / depth
    float depth_factor, depth_shift;
    glm::ivec2 size;
    std::size_t first;  ///< index of its first texel

    [[nodiscard]] float depth_mm(float stored) const;
  };
  struct Texels;

  [[nodiscard]] std::optional<Texels> texels_at(const Map& map, glm::vec3 place) const;
  [[nodiscard]] std::optional<MapColor> find_point(const Map& map, const MapQuery& query) const;
  [[nodiscard]] std::optional<MapColor> find_sky(const Map& map, const MapQuery& query) const;
  [[nodiscard]] glm::vec3 mean(const Texels& texels) const;

  std::vector<std::vector<Map>> maps_;  ///< by optic
  std::vector<std::uint16_t> colors_;   ///< RGBA, half precision
  std::vector<float> depths_;           ///< reversed; 0: the sky
};

}  // namespace catoptra::render
