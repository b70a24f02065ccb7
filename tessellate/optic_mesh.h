// The mesh of an optic: half edges whose vertices lie on the exact surfaces and know where.
//
// Invariants, which the tests check: every vertex lies on its face's exact surface; neighbouring faces share
// the vertices of their common edges (no crack, no duplicate); triangles run counter-clockwise seen from the
// side the normals point to. Lengths in mm, angles in radians.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cad_import/cad_model.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::tessellate {

/// What the half-edge mesh carries besides its connectivity.
struct OpticTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  VertexTraits {
    OpticVertex exact;  ///< on a border between faces: as one of them sees it
  };
  HalfedgeTraits {
    glm::dvec2 uv{0};  ///< parameters of the vertex it points to, on the surface of its triangle
  };
  EdgeTraits {
    int cad_edge = -1;            ///< EdgeUse::edge of the border it lies on; -1: inside a face
    double t_from = 0, t_to = 0;  ///< its ends on that edge's curve, along half edge 0
  };
  FaceTraits {
    int face = 0;  ///< index in OpticMesh::faces()
  };
};
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<OpticTraits>;

/// Normals of two faces at a shared vertex that differ by more than this are a crease: 1 mrad turns a
/// reflected ray by 2 mrad, 10 mm at 5 m.
inline constexpr double kCreaseAngle_rad = 1e-3;

struct MeshDraft;

class OpticMesh {
 public:
  /// Built by tessellate_optic(); `faces` are what the draft's face numbers refer to.
  OpticMesh(const MeshDraft& draft, std::vector<cad_import::Face> faces);

  [[nodiscard]] const HalfEdgeMesh& half_edges() const { return mesh_; }
  [[nodiscard]] std::span<const cad_import::Face> faces() const { return faces_; }
  [[nodiscard]] std::size_t vertex_count() const { return mesh_.n_vertices(); }
  [[nodiscard]] std::size_t triangle_count() const { return mesh_.n_faces(); }

  /// Flat arrays. A vertex is repeated only where its faces' normals differ by more than `crease_rad`.
  [[nodiscard]] OpticArrays arrays(double crease_rad = kCreaseAngle_rad) const;

  /// Every triangle cut into four; the new vertices lie on the exact surface, or on the curve of the border.
  /// Halves the mesh width h, for convergence tests.
  [[nodiscard]] OpticMesh subdivided() const;

 private:
  HalfEdgeMesh mesh_;
  std::vector<cad_import::Face> faces_;
};

/// Columns along u and rows along v, in vertices; both at least 2.
struct GridRequest {
  int columns = 7, rows = 7;
};

struct TessellationOptions {
  double chord_mm = 0.01;  ///< greatest distance of edges and triangle centres from the surface; > 0
  double angle_rad =
      0.0873;  ///< greatest turn of the normal along an edge, and of a border; > 0. Default: 5 degrees
  std::size_t min_vertices = 4;        ///< refine until there are as many
  std::size_t max_vertices = 1000000;  ///< coarsen (with a warning) rather than exceed it

  /// About so many vertices over all faces, evenly spaced, in place of chord and angle. A single rectangular
  /// face gets a grid of exactly so many where cells stay nearly square: 49 is the paper's 7 x 7.
  std::optional<std::size_t> target_vertices;
  /// This grid on every face, in place of chord and angle. Exact on faces that are rectangles in (u, v); on
  /// others the grid over the bounding rectangle, cut by the border.
  std::optional<GridRequest> grid;
};

/// A face that has no triangles in the mesh.
struct UnmeshedFace {
  int index = 0;       ///< in the span given
  std::string id;      ///< Face::id
  std::string reason;  ///< one line
};

struct OpticMeshResult {
  OpticMesh mesh;
  std::vector<UnmeshedFace> unmeshed;
  std::vector<std::string> warnings;
};

/// Meshes the faces of one optic. OpticVertex::face is the position in `faces`.
/// Throws catoptra::Error where no face could be meshed, or an option is out of range.
[[nodiscard]] OpticMeshResult tessellate_optic(std::span<const cad_import::Face> faces,
                                               const TessellationOptions& options = {});

}  // namespace catoptra::tessellate
