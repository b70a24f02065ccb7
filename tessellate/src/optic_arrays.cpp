// From half edges to flat arrays: one entry per vertex and distinct normal.
#include "tessellate/optic_arrays.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "tessellate/optic_mesh.h"
#include "tessellate/src/exact_vertex.h"

namespace catoptra::tessellate {
namespace {

using Mesh = HalfEdgeMesh;

/// A border vertex as one face sees it, and the entry that stands for it.
struct Corner {
  int face;
  glm::dvec2 uv;
  std::uint32_t entry;
};

class Flattener {
 public:
  Flattener(const OpticMesh& optic, double crease_rad)
      : optic_(optic), mesh_(optic.half_edges()), cos_crease_(std::cos(crease_rad)) {}

  OpticArrays run() {
    corners_of_.assign(mesh_.n_vertices(), kInside);
    for (const auto edge : mesh_.edges()) {
      if (mesh_.data(edge).cad_edge < 0) continue;
      for (const unsigned side : {0u, 1u}) {
        int& list = corners_of_[static_cast<std::size_t>(
            mesh_.to_vertex_handle(mesh_.halfedge_handle(edge, side)).idx())];
        if (list != kInside) continue;
        list = static_cast<int>(corners_.size());
        corners_.emplace_back();
      }
    }
    entry_of_.assign(mesh_.n_vertices(), 0);
    for (const auto vertex : mesh_.vertices()) {
      entry_of_[static_cast<std::size_t>(vertex.idx())] = static_cast<std::uint32_t>(arrays_.vertices.size());
      if (corners_of_[static_cast<std::size_t>(vertex.idx())] == kInside)
        arrays_.vertices.push_back(mesh_.data(vertex).exact);
    }
    arrays_.triangles.reserve(mesh_.n_faces());
    for (const auto face : mesh_.faces()) add(face);
    return std::move(arrays_);
  }

 private:
  static constexpr int kInside = -1;

  void add(Mesh::FaceHandle face) {
    OpticTriangle triangle{};
    triangle.face = mesh_.data(face).face;
    auto half_edge = mesh_.halfedge_handle(face);
    for (std::size_t k = 0; k < 3; ++k, half_edge = mesh_.next_halfedge_handle(half_edge)) {
      triangle.uv[k] = mesh_.data(half_edge).uv;
      triangle.vertices[k] = entry(mesh_.to_vertex_handle(half_edge), triangle.face, triangle.uv[k]);
      const auto edge = mesh_.edge_handle(half_edge);
      const auto& data = mesh_.data(edge);
      if (data.cad_edge < 0) continue;
      const bool along = mesh_.halfedge_handle(edge, 0) == half_edge;
      arrays_.borders.push_back({static_cast<std::uint32_t>(arrays_.triangles.size()),
                                 static_cast<std::uint8_t>((k + 2) % 3), data.cad_edge,
                                 along ? data.t_from : data.t_to, along ? data.t_to : data.t_from});
    }
    arrays_.triangles.push_back(triangle);
  }

  std::uint32_t entry(Mesh::VertexHandle vertex, int face, const glm::dvec2& uv) {
    const int list = corners_of_[static_cast<std::size_t>(vertex.idx())];
    if (list == kInside) return entry_of_[static_cast<std::size_t>(vertex.idx())];
    auto& corners = corners_[static_cast<std::size_t>(list)];
    for (const auto& c : corners)
      if (c.face == face && c.uv == uv) return c.entry;
    const OpticVertex candidate = exact_vertex(optic_.faces()[static_cast<std::size_t>(face)], face, uv,
                                               mesh_.data(vertex).exact.position_mm);
    for (const auto& c : corners)
      if (glm::dot(arrays_.vertices[c.entry].normal, candidate.normal) >= cos_crease_) {
        corners.push_back({face, uv, c.entry});
        return corners.back().entry;
      }
    corners.push_back({face, uv, static_cast<std::uint32_t>(arrays_.vertices.size())});
    arrays_.vertices.push_back(candidate);
    return corners.back().entry;
  }

  const OpticMesh& optic_;
  const Mesh& mesh_;
  double cos_crease_;
  OpticArrays arrays_;
  std::vector<std::uint32_t> entry_of_;       ///< per vertex inside a face
  std::vector<int> corners_of_;               ///< per vertex: index in corners_, or kInside
  std::vector<std::vector<Corner>> corners_;  ///< per border vertex
};

}  // namespace

OpticArrays OpticMesh::arrays(double crease_rad) const {
  return Flattener(*this, crease_rad).run();
}

}  // namespace catoptra::tessellate
