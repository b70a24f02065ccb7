// The borders of the faces: every CAD edge cut once, for all faces that use it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cad_import/cad_model.h"
#include "tessellate/src/mesh_draft.h"
#include "tessellate/src/sizing.h"

namespace catoptra::tessellate {

/// The faces with what later steps rely on: a face without loops gets those of its parameter rectangle (seams
/// and poles recognised), and edges and vertices without a number get one of their own.
[[nodiscard]] std::vector<cad_import::Face> with_complete_loops(std::span<const cad_import::Face> faces);

/// A point of a loop: the mesh vertex, and its parameters as this use of the edge sees it.
struct LoopPoint {
  int vertex = 0;
  glm::dvec2 uv;
};

/// A CAD edge and the parameters at which it is cut.
struct EdgeCut {
  int edge = -1;
  int start_vertex = -1, end_vertex = -1;  ///< topological, in the direction of rising t
  double t_begin = 0, t_end = 1;
  bool degenerate = false;
  struct Use {
    int face = 0;
    const cad_import::EdgeUse* use = nullptr;
  };
  std::vector<Use> uses;
  std::vector<double> t;      ///< rising, from t_begin to t_end
  std::vector<int> vertices;  ///< mesh vertices at `t`; filled by Borders::add_vertices
};

/// All edges of the optic.
class Borders {
 public:
  /// `faces` must outlive this object, and come from with_complete_loops().
  explicit Borders(std::span<const cad_import::Face> faces);

  [[nodiscard]] std::vector<EdgeCut>& cuts() { return cuts_; }
  [[nodiscard]] const std::vector<EdgeCut>& cuts() const { return cuts_; }
  [[nodiscard]] const EdgeCut& cut_of(const cad_import::EdgeUse& use) const {
    return cuts_[index_of(use.edge)];
  }
  [[nodiscard]] std::size_t index_of(int edge) const;

  /// Puts a vertex at every cut, on the exact surface of the first face that uses the edge, and lists the
  /// pieces of the edges as borders. Edges that meet at a topological vertex share it.
  void add_vertices(MeshDraft& draft);

  /// The points of one use, in the direction of the loop, both ends included.
  [[nodiscard]] std::vector<LoopPoint> points(const cad_import::EdgeUse& use) const;

 private:
  std::span<const cad_import::Face> faces_;
  std::vector<EdgeCut> cuts_;
  std::vector<std::pair<int, std::size_t>> index_;  ///< (edge, index in cuts_), sorted
};

/// Cuts an edge so that every piece obeys the limits in space, follows the curve in (u, v), and is no longer
/// than a cell of the faces it borders (`sizing` by face number). At least `min_pieces`.
[[nodiscard]] std::vector<double> cut_edge(const EdgeCut& cut, const StepLimits& limits,
                                           std::span<const FaceSizing> sizing, int min_pieces,
                                           double fineness);

/// The least number of even pieces, `at_least` or more, that obeys the limits in space. Nullopt where that
/// would be many times as many: the curve's parameter is too uneven.
[[nodiscard]] std::optional<int> even_pieces(const EdgeCut& cut, const StepLimits& limits, int at_least);

/// Cuts an edge in pieces of equal steps in t.
[[nodiscard]] std::vector<double> cut_evenly(const EdgeCut& cut, int pieces);

/// The bounding rectangle of a face's loops in (u, v).
[[nodiscard]] UvBox loop_box(const cad_import::Face& face);

}  // namespace catoptra::tessellate
