// The mesh while it is being made: plain lists, before connectivity is built.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace catoptra::tessellate {

struct DraftVertex {
  glm::dvec3 position_mm;
  int face = 0;  ///< the face whose surface it was evaluated on
  glm::dvec2 uv;
};

struct DraftTriangle {
  std::array<int, 3> vertices;
  int face = 0;
  std::array<glm::dvec2, 3> uv;
};

/// A mesh edge that lies on the curve of a CAD edge.
struct DraftBorder {
  int from = 0, to = 0;  ///< vertices
  int cad_edge = -1;
  double t_from = 0, t_to = 0;
};

struct MeshDraft {
  std::vector<DraftVertex> vertices;
  std::vector<DraftTriangle> triangles;
  std::vector<DraftBorder> borders;

  int add(const DraftVertex& vertex) {
    vertices.push_back(vertex);
    return static_cast<int>(vertices.size()) - 1;
  }
};

}  // namespace catoptra::tessellate
