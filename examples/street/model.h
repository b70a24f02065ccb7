// A textured triangle model under construction, in metres, z up: surfaces by material, and the palette they
// refer to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <vector>

#include "examples/street/pixmap.h"

namespace catoptra::examples {

struct Vertex {
  glm::vec3 position{0};  ///< m
  glm::vec3 normal{0};    ///< unit
  glm::vec2 texture{0};   ///< (0, 0) is the picture's top left, t runs down, 1 is one repetition
};

/// All triangles of one material, counter-clockwise as seen from outside.
struct Surface {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three per triangle
};

/// Surfaces by the material's name; the map's order makes the written file deterministic.
struct Model {
  std::map<std::string, Surface> surfaces;

  [[nodiscard]] std::size_t triangle_count() const;

  /// Adds `part` moved by `placement`, a rotation and a translation.
  void add(const Model& part, const glm::mat4& placement);
};

/// Turns by `heading_deg` about z, counter-clockwise as seen from above, then moves the origin to `origin`.
[[nodiscard]] glm::mat4 place(const glm::vec3& origin, float heading_deg = 0);

struct Paint {
  glm::vec3 color{0.8f};   ///< linear RGB; multiplies the texture
  std::string texture;     ///< name in Palette::textures; empty: none
  float alpha_cutoff = 0;  ///< texels with alpha below it are not there; 0: always there
};

struct Palette {
  std::map<std::string, Paint> paints;
  std::map<std::string, Pixmap> textures;
};

}  // namespace catoptra::examples
