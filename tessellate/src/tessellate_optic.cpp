// The order of the work: size the faces, cut the edges, mesh the faces, and again where a limit was missed.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "cad_import/error.h"
#include "tessellate/optic_mesh.h"
#include "tessellate/src/border.h"
#include "tessellate/src/deviation.h"
#include "tessellate/src/face_fill.h"
#include "tessellate/src/face_grid.h"
#include "tessellate/src/mesh_draft.h"
#include "tessellate/src/sizing.h"

namespace catoptra::tessellate {
namespace {

using cad_import::Face;

constexpr int kMostPieces = 100000;  // of one edge
constexpr double kMostUneven = 2.5;  // even cells over graded ones, above which a grid wastes too many
constexpr double kMostShare = 4;     // deviation over the limit that more rows and columns may mend

using Grids = std::vector<std::optional<GridSides>>;

/// A mesh of all faces but those that are listed.
struct Attempt {
  MeshDraft draft;
  std::vector<std::string> failure;  ///< per face; empty where it was meshed
  std::size_t used_vertices = 0;
};

/// One optic on its way to a mesh.
class Tessellator {
 public:
  explicit Tessellator(std::vector<Face> faces) : faces_(std::move(faces)), skipped_(faces_.size()) {
    for (const auto& face : faces_) sides_.push_back(recognise_grid(face));
  }

  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
  [[nodiscard]] const Grids& sides() const { return sides_; }

  /// Leaves a face out from now on.
  void skip(std::size_t face, std::string reason) {
    skipped_[face] = std::move(reason);
    faces_[face].loops.clear();
    sides_[face].reset();
  }

  /// Faces without a usable border or surface are left out at once.
  void skip_unusable() {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!faces_[f].surface) {
        skip(f, "it has no surface");
      } else if (const glm::dvec2 extent = loop_box(faces_[f]).extent(); !(extent.x > 0 && extent.y > 0)) {
        skip(f, "its border has no area in (u, v)");
      }
    }
  }

  [[nodiscard]] const std::vector<std::string>& skipped() const { return skipped_; }

  /// Meshes within `limits`; tightens the grids until their measured deviation is within them too.
  [[nodiscard]] Attempt mesh(const StepLimits& limits) {
    std::vector<FaceSizing> sizing(faces_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f)
      if (skipped_[f].empty()) sizing[f] = size_face(*faces_[f].surface, loop_box(faces_[f]), limits);
    Borders borders(faces_);
    Grids grids = sides_;
    for (std::size_t f = 0; f < faces_.size(); ++f)
      if (sizing[f].u.even_cells() > kMostUneven * sizing[f].u.cells() ||
          sizing[f].v.even_cells() > kMostUneven * sizing[f].v.cells())
        grids[f].reset();
    std::vector<double> factor(faces_.size(), 1);
    constexpr int kRounds = 4;
    for (int round = 1;; ++round) {
      cut(borders, grids, sizing, limits, factor);
      Attempt attempt;
      borders.add_vertices(attempt.draft);
      attempt.failure.resize(faces_.size());
      bool tight = true;
      for (std::size_t f = 0; f < faces_.size(); ++f) {
        if (!skipped_[f].empty()) continue;
        const std::size_t first = attempt.draft.triangles.size();
        const auto index = static_cast<int>(f);
        if (!grids[f]) {
          attempt.failure[f] = fill_face(faces_[f], index, borders, sizing[f], limits, attempt.draft);
          continue;
        }
        mesh_grid(faces_[f], index, *grids[f], borders, attempt.draft);
        const double share = worst_chord_share(std::span(attempt.draft.triangles).subspan(first),
                                               attempt.draft.vertices, *faces_[f].surface, limits);
        if (share <= 1) continue;
        tight = false;
        // Far off somewhere: a place that only refinement on the spot can serve.
        if (share > kMostShare) grids[f].reset();
        factor[f] *= 1.02 * std::sqrt(share);
      }
      if (tight || round == kRounds) return attempt;
    }
  }

