// Rays and planes in closed form, for judging pictures of scenes with planar optics.
#pragma once

#include <cmath>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "app/scene_file.h"

namespace catoptra::test {

/// Origin in mm and unit direction.
struct StraightRay {
  glm::dvec3 origin, direction;
};

/// Through the middle of pixel (x, y) of a picture of `size`, by a pinhole at the eye.
inline StraightRay pixel_ray(const render::Camera& camera, glm::ivec2 size, int x, int y) {
  const glm::dvec3 forward = glm::normalize(camera.target_mm - camera.eye_mm);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
  const double tall = std::tan(camera.fov_rad / 2);  // half of the picture, at unit distance
  const double across = (x + 0.5 - size.x / 2.0) / (size.y / 2.0) * tall,
               high = (size.y / 2.0 - y - 0.5) / (size.y / 2.0) * tall;
  return {camera.eye_mm, glm::normalize(forward + across * right + high * up)};
}

/// A rectangle: corners as in a scene file, counter-clockwise as seen from the front.
struct Rectangle {
  glm::dvec3 corner, u, v;  ///< u and v run along the sides
  [[nodiscard]] glm::dvec3 normal() const { return glm::normalize(glm::cross(u, v)); }

  /// Where the ray meets the plane, if before it and inside the rectangle by more than `inset_mm`.
  [[nodiscard]] std::optional<glm::dvec3> meet(const StraightRay& ray, double inset_mm = 0) const {
    const double facing = glm::dot(ray.direction, normal());
    if (facing == 0) return std::nullopt;
    const double t = glm::dot(corner - ray.origin, normal()) / facing;
    const glm::dvec3 q = ray.origin + t * ray.direction, from = q - corner;
    const auto within = [&](const glm::dvec3& side) {
      const double along = glm::dot(from, glm::normalize(side));
      return along > inset_mm && along < glm::length(side) - inset_mm;
    };
    if (t <= 0 || !within(u) || !within(v)) return std::nullopt;
    return q;
  }
};

/// An upright rectangle from the bounds of a planar optic's mesh, turned to the side that its normals point
/// to.
inline Rectangle upright_rectangle(const optics::Optic& optic) {
  glm::dvec3 low(1e300), high(-1e300);
  for (const auto& vertex : optic.mesh.vertices) {
    low = glm::min(low, vertex.position_mm);
    high = glm::max(high, vertex.position_mm);
  }
  const glm::dvec3 normal = optic.mesh.vertices.at(0).normal;
  const glm::dvec3 wide =
      glm::cross(glm::dvec3(0, 0, 1), normal);  // to the right for one who stands before it
  const glm::dvec3 size = high - low, across = glm::dot(size, glm::abs(wide)) * wide;
  const glm::dvec3 middle = (low + high) / 2.0, up(0, 0, size.z);
  return {middle - across / 2.0 - up / 2.0, across, up};
}

inline const optics::Optic& optic_named(const render::Scene& scene, const std::string& name) {
  for (const auto& optic : scene.optics)
    if (optic.name == name) return optic;
  throw std::runtime_error("no optic is called " + name);
}

inline app::SceneFile example_scene(const std::string& name) {
  return app::read_scene(std::filesystem::path(CATOPTRA_EXAMPLE_FOLDER) / (name + ".toml"));
}

}  // namespace catoptra::test
