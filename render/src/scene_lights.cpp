#include "render/src/scene_lights.h"

namespace catoptra::render {
namespace {

optics::LightPlace place_of(const Light& light) {
  return light.kind == LightKind::directional ? optics::LightPlace(-light.direction, 0)
                                              : optics::LightPlace(light.position_mm, 1);
}

std::size_t virtual_count(const SceneLights& lights) {
  std::size_t count = 0;
  for (const LightPoint& point : lights.points) count += point.virtual_lights.size();
  return count;
}

void add_points(const Scene& scene, SceneLights& result) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const int count = light.shadows ? scene.settings.soft_shadow_samples : 1;
    const auto places = optics::disc_lights(place_of(light), light.direction, light.radius_mm, count);
    for (const optics::LightPlace& place : places) {
      LightPoint point;
      point.light = i;
      point.place = place;
      point.power = light.color * light.intensity / float(places.size());
      point.shadows = light.shadows;
      result.points.push_back(std::move(point));
    }
  }
}

/// Follows light one face farther than before; false, and all as it was, where that makes too many.
bool follow_farther(SceneLights& lights) {
  SceneLights farther = lights;
  ++farther.depth;
  std::size_t count = 0;
  for (LightPoint& point : farther.points) {
    if (!point.shadows) continue;
    point.virtual_lights = optics::virtual_lights(point.place, farther.faces, farther.depth);
    count += point.virtual_lights.size();
    if (count > kMostVirtualLights) return false;
  }
  lights = std::move(farther);
  return true;
}

}  // namespace

SceneLights scene_lights(const Scene& scene) {
  SceneLights result;
  result.faces = optics::light_faces(scene.optics);
  add_points(scene, result);
  std::size_t before = 0;
  while (!result.faces.empty() && result.depth < scene.settings.depth && follow_farther(result)) {
    const std::size_t count = virtual_count(result);
    if (count == before) {  // no light goes on
      result.depth = scene.settings.depth;
      break;
    }
    before = count;
  }
  return result;
}

std::optional<std::string> light_warning(const Scene& scene, const SceneLights& lights) {
  if (lights.faces.empty() || lights.depth >= scene.settings.depth) return std::nullopt;
  return "light is followed over " + std::to_string(lights.depth) + " instead of " +
         std::to_string(scene.settings.depth) + " planar optics: more than " +
         std::to_string(kMostVirtualLights) +
         " virtual lights would be needed (fewer render.soft_shadow_samples or shadows = false on some "
         "light)";
}

}  // namespace catoptra::render
