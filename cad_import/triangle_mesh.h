// Triangles with materials and textures: the surroundings of the optics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "cad_import/cad_model.h"

namespace catoptra::cad_import {

/// An image that a material refers to, still encoded (PNG, JPEG, ...): `render` decodes it.
struct Texture {
  std::string name;                ///< file name or name inside the container, for messages
  std::string path;                ///< absolute path of the image file; empty where `encoded` holds it
  std::vector<std::byte> encoded;  ///< the encoded image where it was embedded
};

/// How a texture continues outside [0, 1].
enum class TextureWrap { repeat, clamp, mirror };

struct Material {
  std::string name;
  glm::vec3 base_color{0.8f};  ///< linear RGB, multiplies the texture
  glm::vec3 emissive{0};       ///< linear RGB radiance, added
  float alpha = 1;             ///< multiplies the texture's alpha; see alpha_cutoff
  float alpha_cutoff = 0;      ///< a point with alpha below it is not there; 0: always there
  int texture = -1;            ///< index in TriangleMesh::textures; -1: none
  TextureWrap wrap = TextureWrap::repeat;
};

/// Indexed triangles in mm, counter-clockwise as seen from outside.
struct TriangleMesh {
  std::string file;
  std::string format;                           ///< "glTF", "OBJ", "STL", "PLY", "STEP", ...
  std::vector<glm::vec3> positions;             ///< mm, one per vertex
  std::vector<glm::vec3> normals;               ///< unit, one per vertex
  std::vector<glm::vec2> texture_coordinates;   ///< one per vertex; (0, 0) is the image's top left, t runs down
  std::vector<glm::uvec3> triangles;            ///< vertex indices
  std::vector<std::uint32_t> triangle_material; ///< index in `materials`, one per triangle
  std::vector<Material> materials;              ///< at least one
  std::vector<Texture> textures;
  BoundingBox bounds;
  std::vector<std::string> warnings;
};

}  // namespace catoptra::cad_import
