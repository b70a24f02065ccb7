// Measures of the glass's outline in its own plane.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "optics/mirror_glass.h"

namespace catoptra::optics {
namespace {

using Outlines = std::span<const std::vector<glm::dvec2>>;

constexpr int kScanLines = 400;  // per side of the outline: 0.5 mm on a mirror of 200 mm, refined to 0.1 mm

struct Interval {
  double low, high;
};

template <typename Visit>
void for_each_edge(Outlines outlines, Visit&& visit) {
  for (const auto& outline : outlines)
    for (std::size_t i = 0; i < outline.size(); ++i) visit(outline[i], outline[(i + 1) % outline.size()]);
}

/// Where the line y = const runs inside (axis 1), or x = const (axis 0): the other coordinate's intervals.
std::vector<Interval> inside_along(Outlines outlines, int axis, double value) {
  std::vector<double> crossings;
  for_each_edge(outlines, [&](const glm::dvec2& a, const glm::dvec2& b) {
    if ((a[axis] <= value) == (b[axis] <= value)) return;
    const double share = (value - a[axis]) / (b[axis] - a[axis]);
    crossings.push_back(a[1 - axis] + share * (b[1 - axis] - a[1 - axis]));
  });
  std::sort(crossings.begin(), crossings.end());
  std::vector<Interval> intervals;
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    intervals.push_back({crossings[i], crossings[i + 1]});
  return intervals;
}

std::vector<Interval> common(const std::vector<Interval>& a, const std::vector<Interval>& b) {
  std::vector<Interval> result;
  for (const Interval& p : a)
    for (const Interval& q : b)
      if (std::max(p.low, q.low) < std::min(p.high, q.high))
        result.push_back({std::max(p.low, q.low), std::min(p.high, q.high)});
  return result;
}

double longest(const std::vector<Interval>& intervals) {
  double length = 0;
  for (const Interval& i : intervals) length = std::max(length, i.high - i.low);
  return length;
}

Interval extent(Outlines outlines, int axis) {
  Interval result{1e300, -1e300};
  for (const auto& outline : outlines)
    for (const glm::dvec2& p : outline)
      result = {std::min(result.low, p[axis]), std::max(result.high, p[axis])};
  return result;
}

/// Widest rectangle whose lower side is at `low`. Between corners the sides are straight, so rows at both
/// ends and at every corner between them suffice.
double rectangle_at(Outlines outlines, double low, double height) {
  std::vector<double> rows{low, low + height};
  for (const auto& outline : outlines)
    for (const glm::dvec2& p : outline)
      if (p.y > low && p.y < low + height) rows.push_back(p.y);
  std::vector<Interval> inside = inside_along(outlines, 1, rows[0]);
  for (std::size_t i = 1; i < rows.size() && !inside.empty(); ++i)
    inside = common(inside, inside_along(outlines, 1, rows[i]));
  return longest(inside);
}

/// Greatest value of `f` over a scan of [low, high], refined around the best of it.
template <typename F>
double scan_maximum(F&& f, double low, double high) {
  double best = -1, place = low;
  for (int pass = 0; pass < 3; ++pass) {
    const double from = low, step = (high - low) / kScanLines;
    for (int i = 0; i <= kScanLines; ++i) {
      const double value = f(from + i * step);
      if (value > best) {
        best = value;
        place = from + i * step;
      }
    }
    low = std::max(low, place - step);
    high = std::min(high, place + step);
    if (!(high > low)) break;
  }
  return std::max(0.0, best);
}

}  // namespace

double distance_inside_mm(Outlines outlines, const glm::dvec2& xy) {
  double nearest = 1e300;
  bool inside = false;
  for_each_edge(outlines, [&](const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 edge = b - a, offset = xy - a;
    const double square = glm::dot(edge, edge);
    const double share = square > 0 ? std::clamp(glm::dot(offset, edge) / square, 0.0, 1.0) : 0;
    nearest = std::min(nearest, glm::length(offset - share * edge));
    if ((a.y <= xy.y) != (b.y <= xy.y) && xy.x < a.x + (xy.y - a.y) / (b.y - a.y) * (b.x - a.x))
      inside = !inside;
  });
  return inside ? nearest : -nearest;
}

double widest_rectangle_mm(Outlines outlines, double height_mm) {
  const Interval y = extent(outlines, 1);
  // The topmost row touches the border, where "inside" is a matter of rounding.
  const double slack = 1e-9 * (y.high - y.low);
  if (y.high - y.low < height_mm + 2 * slack) return 0;
  return scan_maximum([&](double low) { return rectangle_at(outlines, low, height_mm); }, y.low + slack,
                      y.high - height_mm - slack);
}

double longest_upright_mm(Outlines outlines) {
  const Interval x = extent(outlines, 0);
  const double slack = 1e-9 * (x.high - x.low);
  return scan_maximum([&](double at) { return longest(inside_along(outlines, 0, at)); }, x.low + slack,
                      x.high - slack);
}

}  // namespace catoptra::optics
