// Scenes of light and shadow, and a probe that reads irradiance at a point of them.
#pragma once

#include <glm/geometric.hpp>
#include <utility>

#include "optics/placement.h"
#include "tests/render/ray_scenes.h"

namespace catoptra::test {

/// A white scene without ambient light, so that radiance is irradiance.
inline render::Scene dark_scene() {
  render::Scene scene;
  scene.surroundings.push_back(empty_mesh());
  scene.environment = {{0, 0, 0}, "", 0};
  return scene;
}

/// A flat optic of 2 `half` square, front along `front`.
inline optics::Optic square_optic(optics::OpticKind kind, double half, const glm::dvec3& centre,
                                  const glm::dvec3& front = {0, 0, 1}) {
  optics::Optic optic = conic_mirror(0, 0, 2 * half, 2 * half, 2, 2);
  optic.kind = kind;
  optic.planar = true;
  optic.two_sided = kind == optics::OpticKind::mirror;
  const glm::dvec3 x =
      glm::normalize(glm::cross(std::abs(front.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1), front));
  optics::Placement placement;
  placement.rotation = glm::dmat3(x, glm::cross(front, x), front);
  placement.translation_mm = centre;
  return optics::placed(optic, placement);
}

inline render::Light sun(const glm::dvec3& towards) {
  render::Light light;
  light.direction = -glm::normalize(towards);
  return light;
}

/// Irradiance (green) of the white surface at `point`, seen from `offset` beyond it.
inline double irradiance(const TracedScene& traced, const glm::dvec3& point,
                         const glm::dvec3& offset = {0, 0, 20}) {
  render::Camera camera;
  camera.eye_mm = point + offset;
  camera.target_mm = point;
  camera.up = std::abs(glm::normalize(offset).z) > 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  camera.fov_rad = 1e-4;
  render::FrameOptions options;
  options.width = options.height = 1;
  return double(traced.tracer->render(camera, options).frame.color[0].g);
}

/// Where between `from` (brighter than `level`) and `to` the irradiance falls below `level`, by bisection to
/// 1e-5 of the way.
inline glm::dvec3 edge_between(const TracedScene& traced, glm::dvec3 from, glm::dvec3 to, double level,
                               const glm::dvec3& offset = {0, 0, 20}) {
  for (int i = 0; i < 17; ++i) {
    const glm::dvec3 middle = 0.5 * (from + to);
    (irradiance(traced, middle, offset) > level ? from : to) = middle;
  }
  return 0.5 * (from + to);
}

}  // namespace catoptra::test
