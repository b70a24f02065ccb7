// The tables [camera], [environment], [[light]] and [render].
#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "app/src/scene_context.h"

namespace catoptra::app {
namespace {

/// Largest side of a picture in pixels: what OpenGL drivers in use can render to.
constexpr int kMaxResolution = 16384;

void check_camera(const TomlTable& table, const render::Camera& camera) {
  const glm::dvec3 view = camera.target_mm - camera.eye_mm;
  if (glm::length(view) == 0)
    table.fail(table.has("target") ? "target" : "eye", "eye and target are the same point");
  if (glm::length(camera.up) == 0) table.fail("up", "must not be the zero vector");
  const double sine = glm::length(glm::cross(glm::normalize(view), glm::normalize(camera.up)));
  // Below this (0.06 degrees) rounding of the keys decides how the picture is turned.
  if (sine < 1e-3)
    table.fail(table.has("up") ? "up" : "target", "the up vector is parallel to the view direction",
               "choose another up");
}

render::Light read_light(const TomlTable& table, const SceneContext& context) {
  render::Light light;
  const std::string kind = table.choice("kind", {"directional", "point", "area"}).value_or("directional");
  light.kind = kind == "point"  ? render::LightKind::point
               : kind == "area" ? render::LightKind::area
                                : render::LightKind::directional;
  const bool directional = light.kind == render::LightKind::directional;
  if (directional && table.has("position"))
    table.fail("position", "a directional light has no position", "use direction, or kind = \"point\"");
  if (!directional && !table.has("position")) table.fail_missing("position", "point and area lights need it");
  if (light.kind == render::LightKind::point && table.has("direction"))
    table.fail("direction", "a point light has no direction", "use position, or kind = \"directional\"");
  if (const auto direction = table.vec3("direction")) {
    if (glm::length(*direction) == 0) table.fail("direction", "must not be the zero vector");
    light.direction = glm::normalize(*direction);
  }
  if (const auto position = table.vec3("position")) light.position_mm = *position * context.unit_mm;
  if (const auto color = table.vec3("color", Range::not_negative())) light.color = *color;
  if (const auto intensity = table.number("intensity", Range::not_negative()))
    light.intensity = static_cast<float>(*intensity);
  if (const auto radius = table.number("radius", Range::not_negative()))
    light.radius_mm = *radius * context.unit_mm;
  light.shadows = table.boolean("shadows").value_or(true);
  return light;
}

}  // namespace

render::Camera read_camera(const TomlTable& root, const SceneContext& context) {
  render::Camera camera;
  const toml::table* found = root.table("camera");
  if (!found) return camera;
  const TomlTable table(*found, context.name, "camera",
                        {"eye", "target", "up", "fov_deg", "resolution", "pupil_mm", "focus_mm"});
  if (const auto eye = table.vec3("eye")) camera.eye_mm = *eye * context.unit_mm;
  if (const auto target = table.vec3("target")) camera.target_mm = *target * context.unit_mm;
  if (const auto up = table.vec3("up")) camera.up = *up;
  camera.fov_rad = glm::radians(table.number("fov_deg", {0.01, 170}).value_or(40));
  if (const auto resolution = table.numbers("resolution", 2, {1, kMaxResolution})) {
    camera.resolution = {static_cast<int>((*resolution)[0]), static_cast<int>((*resolution)[1])};
    if (camera.resolution.x != (*resolution)[0] || camera.resolution.y != (*resolution)[1])
      table.fail("resolution", "expected two integers");
  }
  camera.pupil_mm = table.number("pupil_mm", {0, 1000}).value_or(0);
  camera.focus_mm = table.number("focus_mm", {0, 1e9}).value_or(0);
  check_camera(table, camera);
  return camera;
}

render::Environment read_environment(const TomlTable& root, const SceneContext& context) {
  render::Environment environment;
  const toml::table* found = root.table("environment");
  if (!found) return environment;
  const TomlTable table(*found, context.name, "environment", {"color", "sky", "ambient"});
  if (table.has("color") && table.has("sky"))
    table.fail("color", "color and sky exclude each other", "leave one of them out");
  if (const auto color = table.vec3("color", Range::not_negative())) environment.color = *color;
  if (table.has("sky")) environment.sky = read_path(table, context, "sky").string();
  if (const auto ambient = table.number("ambient", Range::not_negative()))
    environment.ambient = static_cast<float>(*ambient);
  return environment;
}

std::vector<render::Light> read_lights(const TomlTable& root, const SceneContext& context) {
  std::vector<render::Light> lights;
  for (const toml::table* entry : root.tables("light")) {
    const TomlTable table(*entry, context.name, "light",
                          {"kind", "direction", "position", "color", "intensity", "radius", "shadows"});
    lights.push_back(read_light(table, context));
  }
  return lights;
}

render::RenderSettings read_render_settings(const TomlTable& root) {
  render::RenderSettings settings;
  settings.max_error_px = 0.5;
  const toml::table* found = root.table("render");
  if (!found) return settings;
  const TomlTable table(*found, root.file(), "render",
                        {"mode", "max_error_px", "patch_fov_deg", "max_patches", "depth", "chord_mm",
                         "angle_deg", "texels_per_pixel", "soft_shadow_samples", "soft_shadows"});
  settings.mode = table.choice("mode", {"pvrr", "hybrid", "exact", "raytrace", "cubemap", "auto"})
                      .value_or(settings.mode);
  settings.max_error_px = table.number("max_error_px", Range::not_negative()).value_or(settings.max_error_px);
  settings.patch_fov_rad = glm::radians(table.number("patch_fov_deg", {1, 170}).value_or(60));
  settings.max_patches = table.integer("max_patches", 1, 64).value_or(settings.max_patches);
  settings.depth = table.integer("depth", 1, 32).value_or(settings.depth);
  settings.chord_mm = table.number("chord_mm", Range::positive()).value_or(settings.chord_mm);
  settings.angle_rad = glm::radians(table.number("angle_deg", {0, 90, true}).value_or(5));
  settings.texels_per_pixel =
      table.number("texels_per_pixel", {0.05, 16}).value_or(settings.texels_per_pixel);
  settings.soft_shadow_samples =
      table.integer("soft_shadow_samples", 1, 4096).value_or(settings.soft_shadow_samples);
  if (table.choice("soft_shadows", {"points", "levels"}).value_or("points") == "levels")
    settings.soft_shadows = render::SoftShadows::levels;
  return settings;
}

}  // namespace catoptra::app
