#include "optics/ground_region.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptra::optics {
namespace {

constexpr int kMaxCellsPerSide = 400;

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

double signed_area(const GroundPolygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return twice / 2;
}

/// The part of convex `subject` inside convex `clip` (Sutherland and Hodgman 1974).
GroundPolygon clipped(GroundPolygon subject, const GroundPolygon& clip) {
  const double sense = signed_area(clip) < 0 ? -1 : 1;
  for (std::size_t i = 0; i < clip.size() && !subject.empty(); ++i) {
    const glm::dvec2 a = clip[i], edge = clip[(i + 1) % clip.size()] - a;
    GroundPolygon kept;
    for (std::size_t k = 0; k < subject.size(); ++k) {
      const glm::dvec2 p = subject[k], q = subject[(k + 1) % subject.size()];
      const double dp = sense * cross(edge, p - a), dq = sense * cross(edge, q - a);
      if (dp >= 0) kept.push_back(p);
      if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) kept.push_back(p + dp / (dp - dq) * (q - p));
    }
    subject = std::move(kept);
  }
  return subject;
}

/// Places of cells are whole numbers of the finest possible half cells, so that neighbours ask for the same
/// places.
struct Lattice {
  glm::dvec2 origin, step;
  [[nodiscard]] glm::dvec2 at(std::uint32_t x, std::uint32_t y) const {
    return {origin.x + step.x * x, origin.y + step.y * y};
  }
};

struct Cell {
  std::uint32_t x, y;
};

std::uint64_t key(std::uint32_t x, std::uint32_t y) {
  return (std::uint64_t(x) << 32) | y;
}

/// States of the places asked for, each computed once.
class StateCache {
 public:
  StateCache(const Lattice& lattice, const GroundState& state) : lattice_(lattice), state_(state) {}

  void prepare(std::vector<std::uint64_t> wanted) {
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    std::vector<std::uint64_t> fresh;
    std::set_difference(wanted.begin(), wanted.end(), keys_.begin(), keys_.end(), std::back_inserter(fresh));
    std::vector<std::uint8_t> states(fresh.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, fresh.size(), 64), [&](const auto& some) {
      for (std::size_t i = some.begin(); i < some.end(); ++i)
        states[i] = state_(lattice_.at(std::uint32_t(fresh[i] >> 32), std::uint32_t(fresh[i])));
    });
    std::vector<std::uint64_t> keys;
    std::vector<std::uint8_t> values;
    keys.reserve(keys_.size() + fresh.size());
    values.reserve(keys.capacity());
    for (std::size_t i = 0, j = 0; i < keys_.size() || j < fresh.size();) {
      const bool old = j == fresh.size() || (i < keys_.size() && keys_[i] < fresh[j]);
      keys.push_back(old ? keys_[i] : fresh[j]);
      values.push_back(old ? values_[i++] : states[j++]);
    }
    keys_ = std::move(keys);
    values_ = std::move(values);
  }

  [[nodiscard]] std::uint8_t at(std::uint64_t place) const {
    const auto found = std::lower_bound(keys_.begin(), keys_.end(), place);
    return values_[std::size_t(found - keys_.begin())];
  }

 private:
  const Lattice& lattice_;
  const GroundState& state_;
  std::vector<std::uint64_t> keys_;  // sorted
  std::vector<std::uint8_t> values_;
};

std::array<std::uint64_t, 5> samples_of(const Cell& cell, std::uint32_t size) {
  const std::uint32_t half = size / 2;
  return {key(cell.x, cell.y), key(cell.x + size, cell.y), key(cell.x, cell.y + size),
          key(cell.x + size, cell.y + size), key(cell.x + half, cell.y + half)};
}

class Measurer {
 public:
  Measurer(std::span<const GroundPolygon> parts, const GroundState& state, const RegionOptions& options)
      : parts_(parts), options_(options), cache_(lattice_, state) {}

  RegionMeasure run() {
    for (const GroundPolygon& part : parts_) result_.area_mm2 += polygon_area_mm2(part);
    if (!(result_.area_mm2 > 0)) return result_;
    std::uint32_t size = 2u << options_.max_splits;
    std::vector<Cell> cells = first_cells(size);
    for (int split = 0; !cells.empty(); ++split, size /= 2) {
      std::vector<std::uint64_t> wanted;
      for (const Cell& cell : cells)
        for (const std::uint64_t place : samples_of(cell, size)) wanted.push_back(place);
      cache_.prepare(std::move(wanted));
      cells = settle(cells, size, split);
    }
    return result_;
  }

