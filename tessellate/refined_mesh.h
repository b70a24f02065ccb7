// A mesh whose edges are split where somebody asks for it: conformingly, on the exact surface, and undone at
// no cost.
//
// Every refinement starts from the base mesh, so that it depends on nothing but the answers given: edges that
// are not split again are coarsened by that. What has been evaluated on the exact surfaces is kept.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "cad_import/cad_model.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::tessellate {

/// An edge that may be split, as one smooth piece of the surface sees it: at a crease there are two, of the
/// same group.
struct EdgeMiddle {
  std::array<std::uint32_t, 2> ends;  ///< indices in RefinedMesh::mesh().vertices
  std::uint32_t node = 0;   ///< number of the middle, the same in all refinements of this RefinedMesh
  std::uint32_t group = 0;  ///< edges of one group, which follow each other, are split together or not at all
};

/// Invariants, which the tests check: the vertices of the base mesh come first and unchanged; every new
/// vertex lies on the exact surface, on CAD edges on the edge's curve; triangles sharing an edge share its
/// middle (no crack, no hanging vertex); the same answers give the same mesh, whatever was asked before.
class RefinedMesh {
 public:
  /// Copies both. OpticVertex::face indexes `faces`.
  RefinedMesh(std::span<const cad_import::Face> faces, const OpticArrays& base);

  /// Back to the base mesh.
  void restart();

  /// The edges that came with the last split() (or with restart(): all), in an order that depends on the mesh
  /// alone.
  [[nodiscard]] std::span<const EdgeMiddle> new_edges() const { return new_edges_; }
  /// The vertex that would be at the middle.
  [[nodiscard]] const OpticVertex& middle(const EdgeMiddle& edge) const { return nodes_[edge.node]; }
  /// So many nodes there are: EdgeMiddle::node is below.
  [[nodiscard]] std::size_t node_count() const { return nodes_.size(); }

  /// Splits those of new_edges() for whose group any entry of `wanted` (one per edge) is not zero. Edges left
  /// whole stay so until restart().
  void split(std::span<const char> wanted);

  /// Without OpticArrays::borders.
  [[nodiscard]] const OpticArrays& mesh() const { return mesh_; }
  /// Of every vertex that is not of the base mesh, in order: the ends of the edge whose middle it is, both
  /// with smaller indices.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 2>> parents() const { return parents_; }
  /// Of every vertex, EdgeMiddle::node; below the base's vertex count for its own.
  [[nodiscard]] std::span<const std::uint32_t> nodes() const { return node_of_; }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  struct Curve {
    int cad_edge = -1;
    double t_from = 0, t_to = 0;
  };
  struct Triangle {
    OpticTriangle shape;
    std::array<Curve, 3> curves;  ///< of the sides, `side` running from corner `side` to the next
    std::array<bool, 3> open{true, true, true};  ///< sides that have come with the last split
  };
  struct Side {
    std::array<std::uint32_t, 2> welded, ends;  ///< each sorted; welded: creases closed
    int face;
    glm::dvec2 uv;  ///< of the middle, on the triangle's face
    std::uint32_t triangle;
    std::uint8_t side;
  };
  struct Middle {
    std::uint32_t vertex;
    glm::dvec2 uv;
  };

  void find_new_edges();
  [[nodiscard]] Side make_side(std::uint32_t triangle, std::uint8_t side) const;
  void add_group(std::span<Side> sides);
  [[nodiscard]] std::uint32_t node_between(const Side& side, std::uint32_t first_of_group);
  void add_vertices(std::span<const char> wanted, std::vector<std::uint32_t>& vertex_of_edge);
  void cut(const Triangle& triangle, const std::array<Middle, 3>& middles, std::vector<Triangle>& into) const;
  void publish_triangles();

  std::vector<cad_import::Face> faces_;
  OpticArrays base_;
  std::vector<std::uint32_t> base_welded_;
  std::vector<OpticVertex> nodes_;                         ///< evaluated once, kept
  std::unordered_map<std::uint64_t, std::uint32_t> node_;  ///< by the nodes of the ends

  OpticArrays mesh_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> welded_, node_of_;
  std::vector<std::array<std::uint32_t, 2>> parents_;
  std::vector<EdgeMiddle> new_edges_;
  std::vector<Side> new_sides_;         ///< those of new_edges_
  std::vector<std::uint32_t> edge_of_;  ///< per new side, its place in new_edges_
};

}  // namespace catoptra::tessellate
