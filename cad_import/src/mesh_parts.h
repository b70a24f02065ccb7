// The steps between a mesh file and a TriangleMesh, shared by the mesh_*.cpp files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cad_import/import.h"

struct aiMaterial;
struct aiScene;

namespace catoptra::cad_import {

/// Throws ImportError where a PLY file's header has no end or promises more than the file can hold.
void check_ply_header(const std::filesystem::path& file);

/// Corner numbers of the size - 2 triangles of a polygon with three corners or more, concave or not, in its
/// own sense. A polygon that crosses itself becomes a fan where no ear is left.
[[nodiscard]] std::vector<glm::uvec3> cut_polygon(std::span<const glm::dvec3> polygon);

/// One corner of one triangle. `normal` is zero where the file gives none.
struct MeshCorner {
  glm::vec3 position{0};  // mm
  glm::vec3 normal{0};
  glm::vec2 texture_coordinate{0};
};

/// Triangles before corners are shared: three corners each.
struct TriangleSoup {
  std::vector<MeshCorner> corners;
  std::vector<std::uint32_t> material;  // one per triangle
};

/// Adds to `mesh` what is usable of `soup`: triangles with a non-finite or with three collinear corners are
/// left out (told in mesh.warnings), missing normals are made smooth across edges of less than 60 degrees,
/// equal corners become one vertex. Sets positions, normals, texture coordinates, triangles,
/// triangle_material and bounds.
void weld(TriangleSoup soup, TriangleMesh& mesh);

/// KHR_texture_transform: offset + rotation * scale * (s, t), with t down.
struct TextureTransform {
  glm::vec2 offset{0}, scale{1};
  float rotation_rad = 0;
};

/// How the corners of a mesh with some material find their place in its texture.
struct TextureUse {
  unsigned channel = 0;
  TextureTransform transform;
};

struct MaterialSet {
  std::vector<Material> materials;
  std::vector<TextureUse> uses;  // one per material
  std::vector<Texture> textures;
  std::vector<std::string> warnings;
};

/// The scene's materials in their own order, with the textures they name. `color` is for the stand-in
/// material that assimp makes where the file has none. Textures that cannot be found become warnings.
[[nodiscard]] MaterialSet read_materials(const aiScene& scene, const std::filesystem::path& file,
                                         FileFormat format, glm::vec3 color);

/// The file that `reference` in `mesh_file` means: as written, then with "%20" and backslashes decoded, then
/// by its bare name beside the mesh. Nullopt where there is none.
[[nodiscard]] std::optional<std::filesystem::path> find_beside(const std::filesystem::path& mesh_file,
                                                               const std::string& reference);

/// The scene's triangles, every instance placed, in mm. Points and lines are counted in the warnings.
struct SceneTriangles {
  TriangleSoup soup;
  std::vector<std::string> warnings;
};
[[nodiscard]] SceneTriangles flatten_scene(const aiScene& scene, const std::vector<TextureUse>& uses,
                                           const glm::dmat4& to_mm, const std::string& file);

}  // namespace catoptra::cad_import