 private:
  std::vector<Cell> first_cells(std::uint32_t size) {
    glm::dvec2 low{1e300}, high{-1e300};
    for (const GroundPolygon& part : parts_)
      for (const glm::dvec2& p : part) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    const auto count = [&](double length) {
      return std::clamp(int(std::ceil(length / options_.cell_mm)), 4, kMaxCellsPerSide);
    };
    const int columns = count(high.x - low.x), rows = count(high.y - low.y);
    lattice_ = {low, {(high.x - low.x) / columns / size, (high.y - low.y) / rows / size}};
    std::vector<Cell> cells;
    for (int i = 0; i < columns; ++i)
      for (int j = 0; j < rows; ++j) {
        const Cell cell{std::uint32_t(i) * size, std::uint32_t(j) * size};
        if (area_of(cell, size) > 0) cells.push_back(cell);
      }
    return cells;
  }

  double area_of(const Cell& cell, std::uint32_t size) const {
    const glm::dvec2 low = lattice_.at(cell.x, cell.y), high = lattice_.at(cell.x + size, cell.y + size);
    const GroundPolygon square{low, {high.x, low.y}, high, {low.x, high.y}};
    double area = 0;
    for (const GroundPolygon& part : parts_) area += std::abs(signed_area(clipped(square, part)));
    return area;
  }

  /// Counts the cells of one state; returns the quarters of the others, or shares them out at the end.
  std::vector<Cell> settle(const std::vector<Cell>& cells, std::uint32_t size, int split) {
    std::vector<Cell> mixed;
    double mixed_area = 0;
    for (const Cell& cell : cells) {
      const auto samples = samples_of(cell, size);
      const std::uint8_t first = cache_.at(samples[0]);
      if (std::all_of(samples.begin(), samples.end(), [&](auto s) { return cache_.at(s) == first; })) {
        count(cell, size, first, area_of(cell, size));
      } else {
        mixed.push_back(cell);
        mixed_area += area_of(cell, size);
      }
    }
    if (split >= options_.max_splits || mixed_area <= options_.tolerance * result_.area_mm2) {
      for (const Cell& cell : mixed) share_out(cell, size);
      result_.mixed_mm2 = mixed_area;
      return {};
    }
    std::vector<Cell> quarters;
    const std::uint32_t half = size / 2;
    for (const Cell& cell : mixed)
      for (const Cell& quarter : {cell, Cell{cell.x + half, cell.y}, Cell{cell.x, cell.y + half},
                                  Cell{cell.x + half, cell.y + half}})
        if (area_of(quarter, half) > 0) quarters.push_back(quarter);
    return quarters;
  }

  void count(const Cell& cell, std::uint32_t size, std::uint8_t state, double area) {
    result_.area_by_state[state] += area;
    if (state == 0) return;
    const glm::dvec2 low = lattice_.at(cell.x, cell.y);
    result_.cells.push_back({low, lattice_.at(cell.x + size, cell.y + size) - low, state});
  }

  /// Half to the middle's state, an eighth to each corner's.
  void share_out(const Cell& cell, std::uint32_t size) {
    const auto samples = samples_of(cell, size);
    const double area = area_of(cell, size);
    for (std::size_t i = 0; i < 4; ++i) result_.area_by_state[cache_.at(samples[i])] += area / 8;
    count(cell, size, cache_.at(samples[4]), area / 2);
  }

  std::span<const GroundPolygon> parts_;
  RegionOptions options_;
  Lattice lattice_{};
  StateCache cache_;
  RegionMeasure result_;
};

}  // namespace

double polygon_area_mm2(const GroundPolygon& polygon) {
  return std::abs(signed_area(polygon));
}

bool polygon_holds(const GroundPolygon& polygon, const glm::dvec2& point) {
  const double sense = signed_area(polygon) < 0 ? -1 : 1;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if (sense * cross(b - a, point - a) < 0) return false;
  }
  return true;
}

double RegionMeasure::area_of_any(std::uint8_t bits) const {
  double sum = 0;
  for (const auto& [state, area] : area_by_state)
    if (state & bits) sum += area;
  return sum;
}

double RegionMeasure::area_of_all(std::uint8_t bits) const {
  double sum = 0;
  for (const auto& [state, area] : area_by_state)
    if ((state & bits) == bits) sum += area;
  return sum;
}

RegionMeasure measure_region(std::span<const GroundPolygon> parts, const GroundState& state,
                             const RegionOptions& options) {
  return Measurer(parts, state, options).run();
}

}  // namespace catoptra::optics
