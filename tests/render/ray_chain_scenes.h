// Scenes of several optics with closed forms.
#pragma once

#include <vector>

#include "optics/placement.h"
#include "render/src/sampling.h"
#include "tests/render/ray_scenes.h"
#include "tests/support/analytic_lens.h"

namespace catoptra::test {

/// `optic` (around the origin, facing +z) moved so that its pole is at `pole_mm` and faces `normal` (unit).
inline optics::Optic facing(const optics::Optic& optic, const glm::dvec3& pole_mm, const glm::dvec3& normal) {
  const glm::dvec3 side = glm::normalize(
      glm::cross(std::abs(normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), normal));
  return optics::placed(optic, {glm::dmat3(side, glm::cross(normal, side), normal), pole_mm});
}

/// A square plane mirror.
inline optics::Optic plane_mirror(const glm::dvec3& pole_mm, const glm::dvec3& normal, double width_mm) {
  return facing(conic_mirror(0, 0, width_mm, width_mm, 3, 3), pole_mm, normal);
}

/// `point` mirrored at the plane through `pole` across `normal`.
inline glm::dvec3 mirrored(const glm::dvec3& point, const glm::dvec3& pole, const glm::dvec3& normal) {
  return point - 2 * glm::dot(point - pole, normal) * normal;
}

/// A cube around `center` that shines with `radiance` and nothing else.
inline void add_shining_cube(render::Scene& scene, const glm::dvec3& center, double side_mm,
                             const glm::vec3& radiance) {
  cad_import::TriangleMesh mesh = empty_mesh();
  mesh.materials[0].base_color = glm::vec3(0);
  mesh.materials[0].emissive = radiance;
  add_box(mesh, glm::vec3(center - 0.5 * side_mm), glm::vec3(float(side_mm)));
  scene.surroundings.push_back(mesh);
}

/// A scene without light but what things shine with, under a dark sky.
inline render::Scene dark_scene(int depth) {
  render::Scene scene;
  scene.environment.color = glm::vec3(0);
  scene.environment.ambient = 0;
  scene.settings.depth = depth;
  return scene;
}

/// The number of a path by its optics in order.
inline std::uint32_t path_by(const std::vector<int>& optics) {
  std::uint32_t path = 0;
  for (const int optic : optics) path = render::path_after(path, optic);
  return path;
}

/// Row-major index of the pixel nearest to where `camera` shows `point`.
inline std::size_t pixel_of(const render::Camera& camera, int width, int height, const glm::dvec3& point) {
  const render::CameraRays rays = render::camera_rays(camera, width, height);
  const glm::dvec3 way = point - rays.eye_mm;
  const glm::dvec3 at = way / glm::dot(way, rays.forward) - rays.corner;
  const double column = glm::dot(at, rays.dx) / glm::dot(rays.dx, rays.dx),
               row = glm::dot(at, rays.dy) / glm::dot(rays.dy, rays.dy);
  return std::size_t(std::lround(row)) * std::size_t(width) + std::size_t(std::lround(column));
}

/// Unit ray of the eye through the centre of pixel `i`.
inline glm::dvec3 ray_of(const render::Camera& camera, int width, int height, std::size_t i) {
  const render::CameraRays rays = render::camera_rays(camera, width, height);
  return glm::normalize(rays.direction(double(i % std::size_t(width)), double(i / std::size_t(width))));
}

}  // namespace catoptra::test
