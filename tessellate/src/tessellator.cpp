#include "tessellate/src/tessellator.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "tessellate/src/deviation.h"
#include "tessellate/src/face_fill.h"

namespace catoptra::tessellate {
namespace {

using cad_import::Face;

constexpr int kRounds = 5;            // of meshing, each with finer grids or borders where a limit was missed
constexpr int kMostPieces = 100000;   // of one edge
constexpr double kMostUneven = 2.5;   // even cells over graded ones, above which a grid wastes too many
constexpr double kMostShare = 4;      // deviation over the limit that more rows and columns may mend
constexpr double kFinerBorder = 4;    // times as many pieces where a coarse border crosses itself
constexpr double kFinestBorder = 16;  // ... and in the end

/// A closed edge needs pieces enough to go round, and two edges between the same ends must not become one.
int least_pieces(std::span<const EdgeCut> cuts, const EdgeCut& cut) {
  if (cut.degenerate) return 1;
  if (cut.start_vertex == cut.end_vertex) return 4;
  const auto ends = std::minmax(cut.start_vertex, cut.end_vertex);
  const auto same = [&](const EdgeCut& other) {
    return &other != &cut && !other.degenerate && std::minmax(other.start_vertex, other.end_vertex) == ends;
  };
  return std::any_of(cuts.begin(), cuts.end(), same) ? 2 : 1;
}

/// Mean lengths of |du| and |dv| over the rectangle, times its sides: width and height; and the area.
glm::dvec3 measure(const cad_import::ExactSurface& surface, const UvBox& box) {
  constexpr int kSamples = 6;
  glm::dvec3 sum(0);
  for (int j = 0; j < kSamples; ++j)
    for (int i = 0; i < kSamples; ++i) {
      const glm::dvec2 uv = box.min + (glm::dvec2(i, j) + 0.5) / double(kSamples) * box.extent();
      const auto f = surface.d1(uv.x, uv.y);
      sum += glm::dvec3(glm::length(f.du), glm::length(f.dv), glm::length(glm::cross(f.du, f.dv)));
    }
  const glm::dvec2 extent = box.extent();
  return sum / double(kSamples * kSamples) * glm::dvec3(extent.x, extent.y, extent.x * extent.y);
}

}  // namespace

Tessellator::Tessellator(std::span<const Face> faces)
    : faces_(with_complete_loops(faces)), boxes_(faces.size()), sides_(faces.size()), skipped_(faces.size()) {
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (!faces_[f].surface) {
      skip(f, "it has no surface");
      continue;
    }
    boxes_[f] = loop_box(faces_[f]);
    const glm::dvec2 extent = boxes_[f].extent();
    if (!(extent.x > 0 && extent.y > 0 && std::isfinite(extent.x) && std::isfinite(extent.y)))
      skip(f, "its border has no area in (u, v)");
    else
      sides_[f] = recognise_grid(faces_[f]);
  }
}

void Tessellator::skip(std::size_t face, std::string reason) {
  skipped_[face] = std::move(reason);
  faces_[face].loops.clear();
  sides_[face].reset();
}

std::size_t Tessellator::remaining() const {
  return static_cast<std::size_t>(
      std::count_if(skipped_.begin(), skipped_.end(), [](const auto& reason) { return reason.empty(); }));
}

bool Tessellator::is_single_grid() const {
  return remaining() == 1 &&
         std::any_of(sides_.begin(), sides_.end(), [](const auto& s) { return s.has_value(); });
}

std::vector<FaceSizing> Tessellator::size_all(const StepLimits& limits) const {
  std::vector<FaceSizing> sizing(faces_.size());
  for (std::size_t f = 0; f < faces_.size(); ++f)
    if (skipped_[f].empty()) sizing[f] = size_face(*faces_[f].surface, boxes_[f], limits);
  return sizing;
}

double Tessellator::estimated_cells(const StepLimits& limits) const {
  double cells = 0;
  for (const auto& s : size_all(limits)) cells += s.u.cells() * s.v.cells();
  return cells;
}

glm::dvec2 Tessellator::single_size_mm() const {
  for (std::size_t f = 0; f < faces_.size(); ++f)
    if (skipped_[f].empty()) return glm::dvec2(measure(*faces_[f].surface, boxes_[f]));
  return glm::dvec2(0);
}

double Tessellator::rectangle_area_mm2() const {
  double area = 0;
  for (std::size_t f = 0; f < faces_.size(); ++f)
    if (skipped_[f].empty()) area += measure(*faces_[f].surface, boxes_[f]).z;
  return area;
}

