#include "render/src/shadow_points.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

namespace catoptra::render {
namespace {

using optics::OpticKind;

/// The faces of a way and what each does, which two points of a light may have in common.
std::vector<std::pair<std::size_t, bool>> way_of(const std::vector<optics::VirtualLight>& lights, int index) {
  std::vector<std::pair<std::size_t, bool>> way;
  for (; index >= 0; index = lights[std::size_t(index)].before)
    way.emplace_back(lights[std::size_t(index)].face, lights[std::size_t(index)].reflected);
  return way;
}

/// The same scene with all lights' centres alone.
SceneLights centres_of(const Scene& scene) {
  Scene centres;
  centres.lights = scene.lights;
  for (Light& light : centres.lights) light.radius_mm = 0;
  centres.optics = scene.optics;
  centres.settings = scene.settings;
  return scene_lights(centres);
}

/// Shades the entry from where the centre of its light would be.
void shade_from_centre(ShadowPoint& entry, const SceneLights& lights, const SceneLights& centres) {
  const LightPoint& point = lights.points[entry.point];
  const auto centre = std::ranges::find(centres.points, point.light, &LightPoint::light);
  if (entry.virtual_light < 0) {
    entry.shaded_from = centre->place;
    return;
  }
  const auto way = way_of(point.virtual_lights, entry.virtual_light);
  for (int i = 0; i < int(centre->virtual_lights.size()); ++i)
    if (way_of(centre->virtual_lights, i) == way) {
      entry.shaded_from = centre->virtual_lights[std::size_t(i)].place;
      entry.gain = centre->virtual_lights[std::size_t(i)].gain;
    }
}

/// As in raster_lights.glsl.
float step_kind(OpticKind kind, bool reflected) {
  switch (kind) {
    case OpticKind::refractor:
      return reflected ? 1 : 2;
    case OpticKind::pane:
      return reflected ? 3 : 4;
    default:
      return 0;
  }
}

}  // namespace

std::vector<ShadowPoint> shadow_points(const Scene& scene, const SceneLights& lights, bool levels) {
  std::vector<ShadowPoint> entries;
  int bits = 0;
  for (std::size_t i = 0; i < lights.points.size(); ++i) {
    ShadowPoint entry;
    entry.point = i;
    entry.shaded_from = lights.points[i].place;
    if (lights.points[i].shadows) entry.bit = bits++;
    entry.as_before = levels && i > 0 && lights.points[i].light == lights.points[i - 1].light;
    entries.push_back(entry);
  }
  for (std::size_t i = 0; i < lights.points.size(); ++i) {
    const int first = int(entries.size());
    for (int k = 0; k < int(lights.points[i].virtual_lights.size()); ++k) {
      const optics::VirtualLight& light = lights.points[i].virtual_lights[std::size_t(k)];
      entries.push_back(
          {i, k, light.before < 0 ? int(i) : first + light.before, bits++, false, light.place, light.gain});
    }
  }
  if (!levels) return entries;
  const SceneLights centres = centres_of(scene);
  for (ShadowPoint& entry : entries) shade_from_centre(entry, lights, centres);
  return entries;
}

std::vector<GpuShadowPoint> gpu_shadow_points(const std::vector<ShadowPoint>& entries,
                                              const SceneLights& lights, const glm::dvec3& origin_mm) {
  std::vector<GpuShadowPoint> gpu;
  gpu.reserve(entries.size());
  for (const ShadowPoint& entry : entries) {
    const LightPoint& point = lights.points[entry.point];
    GpuShadowPoint out{};
    out.place = glm::vec4(entry.shaded_from - glm::dvec4(entry.shaded_from.w * origin_mm, 0));
    out.power = glm::vec4(point.power, entry.gain);
    out.plane.w = entry.as_before ? 1 : 0;
    out.medium = {1, 1, entry.before, entry.bit};
    if (entry.virtual_light >= 0) {
      const optics::VirtualLight& light = point.virtual_lights[std::size_t(entry.virtual_light)];
      const optics::LightFace& face = lights.faces[light.face];
      const glm::dvec3 normal(light.lit_side);
      out.plane = glm::vec4(glm::vec3(normal), float(light.lit_side.w + glm::dot(normal, origin_mm)));
      out.passes = glm::vec4(face.kind == OpticKind::mirror ? face.reflectance : face.tint,
                             step_kind(face.kind, light.reflected));
      out.medium.x = float(light.n_from);
      out.medium.y = float(light.n_to);
    }
    gpu.push_back(out);
  }
  return gpu;
}

}  // namespace catoptra::render
