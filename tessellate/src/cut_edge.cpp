// Cutting an edge: adaptively along its curve in space and its images in (u, v).
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tessellate/src/border.h"

namespace catoptra::tessellate {
namespace {

constexpr double kCellLength =
    1.2;  // longest piece, in cells: a little more than 1 saves vertices, not quality
constexpr double kUvFlatness = 0.1;  // of a cell, between the straight piece and the curve in (u, v)
constexpr int kMaxDepth = 10;
constexpr int kMostRefined = 4;  // times the pieces that curvature asks for: an uneven parameter wastes more
constexpr std::size_t kMostUses = 4;  // that are looked at: an edge has one or two, rarely more

/// A point of the edge: in space, and in the cells of the faces at it.
struct Sample {
  double t = 0;
  glm::dvec3 point{0};
  std::array<glm::dvec2, kMostUses> cells{};
};

/// Distance of a point from a line segment.
double deviation(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 ab = b - a;
  const double length2 = glm::dot(ab, ab);
  const double x = length2 > 0 ? std::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) : 0;
  return glm::distance(p, a + x * ab);
}

/// Turn of a curve over a piece, rad: half chords of a piece that turns by x differ in direction by x / 2.
double turn(const glm::dvec3& a, const glm::dvec3& middle, const glm::dvec3& b) {
  const glm::dvec3 first = middle - a, second = b - middle;
  return 2 * std::atan2(glm::length(glm::cross(first, second)), glm::dot(first, second));
}

/// At a kink no piece is short enough for the angle: below this length the angle no longer counts.
bool too_short_to_turn(const glm::dvec3& a, const glm::dvec3& b, const StepLimits& limits) {
  const double shortest = limits.chord_mm < kUnlimited ? 8 * limits.chord_mm : limits.length_mm / 16;
  return glm::distance(a, b) < shortest;
}

class Cutter {
 public:
  Cutter(const EdgeCut& cut, const StepLimits& limits, std::span<const FaceSizing> sizing, double fineness)
      : cut_(cut),
        limits_(limits),
        sizing_(sizing),
        fineness_(fineness),
        uses_(std::min(cut.uses.size(), kMostUses)) {
    limits_.chord_mm /= fineness * fineness;
  }

  std::vector<double> run(int min_pieces) {
    const Sample begin = sample(cut_.t_begin), end = sample(cut_.t_end);
    const int pieces = std::max(min_pieces, estimate(begin, end));
    t_.assign(1, cut_.t_begin);
    Sample previous = begin;
    for (int k = 1; k <= pieces; ++k) {
      const Sample next = k == pieces ? end : sample(cut_.t_begin + (cut_.t_end - cut_.t_begin) * k / pieces);
      split(previous, next, 0);
      previous = next;
    }
    return std::move(t_);
  }

 private:
  Sample sample(double t) const {
    Sample s;
    s.t = t;
    const auto& first = *cut_.uses.front().use;
    s.point = first.curve->point(t);
    for (std::size_t k = 0; k < uses_; ++k)
      s.cells[k] =
          sizing_[static_cast<std::size_t>(cut_.uses[k].face)].to_cells(cut_.uses[k].use->curve->uv(t));
    return s;
  }

  /// Pieces needed if the curve bent evenly: a chord's deviation falls with the square of their number.
  int estimate(const Sample& begin, const Sample& end) const {
    double need = 1;
    Sample previous = begin;
    std::array<double, kMostUses> length{};
    for (int k = 1; k <= 4; ++k) {
      const Sample s = k == 4 ? end : sample(cut_.t_begin + (cut_.t_end - cut_.t_begin) * k / 4);
      if (k < 4 && !cut_.degenerate)
        need = std::max(need, std::sqrt(deviation(s.point, begin.point, end.point) / limits_.chord_mm));
      for (std::size_t i = 0; i < uses_; ++i) length[i] += glm::distance(previous.cells[i], s.cells[i]);
      previous = s;
    }
    for (const double l : length) need = std::max(need, l * fineness_ / kCellLength);
    return static_cast<int>(std::ceil(std::min(need, 1e5) - 1e-6));
  }

  bool good(const Sample& a, const Sample& middle, const Sample& b) const {
    for (std::size_t k = 0; k < uses_; ++k) {
      if (glm::distance(a.cells[k], b.cells[k]) > kCellLength / fineness_ * (1 + 1e-6)) return false;
      if (glm::distance(0.5 * (a.cells[k] + b.cells[k]), middle.cells[k]) > kUvFlatness / fineness_)
        return false;
    }
    if (cut_.degenerate) return true;
    const glm::dvec3 first = middle.point - a.point, second = b.point - middle.point;
    if (deviation(middle.point, a.point, b.point) > limits_.chord_mm) return false;
    if (glm::length(first) + glm::length(second) > limits_.length_mm * (1 + 1e-6)) return false;
    return too_short_to_turn(a.point, b.point, limits_) ||
           turn(a.point, middle.point, b.point) <= limits_.angle_rad;
  }

  void split(const Sample& a, const Sample& b, int depth) {
    const Sample middle = sample(0.5 * (a.t + b.t));
    if (depth < kMaxDepth && !good(a, middle, b)) {
      split(a, middle, depth + 1);
      split(middle, b, depth + 1);
    } else {
      t_.push_back(b.t);
    }
  }

  const EdgeCut& cut_;
  StepLimits limits_;
  std::span<const FaceSizing> sizing_;
  double fineness_;
  std::size_t uses_;
  std::vector<double> t_;
};

}  // namespace

std::vector<double> cut_edge(const EdgeCut& cut, const StepLimits& limits, std::span<const FaceSizing> sizing,
                             int min_pieces, double fineness) {
  return Cutter(cut, limits, sizing, fineness).run(min_pieces);
}

std::optional<int> even_pieces(const EdgeCut& cut, const StepLimits& limits, int at_least) {
  if (cut.degenerate) return at_least;
  const auto& curve = *cut.uses.front().use->curve;
  const int most = kMostRefined * at_least + 64;
  for (int pieces = at_least; pieces <= most;) {
    double excess = 0;  // how much finer the worst piece must be
    glm::dvec3 a = curve.point(cut.t_begin);
    const double step = (cut.t_end - cut.t_begin) / pieces;
    for (int k = 0; k < pieces; ++k) {
      const glm::dvec3 middle = curve.point(cut.t_begin + (k + 0.5) * step);
      const glm::dvec3 b = curve.point(cut.t_begin + (k + 1) * step);
      excess = std::max({excess, std::sqrt(deviation(middle, a, b) / limits.chord_mm),
                         glm::distance(a, b) / limits.length_mm});
      if (!too_short_to_turn(a, b, limits)) excess = std::max(excess, turn(a, middle, b) / limits.angle_rad);
      a = b;
    }
    if (excess <= 1 + 1e-6) return pieces;
    pieces = std::max(pieces + 1, static_cast<int>(std::ceil(pieces * std::min<double>(excess, most))));
  }
  return std::nullopt;
}

std::vector<double> cut_evenly(const EdgeCut& cut, int pieces) {
  std::vector<double> t(static_cast<std::size_t>(pieces) + 1);
  for (int k = 0; k <= pieces; ++k)
    t[static_cast<std::size_t>(k)] = cut.t_begin + (cut.t_end - cut.t_begin) * k / pieces;
  t.back() = cut.t_end;
  return t;
}

}  // namespace catoptra::tessellate