Attempt Tessellator::mesh(const StepLimits& limits) const {
  const std::vector<FaceSizing> sizing = size_all(limits);
  Borders borders(faces_);
  Grids grids = sides_;
  const std::vector<int> even = even_cuts(borders, grids, sizing, limits);
  std::vector<double> fineness(faces_.size(), 1);
  for (int round = 1;; ++round) {
    cut(borders, grids, even, sizing, limits, fineness);
    Attempt attempt{{}, std::vector<std::string>(faces_.size())};
    borders.add_vertices(attempt.draft);
    bool again = false;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!skipped_[f].empty()) continue;
      const std::size_t first = attempt.draft.triangles.size();
      const auto index = static_cast<int>(f);
      if (!grids[f]) {
        attempt.failure[f] = fill_face(faces_[f], index, borders, sizing[f], limits, attempt.draft);
        // Two sides of a narrow slot may cross when cut coarsely.
        if (!attempt.failure[f].empty() && fineness[f] < kFinestBorder) {
          fineness[f] *= kFinerBorder;
          again = true;
        }
        continue;
      }
      mesh_grid(faces_[f], index, *grids[f], borders, attempt.draft);
      const double share = worst_chord_share(std::span(attempt.draft.triangles).subspan(first),
                                             attempt.draft.vertices, *faces_[f].surface, limits);
      if (share <= 1) continue;
      again = true;
      // Far off somewhere: a place that only refinement on the spot can serve.
      if (share > kMostShare) grids[f].reset();
      fineness[f] *= 1.02 * std::sqrt(share);
    }
    if (!again || round == kRounds) return attempt;
  }
}

/// Edges opposite each other in a grid must be cut equally often: classes of edges, joined over all grids.
std::vector<std::size_t> Tessellator::grid_classes(const Borders& borders, const Grids& grids) {
  std::vector<std::size_t> parent(borders.cuts().size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::size_t k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  for (const auto& sides : grids)
    for (std::size_t k = 0; sides && k < 2; ++k)
      parent[root(borders.index_of((*sides)[k]->edge))] = root(borders.index_of((*sides)[k + 2]->edge));
  for (std::size_t k = 0; k < parent.size(); ++k) parent[k] = root(k);
  return parent;
}

/// Per edge: the even pieces that grids at it need for their own sake; 0 where there is no grid. A face where
/// evenness costs too much is taken off `grids`.
std::vector<int> Tessellator::even_cuts(const Borders& borders, Grids& grids,
                                        std::span<const FaceSizing> sizing, const StepLimits& limits) const {
  const auto& cuts = borders.cuts();
  std::vector<int> even(cuts.size(), 0);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (!grids[f]) continue;
    const auto uneven = [](const CellCount& c) { return c.even_cells() > kMostUneven * c.cells(); };
    if (!limits.grid && (uneven(sizing[f].u) || uneven(sizing[f].v))) grids[f].reset();
    for (std::size_t k = 0; grids[f] && k < 4; ++k) {
      const std::size_t index = borders.index_of((*grids[f])[k]->edge);
      const double cells = (k % 2 == 0 ? sizing[f].u : sizing[f].v).even_cells();
      const int least = std::max({even[index], least_pieces(cuts, cuts[index]),
                                  static_cast<int>(std::ceil(std::min<double>(cells, kMostPieces) - 1e-6))});
      const auto pieces = limits.grid ? least : even_pieces(cuts[index], limits, least);
      if (pieces)
        even[index] = *pieces;
      else
        grids[f].reset();
    }
  }
  return even;
}

void Tessellator::cut(Borders& borders, const Grids& grids, std::span<const int> even,
                      std::span<const FaceSizing> sizing, const StepLimits& limits,
                      std::span<const double> fineness) const {
  auto& cuts = borders.cuts();
  const auto class_of = grid_classes(borders, grids);
  std::vector<int> pieces(cuts.size(), 0);  // by class; 0: no grid at the edge
  for (std::size_t f = 0; f < faces_.size(); ++f)
    for (std::size_t k = 0; grids[f] && k < 4; ++k) {
      const std::size_t index = borders.index_of((*grids[f])[k]->edge);
      int& need = pieces[class_of[index]];
      need = std::max(need,
                      static_cast<int>(std::ceil(std::min<double>(fineness[f] * even[index], kMostPieces))));
    }
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    if (pieces[class_of[k]] > 0) continue;
    double finest = 1;
    for (const auto& use : cuts[k].uses)
      finest = std::max(finest, fineness[static_cast<std::size_t>(use.face)]);
    cuts[k].t = cut_edge(cuts[k], limits, sizing, least_pieces(cuts, cuts[k]), finest);
  }
  for (std::size_t k = 0; k < cuts.size(); ++k)
    if (const int n = pieces[class_of[k]]; n > 0) cuts[k].t = cut_evenly(cuts[k], n);
}

}  // namespace catoptra::tessellate
