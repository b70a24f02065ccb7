#include "render/src/scene_lights.h"

namespace catoptra::render {
namespace {

optics::LightPlace place_of(const Light& light) {
  return light.kind == LightKind::directional ? optics::LightPlace(-light.direction, 0)
                                              : optics::LightPlace(light.position_mm, 1);
}

}  // namespace

SceneLights scene_lights(const Scene& scene) {
  SceneLights result;
  result.faces = optics::light_faces(scene.optics);
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
      if (light.shadows)
        point.virtual_lights = optics::virtual_lights(place, result.faces, scene.settings.depth);
      result.points.push_back(std::move(point));
    }
  }
  return result;
}

}  // namespace catoptra::render
