// The points that light a scene and their virtual lights as the raster modes number and shade them.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "render/src/scene_lights.h"

namespace catoptra::render {

/// An entry of light_points[] in raster_lights.glsl: first all points, then their virtual lights, each after
/// the one before it.
struct ShadowPoint {
  std::size_t point = 0;                       ///< in SceneLights::points
  int virtual_light = -1;                      ///< of that point; -1: the point itself
  int before = -1;                             ///< virtual lights: number of the entry before it
  int bit = -1;                                ///< in the visibility of a pixel; -1: it casts no shadows
  bool as_before = false;                      ///< lights like the entry before it, but for its bit
  optics::LightPlace shaded_from{0, 0, 1, 0};  ///< the place that says how bright it is
  double gain = 1;
};

/// With `levels`, all points of a light shade from its centre, so that their bits count levels of darkness.
[[nodiscard]] std::vector<ShadowPoint> shadow_points(const Scene& scene, const SceneLights& lights,
                                                     bool levels);

/// What shaders read of an entry; places relative to `origin_mm`.
struct GpuShadowPoint {
  glm::vec4 place, power, plane, passes, medium;
};
[[nodiscard]] std::vector<GpuShadowPoint> gpu_shadow_points(const std::vector<ShadowPoint>& entries,
                                                            const SceneLights& lights,
                                                            const glm::dvec3& origin_mm);

}  // namespace catoptra::render
