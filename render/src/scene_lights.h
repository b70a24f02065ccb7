// The points that light a scene, with their virtual lights: the one list that ray tracer and raster modes use
// (docs/decisions/0015, section "Light").
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "optics/light_path.h"
#include "render/scene.h"

namespace catoptra::render {

/// One point of a light.
struct LightPoint {
  std::size_t light = 0;  ///< in Scene::lights
  optics::LightPlace place{0, 0, 1, 0};
  /// Its share of the light's irradiance, linear RGB, without the cosine; for a position, at 1 m.
  glm::vec3 power{1};
  /// False: lights what faces it, whatever stands in the way, and planar optics send none of it on.
  bool shadows = true;
  std::vector<optics::VirtualLight> virtual_lights;  ///< `face` is an index in SceneLights::faces
};

struct SceneLights {
  std::vector<optics::LightFace> faces;  ///< of the planar optics
  std::vector<LightPoint> points;        ///< in the order of Scene::lights
  int depth = 0;                         ///< greatest number of faces in a sequence that is followed
};

/// So many virtual lights at most, over all points: each costs shadow rays, or a bit in every pixel.
inline constexpr std::size_t kMostVirtualLights = 1024;

/// Sequences of at most RenderSettings::depth faces, and of fewer where there would be more than
/// kMostVirtualLights; RenderSettings::soft_shadow_samples points for a light
/// with a radius that casts shadows, one for others. Throws Error where a planar optic is not flat.
[[nodiscard]] SceneLights scene_lights(const Scene& scene);

/// What that limit leaves out, for the user.
[[nodiscard]] std::optional<std::string> light_warning(const Scene& scene, const SceneLights& lights);

}  // namespace catoptra::render
