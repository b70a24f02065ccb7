// An optic's mesh as flat arrays: what rays, maps and the GPU read.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace catoptra::tessellate {

/// A vertex on the exact surface. Where faces meet at a crease, one entry per distinct normal (same
/// `position_mm`).
struct OpticVertex {
  glm::dvec3 position_mm;
  glm::dvec3 normal;      ///< exact unit normal, out of the material
  double k1 = 0, k2 = 0;  ///< principal curvatures, 1/mm, convex towards the normal positive; k1 >= k2
  glm::dvec3 direction1;  ///< unit direction of k1
  int face = 0;           ///< index in the optic's list of faces
  glm::dvec2 uv;          ///< parameters on that face's surface
};

/// Counter-clockwise as seen from the side the normals point to.
struct OpticTriangle {
  std::array<std::uint32_t, 3> vertices;  ///< indices in OpticArrays::vertices
  int face = 0;                           ///< the face that the triangle lies on
  std::array<glm::dvec2, 3> uv;  ///< each corner's parameters on that face (a border vertex has one per face)
};

/// A triangle's side that lies on an edge of the CAD model: where its ends are on that edge's curve.
struct OpticBorder {
  std::uint32_t triangle = 0;  ///< index in OpticArrays::triangles
  std::uint8_t side = 0;       ///< from corner `side` to the next
  int cad_edge = 0;            ///< EdgeUse::edge
  double t_from = 0, t_to = 0;
};

struct OpticArrays {
  std::vector<OpticVertex> vertices;
  std::vector<OpticTriangle> triangles;
  std::vector<OpticBorder> borders;  ///< in the order of their triangles; refinement reads them, may be empty
};

}  // namespace catoptra::tessellate
