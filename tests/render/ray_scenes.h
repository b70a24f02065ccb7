// Small scenes of known geometry for the ray tracer's tests and its benchmark.
#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "render/src/ray_tracer.h"
#include "render/src/shading.h"
#include "tests/support/analytic_optic.h"
#include "tests/support/temporary_image.h"

namespace catoptra::test {

/// A scene with what is needed to trace it. Not movable: the parts refer to each other.
class TracedScene {
 public:
  explicit TracedScene(render::Scene content)
      : scene(std::move(content)), textures(render::load_textures(scene)) {
    for (std::size_t m = 0; m < scene.surroundings.size(); ++m)
      rays.add_surroundings(scene.surroundings[m],
                            render::make_alpha_test(scene.surroundings[m], textures.textures[m]));
    for (const optics::Optic& optic : scene.optics)
      rays.add_optic(render::mesh_for_rays(optic), render::mask_for_rays(optic));
    rays.commit();
    tracer = std::make_unique<render::RayTracer>(scene, textures, rays);
  }
  TracedScene(const TracedScene&) = delete;
  TracedScene& operator=(const TracedScene&) = delete;

  render::Frame render(int width, int height, int samples = 1, std::size_t threads = 0) const {
    render::FrameOptions options;
    options.width = width;
    options.height = height;
    options.samples = samples;
    options.geometry = true;
    options.threads = threads;
    return tracer->render(scene.camera, options).frame;
  }

  render::Scene scene;
  render::SceneTextures textures;
  optics::RayScene rays;
  std::unique_ptr<render::RayTracer> tracer;
};

/// An empty mesh with one white, untextured material.
inline cad_import::TriangleMesh empty_mesh() {
  cad_import::TriangleMesh mesh;
  mesh.materials.emplace_back().base_color = glm::vec3(1);
  return mesh;
}

/// Adds the parallelogram corner, corner + a, corner + a + b, corner + b, facing a x b. Texture coordinates
/// run from (0, 0) at `corner` to (repeats, repeats) at the far one.
inline void add_quad(cad_import::TriangleMesh& mesh, glm::vec3 corner, glm::vec3 a, glm::vec3 b,
                     std::uint32_t material = 0, float repeats = 1) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (const auto& [s, t] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}}) {
    mesh.positions.push_back(corner + s * a + t * b);
    mesh.normals.push_back(glm::normalize(glm::cross(a, b)));
    mesh.texture_coordinates.emplace_back(repeats * s, repeats * t);
  }
  for (const glm::uvec3 t : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
    mesh.triangles.push_back(first + t);
    mesh.triangle_material.push_back(material);
  }
}

/// Adds an axis-aligned box.
inline void add_box(cad_import::TriangleMesh& mesh, glm::vec3 low, glm::vec3 size,
                    std::uint32_t material = 0) {
  const glm::vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  add_quad(mesh, low, y, x, material);
  add_quad(mesh, low + z, x, y, material);
  add_quad(mesh, low, x, z, material);
  add_quad(mesh, low + y, z, x, material);
  add_quad(mesh, low, z, y, material);
  add_quad(mesh, low + x, y, z, material);
}

/// `size` x `size` pixels by `color(column, row)`.
template <typename Color>
render::Frame painted(int size, const Color& color) {
  render::Frame frame;
  frame.width = frame.height = size;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) frame.color.emplace_back(glm::vec3(color(column, row)), 1);
  return frame;
}

/// Squares of `cell` pixels, orange and blue, the first row of them green: left, right, up and down can be
/// told apart.
inline render::Frame checker(int size, int cell) {
  return painted(size, [=](int column, int row) {
    const bool odd = (column / cell + row / cell) % 2 != 0;
    if (row < cell) return odd ? glm::vec3(0.1f, 0.7f, 0.1f) : glm::vec3(0.9f);
    return odd ? glm::vec3(0.9f, 0.4f, 0.05f) : glm::vec3(0.05f, 0.1f, 0.5f);
  });
}

/// Ground with `rows` x `rows` boxes behind the eye (y < 0) and around the mirror: 12 triangles a box and 4
/// for ground and back wall, all textured with `texture`.
inline cad_import::TriangleMesh street(int rows, const std::filesystem::path& texture) {
  cad_import::TriangleMesh mesh = empty_mesh();
  mesh.textures.push_back({"checker", texture.string(), {}});
  mesh.materials[0].texture = 0;
  add_quad(mesh, {-40000, -60000, -1200}, {80000, 0, 0}, {0, 90000, 0}, 0, 40);
  add_quad(mesh, {40000, -60000, -1200}, {-80000, 0, 0}, {0, 0, 12000}, 0, 16);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < rows; ++i) {
      const float x = 2400.f * (float(i) - 0.5f * float(rows - 1)),
                  y = -50000 + 75000 * float(j) / float(rows);
      if (std::abs(x) < 1800 && y > -4000) continue;
      const float height = 600 + 400 * float((i * 7 + j * 5) % 8);
      add_box(mesh, {x, y, -1200}, {900, 900, height});
    }
  return mesh;
}

}  // namespace catoptra::test
