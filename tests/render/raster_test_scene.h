// Scenes that the tests of the raster modes share: a mirror at the origin facing +z, a room in front of it.
#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/scene.h"
#include "tests/support/analytic_optic.h"

namespace catoptra::test {

/// Adds the parallelogram corner, corner + a, corner + a + b, corner + b; its normal is along cross(a, b).
inline void add_quad(cad_import::TriangleMesh& mesh, glm::vec3 corner, glm::vec3 a, glm::vec3 b,
                     glm::vec3 color, int texture = -1) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  const glm::vec3 normal = glm::normalize(glm::cross(a, b));
  for (const glm::vec3& p : {corner, corner + a, corner + a + b, corner + b}) {
    mesh.positions.push_back(p);
    mesh.normals.push_back(normal);
  }
  for (const glm::vec2& st : {glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(1, 0), glm::vec2(0, 0)})
    mesh.texture_coordinates.push_back(st);
  mesh.triangles.push_back({base, base + 1, base + 2});
  mesh.triangles.push_back({base, base + 2, base + 3});
  cad_import::Material material;
  material.base_color = color;
  material.texture = texture;
  mesh.triangle_material.insert(mesh.triangle_material.end(), 2,
                                static_cast<std::uint32_t>(mesh.materials.size()));
  mesh.materials.push_back(material);
}

inline void add_box(cad_import::TriangleMesh& mesh, glm::vec3 low, glm::vec3 high, glm::vec3 color) {
  const glm::vec3 d = high - low, x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
  add_quad(mesh, low, y, x, color);
  add_quad(mesh, low + z, x, y, color);
  add_quad(mesh, low, z, y, color);
  add_quad(mesh, low + x, y, z, color);
  add_quad(mesh, low, x, z, color);
  add_quad(mesh, low + y, z, x, color);
}

inline constexpr glm::vec3 kRed{0.8f, 0.05f, 0.05f}, kGreen{0.05f, 0.7f, 0.05f}, kBlue{0.05f, 0.05f, 0.8f};
inline constexpr glm::vec3 kMagenta{0.8f, 0, 0.8f}, kYellow{0.9f, 0.8f, 0.05f};

/// A wall at z = 5000 with a red panel at x < 0 and a blue one at x > 0, a green box before it, a floor of
/// tiles at y = -900, and two lights. No optic. Camera: at (0, 0, 800), looking at the origin, +y up.
inline render::Scene room() {
  render::Scene scene;
  scene.file = "room";
  scene.camera = {{0, 0, 800}, {0, 0, 0}, {0, 1, 0}, 0.4, {320, 240}};
  scene.environment = {{0.3f, 0.5f, 0.9f}, "", 0.3f};
  scene.lights = {{render::LightKind::directional,
                   glm::normalize(glm::dvec3(0.3, -0.8, 0.5)),
                   {},
                   glm::vec3(1),
                   0.8f,
                   0,
                   true},
                  {render::LightKind::point, {0, 0, -1}, {500, 800, 3000}, {1, 0.9f, 0.8f}, 2.0f, 0, true}};
  cad_import::TriangleMesh mesh;
  add_quad(mesh, {4000, -900, 5000}, {-8000, 0, 0}, {0, 3400, 0}, glm::vec3(0.7f));
  add_quad(mesh, {-300, -200, 4990}, {-900, 0, 0}, {0, 700, 0}, kRed);
  add_quad(mesh, {1200, -200, 4990}, {-900, 0, 0}, {0, 700, 0}, kBlue);
  add_box(mesh, {-500, -900, 2500}, {-100, -300, 2900}, kGreen);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      add_quad(mesh, {-2000.0f + 500.0f * float(i), -900, 1000.0f + 500.0f * float(j)}, {0, 0, 500},
               {500, 0, 0}, (i + j) % 2 ? glm::vec3(0.15f) : glm::vec3(0.6f));
  scene.surroundings.push_back(std::move(mesh));
  return scene;
}

inline render::FrameOptions picture_of(const render::Scene& scene, int samples = 1, bool geometry = true) {
  render::FrameOptions options;
  options.width = scene.camera.resolution.x;
  options.height = scene.camera.resolution.y;
  options.samples = samples;
  options.geometry = geometry;
  return options;
}

/// Angle between two directions of any length, arcmin.
inline double angle_arcmin(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 * 60 / 3.14159265358979;
}

/// Where the position layer says that pixel `i` looks from its surface point (a direction where it shows the
/// sky).
inline glm::dvec3 shown_direction(const render::Frame& frame, std::size_t i, const glm::dvec3& from) {
  const glm::dvec3 shown(glm::vec3(frame.position[i]));
  return frame.position[i].w == 0 ? shown : shown - from;
}

/// The angle that a pixel at the picture's centre spans, arcmin.
inline double pixel_arcmin(const render::Scene& scene) {
  return 2 * std::tan(scene.camera.fov_rad / 2) / scene.camera.resolution.y * 180 * 60 / 3.14159265358979;
}

}  // namespace catoptra::test
