#include "tessellate/src/border.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

namespace catoptra::tessellate {

using cad_import::EdgeUse;
using cad_import::Face;

Borders::Borders(std::span<const Face> faces) : faces_(faces) {
  std::map<int, std::size_t> found;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (const auto& loop : faces[f].loops)
      for (const auto& use : loop.edges) {
        const auto [place, is_new] = found.try_emplace(use.edge, cuts_.size());
        if (is_new) {
          EdgeCut cut;
          cut.edge = use.edge;
          cut.start_vertex = use.reversed ? use.end_vertex : use.start_vertex;
          cut.end_vertex = use.reversed ? use.start_vertex : use.end_vertex;
          cut.t_begin = use.t_begin;
          cut.t_end = use.t_end;
          cut.degenerate = use.degenerate;
          cuts_.push_back(std::move(cut));
        }
        cuts_[place->second].uses.push_back({static_cast<int>(f), &use});
      }
  index_.assign(found.begin(), found.end());
}

std::size_t Borders::index_of(int edge) const {
  return std::lower_bound(index_.begin(), index_.end(), std::pair<int, std::size_t>{edge, 0})->second;
}

void Borders::add_vertices(MeshDraft& draft) {
  std::map<int, int> of_topological;
  for (auto& cut : cuts_) {
    const auto& [face, use] = cut.uses.front();
    const auto& surface = *faces_[static_cast<std::size_t>(face)].surface;
    const auto add = [&, face = face, use = use](double t) {
      const glm::dvec2 uv = use->curve->uv(t);
      return draft.add({surface.point(uv.x, uv.y), face, uv});
    };
    const auto add_end = [&](int topological, double t) {
      const auto found = of_topological.find(topological);
      if (found != of_topological.end()) return found->second;
      return of_topological.emplace(topological, add(t)).first->second;
    };
    cut.vertices.assign(cut.t.size(), add_end(cut.start_vertex, cut.t.front()));
    if (cut.degenerate) continue;
    for (std::size_t k = 1; k + 1 < cut.t.size(); ++k) cut.vertices[k] = add(cut.t[k]);
    cut.vertices.back() = add_end(cut.end_vertex, cut.t.back());
    for (std::size_t k = 0; k + 1 < cut.t.size(); ++k)
      draft.borders.push_back({cut.vertices[k], cut.vertices[k + 1], cut.edge, cut.t[k], cut.t[k + 1]});
  }
}

std::vector<LoopPoint> Borders::points(const EdgeUse& use) const {
  const EdgeCut& cut = cut_of(use);
  std::vector<LoopPoint> result;
  result.reserve(cut.t.size());
  for (std::size_t k = 0; k < cut.t.size(); ++k) result.push_back({cut.vertices[k], use.curve->uv(cut.t[k])});
  if (use.reversed) std::reverse(result.begin(), result.end());
  return result;
}

UvBox loop_box(const Face& face) {
  constexpr int kSamples = 8;  // per edge; the box only sizes the grid, the border itself cuts it
  UvBox box;
  for (const auto& loop : face.loops)
    for (const auto& use : loop.edges)
      for (int k = 0; k <= kSamples; ++k)
        box.add(use.curve->uv(use.t_begin + (use.t_end - use.t_begin) * k / kSamples));
  return box;
}

}  // namespace catoptra::tessellate
