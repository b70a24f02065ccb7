// Walks assimp's node tree and collects every instance's triangles in mm.
#include <assimp/scene.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

#include "cad_import/src/mesh_parts.h"

namespace catoptra::cad_import {
namespace {

/// No honest tree is deeper, and none of our own loops may follow a cycle for ever.
constexpr int kMostLevels = 10'000;
/// 300 million corners fill 10 GB; small files with many instances can ask for more.
constexpr std::size_t kMostCorners = 300'000'000;

glm::dmat4 matrix_of(const aiMatrix4x4& m) {
  return {
      {m.a1, m.b1, m.c1, m.d1}, {m.a2, m.b2, m.c2, m.d2}, {m.a3, m.b3, m.c3, m.d3}, {m.a4, m.b4, m.c4, m.d4}};
}

glm::dvec3 vector_of(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

/// assimp turns every format's coordinates to t up; ours run down. Source: KHR_texture_transform, "Overview".
glm::vec2 texture_coordinate(const aiVector3D& value, const TextureTransform& transform) {
  const glm::vec2 st = transform.scale * glm::vec2(value.x, 1 - value.y);
  const float c = std::cos(transform.rotation_rad), s = std::sin(transform.rotation_rad);
  return transform.offset + glm::vec2(c * st.x + s * st.y, c * st.y - s * st.x);
}

struct Totals {
  std::size_t points = 0, lines = 0, bad_faces = 0;
  bool vertex_colors = false;
};

class SceneFlattener {
 public:
  SceneFlattener(const aiScene& scene, const std::vector<TextureUse>& uses, std::string file)
      : scene_(scene), uses_(uses), file_(std::move(file)) {}

  SceneTriangles run(const glm::dmat4& to_mm) {
    struct Visit {
      const aiNode* node;
      glm::dmat4 placement;
      int level;
    };
    std::vector<Visit> pending;
    if (scene_.mRootNode) pending.push_back({scene_.mRootNode, to_mm, 0});
    while (!pending.empty()) {
      const Visit visit = pending.back();
      pending.pop_back();
      if (visit.level > kMostLevels)
        throw ImportError(file_, visit.node->mName.C_Str(), "nodes are nested too deep");
      const glm::dmat4 placement = visit.placement * matrix_of(visit.node->mTransformation);
      for (unsigned i = 0; i < visit.node->mNumMeshes; ++i)
        if (visit.node->mMeshes[i] < scene_.mNumMeshes)
          add_mesh(*scene_.mMeshes[visit.node->mMeshes[i]], placement);
      for (unsigned i = visit.node->mNumChildren; i > 0; --i)  // backwards: the stack turns them round
        if (visit.node->mChildren[i - 1])
          pending.push_back({visit.node->mChildren[i - 1], placement, visit.level + 1});
    }
    return {std::move(soup_), warnings()};
  }

 private:
  void add_mesh(const aiMesh& mesh, const glm::dmat4& placement) {
    totals_.vertex_colors = totals_.vertex_colors || mesh.HasVertexColors(0);
    if (!mesh.mVertices) return;
    const glm::dmat3 linear(placement);
    const bool mirrored = glm::determinant(linear) < 0;
    const glm::dmat3 normal_matrix = glm::inverseTranspose(linear);
    const unsigned material = mesh.mMaterialIndex < uses_.size() ? mesh.mMaterialIndex : 0;
    const TextureUse& use = uses_[material];
    const bool textured = use.channel < AI_MAX_NUMBER_OF_TEXTURECOORDS && mesh.mTextureCoords[use.channel];
    const auto corner = [&](unsigned index) {
      MeshCorner result;
      result.position = glm::dvec3(placement * glm::dvec4(vector_of(mesh.mVertices[index]), 1));
      if (mesh.mNormals) {
        const glm::dvec3 normal = normal_matrix * vector_of(mesh.mNormals[index]);
        const double length = glm::length(normal);
        if (std::isfinite(length) && length > 0) result.normal = normal / length;
      }
      if (textured)
        result.texture_coordinate =
            texture_coordinate(mesh.mTextureCoords[use.channel][index], use.transform);
      return result;
    };
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (!is_polygon(face, mesh.mNumVertices)) continue;
      std::vector<glm::dvec3> outline(face.mNumIndices);
      for (unsigned k = 0; k < face.mNumIndices; ++k)
        outline[k] = vector_of(mesh.mVertices[face.mIndices[k]]);
      for (const glm::uvec3& t : cut_polygon(outline)) {
        soup_.corners.push_back(corner(face.mIndices[t.x]));
        soup_.corners.push_back(corner(face.mIndices[mirrored ? t.z : t.y]));
        soup_.corners.push_back(corner(face.mIndices[mirrored ? t.y : t.z]));
        soup_.material.push_back(material);
      }
      if (soup_.corners.size() > kMostCorners)
        throw ImportError(file_, "", "holds more than 100 million triangles", "split the file");
    }
  }

  bool is_polygon(const aiFace& face, unsigned vertices) {
    totals_.points += face.mNumIndices == 1;
    totals_.lines += face.mNumIndices == 2;
    if (face.mNumIndices == 1 || face.mNumIndices == 2) return false;
    bool good = face.mNumIndices >= 3;
    for (unsigned k = 0; good && k < face.mNumIndices; ++k) good = face.mIndices[k] < vertices;
    totals_.bad_faces += !good;
    return good;
  }

  std::vector<std::string> warnings() const {
    std::vector<std::string> result;
    if (totals_.points > 0) result.push_back(std::to_string(totals_.points) + " point(s) were left out");
    if (totals_.lines > 0) result.push_back(std::to_string(totals_.lines) + " line(s) were left out");
    if (totals_.bad_faces > 0)
      result.push_back(std::to_string(totals_.bad_faces) + " face(s) with impossible indices were left out");
    if (totals_.vertex_colors) result.emplace_back("vertex colours are not used");
    return result;
  }

  const aiScene& scene_;
  const std::vector<TextureUse>& uses_;
  std::string file_;
  TriangleSoup soup_;
  Totals totals_;
};

}  // namespace

SceneTriangles flatten_scene(const aiScene& scene, const std::vector<TextureUse>& uses,
                             const glm::dmat4& to_mm, const std::string& file) {
  return SceneFlattener(scene, uses, file).run(to_mm);
}

}  // namespace catoptra::cad_import
