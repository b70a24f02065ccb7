// Uniform refinement on the exact surface.
#include <cmath>
#include <glm/geometric.hpp>

#include "tessellate/optic_mesh.h"
#include "tessellate/src/edge_use.h"
#include "tessellate/src/mesh_draft.h"

namespace catoptra::tessellate {
namespace {

using cad_import::EdgeUse;
using cad_import::Face;
using Mesh = HalfEdgeMesh;

std::size_t index(OpenMesh::BaseHandle handle) {
  return static_cast<std::size_t>(handle.idx());
}

class Subdivider {
 public:
  explicit Subdivider(const OpticMesh& optic) : optic_(optic), mesh_(optic.half_edges()) {}

  MeshDraft run() {
    for (const auto vertex : mesh_.vertices()) {
      const auto& v = mesh_.data(vertex).exact;
      draft_.add({v.position_mm, v.face, v.uv});
    }
    middle_uv_.resize(mesh_.n_halfedges());
    for (const auto edge : mesh_.edges()) split(edge);
    for (const auto face : mesh_.faces()) add_quarters(face);
    return std::move(draft_);
  }

 private:
  int middle(Mesh::EdgeHandle edge) const { return static_cast<int>(mesh_.n_vertices() + index(edge)); }

  /// Parameters of the half edge's middle on the surface of its triangle.
  glm::dvec2 middle_uv(Mesh::EdgeHandle edge, Mesh::HalfedgeHandle half_edge) const {
    const auto& data = mesh_.data(edge);
    const glm::dvec2 from = mesh_.data(mesh_.prev_halfedge_handle(half_edge)).uv,
                     to = mesh_.data(half_edge).uv;
    const glm::dvec2 straight = 0.5 * (from + to);
    if (data.cad_edge < 0) return straight;
    const bool along = mesh_.halfedge_handle(edge, 0) == half_edge;
    const double t = 0.5 * (data.t_from + data.t_to);
    const Face& face =
        optic_.faces()[static_cast<std::size_t>(mesh_.data(mesh_.face_handle(half_edge)).face)];
    const EdgeUse* use = find_use(face, data.cad_edge, along ? data.t_to : data.t_from, to);
    return use ? use->curve->uv(t) : straight;
  }

  void split(Mesh::EdgeHandle edge) {
    const auto& data = mesh_.data(edge);
    bool placed = false;
    for (const unsigned side : {0u, 1u}) {
      const auto half_edge = mesh_.halfedge_handle(edge, side);
      if (mesh_.is_boundary(half_edge)) continue;
      const int face = mesh_.data(mesh_.face_handle(half_edge)).face;
      // Inside a face both triangles must take the same parameters, also where their corners at a pole
      // differ.
      const bool inside = data.cad_edge < 0 && placed;
      const glm::dvec2 uv = inside ? draft_.vertices.back().uv : middle_uv(edge, half_edge);
      middle_uv_[index(half_edge)] = uv;
      if (!placed)
        draft_.add({optic_.faces()[static_cast<std::size_t>(face)].surface->point(uv.x, uv.y), face, uv});
      placed = true;
    }
    if (data.cad_edge < 0) return;
    const auto half_edge = mesh_.halfedge_handle(edge, 0);
    const auto from = static_cast<int>(index(mesh_.from_vertex_handle(half_edge)));
    const auto to = static_cast<int>(index(mesh_.to_vertex_handle(half_edge)));
    const double t = 0.5 * (data.t_from + data.t_to);
    draft_.borders.push_back({from, middle(edge), data.cad_edge, data.t_from, t});
    draft_.borders.push_back({middle(edge), to, data.cad_edge, t, data.t_to});
  }

  void add_quarters(Mesh::FaceHandle face) {
    std::array<int, 3> corner{}, mid{};
    std::array<glm::dvec2, 3> corner_uv{}, mid_uv{};
    auto half_edge = mesh_.halfedge_handle(face);
    for (std::size_t k = 0; k < 3; ++k, half_edge = mesh_.next_halfedge_handle(half_edge)) {
      // Half edge k runs from corner k - 1 to corner k.
      corner[k] = static_cast<int>(index(mesh_.to_vertex_handle(half_edge)));
      corner_uv[k] = mesh_.data(half_edge).uv;
      mid[k] = middle(mesh_.edge_handle(half_edge));
      mid_uv[k] = middle_uv_[index(half_edge)];
    }
    const int f = mesh_.data(face).face;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      draft_.triangles.push_back(
          {{mid[k], corner[k], mid[next]}, f, {mid_uv[k], corner_uv[k], mid_uv[next]}});
    }
    draft_.triangles.push_back({mid, f, mid_uv});
  }

  const OpticMesh& optic_;
  const Mesh& mesh_;
  MeshDraft draft_;
  std::vector<glm::dvec2> middle_uv_;  ///< per half edge
};

}  // namespace

OpticMesh OpticMesh::subdivided() const {
  return {Subdivider(*this).run(), faces_};
}

}  // namespace catoptra::tessellate
