#include "tessellate/optic_mesh.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "tessellate/src/exact_vertex.h"
#include "tessellate/src/mesh_draft.h"

namespace catoptra::tessellate {
namespace {

using cad_import::Face;
using Mesh = HalfEdgeMesh;

OpenMesh::Vec3d to_openmesh(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

/// Adds the draft's triangles one by one. Where a triangle would make an edge or a vertex non-manifold (faces
/// that touch in an edge of three, or whose orientations disagree), its face gets vertices of its own there.
class Builder {
 public:
  Builder(const MeshDraft& draft, const std::vector<Face>& faces, Mesh& mesh)
      : draft_(draft), faces_(faces), mesh_(mesh), handle_(draft.vertices.size()) {}

  void run() {
    mesh_.reserve(draft_.vertices.size(), draft_.vertices.size() + draft_.triangles.size(),
                  draft_.triangles.size());
    for (const auto& triangle : draft_.triangles) add(triangle);
    for (const auto& border : draft_.borders) mark(border);
  }

 private:
  Mesh::VertexHandle add_vertex(int vertex) {
    const auto& v = draft_.vertices[static_cast<std::size_t>(vertex)];
    const auto handle = mesh_.add_vertex(to_openmesh(v.position_mm));
    mesh_.data(handle).exact =
        exact_vertex(faces_[static_cast<std::size_t>(v.face)], v.face, v.uv, v.position_mm);
    return handle;
  }

  Mesh::VertexHandle shared(int vertex) {
    auto& handle = handle_[static_cast<std::size_t>(vertex)];
    if (!handle.is_valid()) handle = add_vertex(vertex);
    return handle;
  }

  Mesh::VertexHandle own(int vertex, int face) {
    auto [place, is_new] = own_.try_emplace({vertex, face});
    if (is_new) place->second = add_vertex(vertex);
    return place->second;
  }

  bool fits(const std::array<Mesh::VertexHandle, 3>& v) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!mesh_.is_boundary(v[k])) return false;
      const auto half_edge = mesh_.find_halfedge(v[k], v[(k + 1) % 3]);
      if (half_edge.is_valid() && !mesh_.is_boundary(half_edge)) return false;
    }
    return true;
  }

  void add(const DraftTriangle& triangle) {
    std::array<Mesh::VertexHandle, 3> v;
    for (std::size_t k = 0; k < 3; ++k) v[k] = shared(triangle.vertices[k]);
    if (!fits(v))
      for (std::size_t k = 0; k < 3; ++k) v[k] = own(triangle.vertices[k], triangle.face);
    if (!fits(v))
      for (std::size_t k = 0; k < 3; ++k) v[k] = add_vertex(triangle.vertices[k]);
    const auto face = mesh_.add_face(v[0], v[1], v[2]);
    mesh_.data(face).face = triangle.face;
    auto half_edge = mesh_.halfedge_handle(face);
    for (int k = 0; k < 3; ++k, half_edge = mesh_.next_halfedge_handle(half_edge)) {
      const auto to = mesh_.to_vertex_handle(half_edge);
      for (std::size_t c = 0; c < 3; ++c)
        if (v[c] == to) mesh_.data(half_edge).uv = triangle.uv[c];
    }
  }

  void mark(const DraftBorder& border) {
    const auto mark_between = [&](Mesh::VertexHandle from, Mesh::VertexHandle to) {
      if (!from.is_valid() || !to.is_valid()) return;
      const auto half_edge = mesh_.find_halfedge(from, to);
      if (!half_edge.is_valid()) return;
      const auto edge = mesh_.edge_handle(half_edge);
      const bool along = mesh_.halfedge_handle(edge, 0) == half_edge;
      auto& data = mesh_.data(edge);
      data.cad_edge = border.cad_edge;
      data.t_from = along ? border.t_from : border.t_to;
      data.t_to = along ? border.t_to : border.t_from;
    };
    mark_between(handle_[static_cast<std::size_t>(border.from)],
                 handle_[static_cast<std::size_t>(border.to)]);
    if (own_.empty()) return;
    for (auto it = own_.lower_bound({border.from, -1}); it != own_.end() && it->first.first == border.from;
         ++it) {
      const auto other = own_.find({border.to, it->first.second});
      if (other != own_.end()) mark_between(it->second, other->second);
    }
  }

  const MeshDraft& draft_;
  const std::vector<Face>& faces_;
  Mesh& mesh_;
  std::vector<Mesh::VertexHandle> handle_;
  std::map<std::pair<int, int>, Mesh::VertexHandle> own_;  ///< (draft vertex, face)
};

}  // namespace

OpticMesh::OpticMesh(const MeshDraft& draft, std::vector<Face> faces) : faces_(std::move(faces)) {
  Builder(draft, faces_, mesh_).run();
}

}  // namespace catoptra::tessellate