 private:
  /// Edges opposite each other in a grid must be cut equally often: classes of edges, joined over all grids.
  std::vector<std::size_t> grid_classes(const Borders& borders, const Grids& grids, std::size_t count) const {
    std::vector<std::size_t> parent(count);
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](std::size_t k) {
      while (parent[k] != k) k = parent[k] = parent[parent[k]];
      return k;
    };
    for (const auto& sides : grids)
      for (std::size_t k = 0; sides && k < 2; ++k)
        parent[root(borders.index_of((*sides)[k]->edge))] = root(borders.index_of((*sides)[k + 2]->edge));
    for (std::size_t k = 0; k < count; ++k) parent[k] = root(k);
    return parent;
  }

  void cut(Borders& borders, const Grids& grids, const std::vector<FaceSizing>& sizing,
           const StepLimits& limits, const std::vector<double>& factor) const {
    auto& cuts = borders.cuts();
    const auto class_of = grid_classes(borders, grids, cuts.size());
    std::vector<int> pieces(cuts.size(), 0);  // by class; 0: free
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!grids[f]) continue;
      for (std::size_t k = 0; k < 4; ++k) {
        const double cells = factor[f] * (k % 2 == 0 ? sizing[f].u : sizing[f].v).even_cells();
        int& need = pieces[class_of[borders.index_of((*grids[f])[k]->edge)]];
        need = std::max(need, static_cast<int>(std::ceil(std::min<double>(cells, kMostPieces) - 1e-6)));
      }
    }
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      cuts[k].t = cut_edge(cuts[k], limits, sizing, least_pieces(cuts, k));
      int& need = pieces[class_of[k]];
      if (need > 0 && !limits.grid) need = std::max(need, static_cast<int>(cuts[k].t.size()) - 1);
    }
    for (std::size_t k = 0; k < cuts.size(); ++k)
      if (const int n = pieces[class_of[k]]; n > 0)
        cuts[k].t = cut_evenly(cuts[k], std::max(n, least_pieces(cuts, k)));
  }

  /// A closed edge needs pieces enough to go round, and two edges between the same ends must not become one.
  static int least_pieces(const std::vector<EdgeCut>& cuts, std::size_t k) {
    const EdgeCut& cut = cuts[k];
    if (cut.degenerate) return 1;
    if (cut.start_vertex == cut.end_vertex) return 4;
    const auto ends = std::minmax(cut.start_vertex, cut.end_vertex);
    const auto same = [&](const EdgeCut& other) {
      return &other != &cut && !other.degenerate && std::minmax(other.start_vertex, other.end_vertex) == ends;
    };
    return std::any_of(cuts.begin(), cuts.end(), same) ? 2 : 1;
  }

  std::vector<Face> faces_;
  Grids sides_;
  std::vector<std::string> skipped_;  ///< per face: why it is left out
};

void check(std::span<const Face> faces, const TessellationOptions& options) {
  const auto refuse = [](const char* option, const char* reason) { throw Error("", option, reason); };
  if (faces.empty()) throw Error("", "optic", "there is no face to tessellate", "name the optical faces");
  if (!(options.chord_mm > 0)) refuse("chord_mm", "must be greater than 0");
  if (!(options.angle_rad > 0)) refuse("angle_rad", "must be greater than 0");
  if (options.grid && (options.grid->columns < 2 || options.grid->rows < 2))
    refuse("grid", "needs at least 2 x 2 vertices");
  if (options.target_vertices && *options.target_vertices < 4)
    refuse("target_vertices", "must be at least 4");
}

}  // namespace

OpticMeshResult tessellate_optic(std::span<const Face> faces, const TessellationOptions& options) {
  check(faces, options);
  Tessellator work(with_complete_loops(faces));
  work.skip_unusable();
  StepLimits limits{options.chord_mm, options.angle_rad, kUnlimited, options.grid};
  if (options.grid) limits = {kUnlimited, options.angle_rad, kUnlimited, options.grid};
  Attempt attempt = work.mesh(limits);

  OpticMeshResult result{OpticMesh(attempt.draft, work.faces()), {}, {}};
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::string& reason = work.skipped()[f].empty() ? attempt.failure[f] : work.skipped()[f];
    if (!reason.empty()) result.unmeshed.push_back({static_cast<int>(f), faces[f].id, reason});
  }
  if (result.mesh.triangle_count() == 0)
    throw Error("", "face " + result.unmeshed.front().id,
                "no face could be meshed: " + result.unmeshed.front().reason);
  return result;
}

}  // namespace catoptra::tessellate
