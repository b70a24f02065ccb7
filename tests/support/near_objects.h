// A textured room with near and far objects before a mirror or behind a lens, for any optic wherever it is.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>
#include <string>
#include <utility>

#include "optics/lens_path.h"
#include "render/scene.h"
#include "tests/render/ray_scenes.h"

namespace catoptra::test {

/// Waves of colour that differ in the three channels: a wrong place has a wrong colour. No abrupt steps, so
/// that the level of detail matters little.
inline render::Frame waves(int size) {
  return painted(size, [=](int column, int row) {
    const double x = 6.2831853 * column / size, y = 6.2831853 * row / size;
    return glm::vec3(0.5 + 0.4 * std::sin(3 * x + std::sin(y)), 0.5 + 0.4 * std::sin(4 * y + 1),
                     0.5 + 0.4 * std::sin(2 * x - 3 * y));
  });
}

/// Where an optic is, how large, and where it looks: a mirror by its normals, a lens away from its front.
struct OpticPlace {
  glm::dvec3 center{0}, ahead{0, 0, 1};
  double radius_mm = 1;
};

inline OpticPlace place_of(const optics::Optic& optic) {
  OpticPlace place;
  glm::dvec3 low(1e300), high(-1e300), normal(0);
  double largest = 0;
  glm::dvec3 of_largest(0, 0, 1);
  for (const auto& t : optic.mesh.triangles) {
    const glm::dvec3 a = optic.mesh.vertices[t.vertices[0]].position_mm,
                     b = optic.mesh.vertices[t.vertices[1]].position_mm,
                     c = optic.mesh.vertices[t.vertices[2]].position_mm, n = glm::cross(b - a, c - a);
    normal += n;
    if (glm::length(n) > largest) largest = glm::length(of_largest = n);
    for (const glm::dvec3& p : {a, b, c}) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  if (glm::length(normal) < 0.1 * largest) normal = of_largest;  // a closed surface: one side of it
  const bool lens = optic.kind == optics::OpticKind::lens;
  place.center = 0.5 * (low + high);
  place.ahead = (lens || optic.flip ? -1.0 : 1.0) * glm::normalize(normal);
  place.radius_mm = 0.5 * glm::length(high - low);
  return place;
}

/// The room in units of the optic's radius, the optic at the origin looking along +z: walls, and bars and
/// boxes from 0.7 radii on. `texture`: a file, all over.
inline cad_import::TriangleMesh room_of_near_objects(const std::string& texture) {
  cad_import::TriangleMesh mesh = empty_mesh();
  mesh.textures.push_back({"waves", texture, {}});
  mesh.materials[0].texture = 0;
  add_quad(mesh, {30, -20, 40}, {-60, 0, 0}, {0, 40, 0}, 0, 2);   // back wall
  add_quad(mesh, {-30, -6, -20}, {0, 0, 60}, {60, 0, 0}, 0, 3);   // floor
  add_quad(mesh, {-30, -20, -20}, {0, 40, 0}, {0, 0, 60}, 0, 2);  // side walls
  add_quad(mesh, {30, -20, -20}, {0, 0, 60}, {0, 40, 0}, 0, 2);
  const std::size_t of_walls = mesh.texture_coordinates.size();
  add_box(mesh, {-1.2f, -1.0f, 0.7f}, {0.12f, 1.5f, 0.12f});  // near bars
  add_box(mesh, {-0.4f, -1.4f, 1.3f}, {0.1f, 2.2f, 0.1f});
  add_box(mesh, {-3.6f, -0.2f, 2.2f}, {3.5f, 0.15f, 0.15f});
  add_box(mesh, {-3.0f, -6.0f, 5.0f}, {1.2f, 5.0f, 1.2f});  // pillars
  add_box(mesh, {0.8f, -6.0f, 8.0f}, {1.5f, 8.0f, 1.5f});
  add_box(mesh, {-6.0f, -6.0f, 14.0f}, {2.0f, 4.0f, 2.0f});
  // Bars are narrow: a few pixels would hold all the waves of the texture, which no sampling resolves.
  for (std::size_t i = of_walls; i < mesh.texture_coordinates.size(); ++i)
    mesh.texture_coordinates[i] *= 0.2f;
  return mesh;
}

/// Puts the room around optic `index`, in place of what stood there, and aims the camera. A mirror is seen
/// from 25 degrees aside, a lens from straight before it. `eye_radii`: how far off the eye is.
inline void add_near_objects(render::Scene& scene, std::size_t index, const std::string& texture,
                             double eye_radii) {
  const optics::Optic& optic = scene.optics[index];
  const OpticPlace place = place_of(optic);
  const glm::dvec3 other = std::abs(place.ahead.z) < 0.8 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(other, place.ahead)), y = glm::cross(place.ahead, x);
  const glm::dmat3 axes(x, y, place.ahead);
  cad_import::TriangleMesh room = room_of_near_objects(texture);
  for (glm::vec3& p : room.positions) p = glm::vec3(place.center + place.radius_mm * (axes * glm::dvec3(p)));
  for (glm::vec3& n : room.normals) n = glm::vec3(axes * glm::dvec3(n));
  scene.surroundings.assign(1, std::move(room));
  const double turn = glm::radians(25.0), away = eye_radii * place.radius_mm;
  const bool lens = optic.kind == optics::OpticKind::lens;
  const glm::dvec3 towards_eye = lens ? -place.ahead : std::cos(turn) * place.ahead + std::sin(turn) * x;
  scene.camera.eye_mm = place.center + away * towards_eye;
  scene.camera.target_mm = place.center;
  scene.camera.up = y;
  scene.camera.fov_rad = 2 * std::atan(1.1 / eye_radii);
  scene.lights.clear();
  scene.environment.ambient = 1;  // colours are those of the texture
}

}  // namespace catoptra::test
