// A face's outline as a grid over its parameters, so that most points need no exact test.
#pragma once

#include <cstdint>
#include <vector>

#include "cad_import/cad_model.h"

namespace catoptra::optics {

/// Answers as FaceTrim::contains does. Cells near the outline ask it; the others know.
class TrimGrid {
 public:
  /// Keeps the face's trimming. A face without any is the whole surface.
  explicit TrimGrid(const cad_import::Face& face);

  [[nodiscard]] bool contains(double u, double v) const {
    if (!trim_) return true;
    const int i = int((u - u_min_) * u_rate_), j = int((v - v_min_) * v_rate_);
    if (i < 0 || j < 0 || i >= kCells || j >= kCells) return trim_->contains(u, v);
    const Cell cell = cells_[std::size_t(j * kCells + i)];
    return cell == Cell::inside || (cell == Cell::border && trim_->contains(u, v));
  }

 private:
  static constexpr int kCells = 64;
  enum class Cell : std::uint8_t { outside, inside, border };
  void mark_outline(const cad_import::Face& face);

  std::shared_ptr<const cad_import::FaceTrim> trim_;
  double u_min_ = 0, v_min_ = 0, u_rate_ = 1, v_rate_ = 1;  // cells per unit of parameter
  std::vector<Cell> cells_;
};

}  // namespace catoptra::optics
