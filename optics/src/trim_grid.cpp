#include "optics/src/trim_grid.h"

#include <algorithm>

namespace catoptra::optics {

TrimGrid::TrimGrid(const cad_import::Face& face) : trim_(face.trim) {
  if (!trim_) return;
  const auto domain = face.surface->domain();
  u_min_ = domain.u_min;
  v_min_ = domain.v_min;
  u_rate_ = kCells / (domain.u_max - domain.u_min);
  v_rate_ = kCells / (domain.v_max - domain.v_min);

  // A cell's state is that of its middle where the whole neighbourhood agrees.
  std::vector<bool> middle(std::size_t(kCells * kCells));
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i)
      middle[std::size_t(j * kCells + i)] =
          trim_->contains(u_min_ + (i + 0.5) / u_rate_, v_min_ + (j + 0.5) / v_rate_);
  cells_.assign(middle.size(), Cell::border);
  for (int j = 1; j + 1 < kCells; ++j)
    for (int i = 1; i + 1 < kCells; ++i) {
      const std::size_t at = std::size_t(j * kCells + i);
      bool same = true;
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di)
          same = same && middle[std::size_t((j + dj) * kCells + i + di)] == middle[at];
      if (same) cells_[at] = middle[at] ? Cell::inside : Cell::outside;
    }
  mark_outline(face);
}

// Slots and notches narrower than a cell show in no middle: the outline itself marks the cells it passes.
void TrimGrid::mark_outline(const cad_import::Face& face) {
  constexpr int kPointsPerEdge = 512;
  for (const auto& loop : face.loops)
    for (const auto& edge : loop.edges)
      for (int k = 0; edge.curve && k <= kPointsPerEdge; ++k) {
        const glm::dvec2 uv = edge.curve->uv(edge.t_begin + (edge.t_end - edge.t_begin) * k / kPointsPerEdge);
        const int i = int((uv.x - u_min_) * u_rate_), j = int((uv.y - v_min_) * v_rate_);
        for (int b = std::max(j - 1, 0); b <= std::min(j + 1, kCells - 1); ++b)
          for (int a = std::max(i - 1, 0); a <= std::min(i + 1, kCells - 1); ++a)
            cells_[std::size_t(b * kCells + a)] = Cell::border;
      }
}

}  // namespace catoptra::optics
