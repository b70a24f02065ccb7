#include "cad_import/src/face_trim.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace catoptra::cad_import {
namespace {

constexpr int kFirstParts = 8;  // so that an S-shaped curve does not pass for its chord
constexpr int kMaxDepth = 12;   // 8 * 4096 segments at most
constexpr std::size_t kMaxBands = 4096;

double distance_to_chord(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b) {
  const glm::dvec2 d = b - a;
  const double length2 = glm::dot(d, d);
  const double s = length2 > 0 ? std::clamp(glm::dot(p - a, d) / length2, 0.0, 1.0) : 0.0;
  return glm::length(p - a - s * d);
}

/// Appends the points of one edge use, its start included and its end left out, in units of the chord error.
class EdgeSampler {
 public:
  EdgeSampler(const TrimCurve& curve, glm::dvec2 unit, std::vector<glm::dvec2>& out)
      : curve_(curve), unit_(unit), out_(out) {}

  void run(double from, double to) {
    double t0 = from;
    glm::dvec2 p0 = at(from);
    for (int i = 1; i <= kFirstParts; ++i) {
      const double t1 = from + (to - from) * i / kFirstParts;
      const glm::dvec2 p1 = at(t1);
      bisect(t0, p0, t1, p1, 0);
      t0 = t1;
      p0 = p1;
    }
  }

 private:
  glm::dvec2 at(double t) const { return curve_.uv(t) / unit_; }

  void bisect(double t0, glm::dvec2 p0, double t1, glm::dvec2 p1, int depth) {
    const double middle = 0.5 * (t0 + t1);
    const glm::dvec2 p = at(middle);
    if (depth < kMaxDepth && distance_to_chord(p, p0, p1) > 1) {
      bisect(t0, p0, middle, p, depth + 1);
      bisect(middle, p, t1, p1, depth + 1);
    } else {
      out_.push_back(p0 * unit_);
    }
  }

  const TrimCurve& curve_;
  glm::dvec2 unit_;
  std::vector<glm::dvec2>& out_;
};

}  // namespace

std::vector<glm::dvec2> sample_loop(const TrimLoop& loop, glm::dvec2 chord_uv) {
  std::vector<glm::dvec2> polygon;
  for (const EdgeUse& use : loop.edges)
    EdgeSampler(*use.curve, chord_uv, polygon)
        .run(use.reversed ? use.t_end : use.t_begin, use.reversed ? use.t_begin : use.t_end);
  // Corners on the straight line between their neighbours (straight edges are sampled too) say nothing.
  std::vector<glm::dvec2> corners;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 before = corners.empty() ? polygon.back() : corners.back();
    const glm::dvec2 next = polygon[(i + 1) % polygon.size()];
    if (distance_to_chord(polygon[i] / chord_uv, before / chord_uv, next / chord_uv) > 1e-4)
      corners.push_back(polygon[i]);
  }
  return corners.size() >= 3 ? corners : polygon;
}

double signed_area2(std::span<const glm::dvec2> polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i] - polygon[0], b = polygon[(i + 1) % polygon.size()] - polygon[0];
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

PolygonTrim::PolygonTrim(std::span<const std::vector<glm::dvec2>> polygons, glm::dvec2 periods)
    : periods_(periods) {
  glm::dvec2 low(1e300), high(-1e300);
  std::size_t count = 0;
  for (const auto& polygon : polygons)
    for (const glm::dvec2& p : polygon) {
      low = glm::min(low, p);
      high = glm::max(high, p);
      ++count;
    }
  if (count == 0) return;
  low_ = low;
  extent_ = glm::max(high - low, glm::dvec2(1e-300));

  std::vector<Segment> all;
  for (const auto& polygon : polygons)
    for (std::size_t i = 0; i < polygon.size(); ++i)
      all.push_back({(polygon[i] - low_) / extent_, (polygon[(i + 1) % polygon.size()] - low_) / extent_});
  const std::size_t bands = std::clamp<std::size_t>(all.size(), 1, kMaxBands);
  bands_ = double(bands);
  const auto range_of = [&](const Segment& s) {
    const auto band = [&](double v) {
      return std::size_t(std::clamp(std::floor(v * bands_), 0.0, bands_ - 1));
    };
    return std::pair(band(std::min(s.a.y, s.b.y) - kMargin), band(std::max(s.a.y, s.b.y) + kMargin));
  };
  std::vector<std::vector<std::uint32_t>> members(bands);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [first, last] = range_of(all[i]);
    for (std::size_t b = first; b <= last; ++b) members[b].push_back(std::uint32_t(i));
  }
  for (const auto& band : members) {
    band_begin_.push_back(std::uint32_t(segments_.size()));
    for (const std::uint32_t i : band) segments_.push_back(all[i]);
  }
  band_begin_.push_back(std::uint32_t(segments_.size()));
}

bool PolygonTrim::contains(double u, double v) const {
  if (segments_.empty()) return false;
  glm::dvec2 p{u, v};
  for (int axis = 0; axis < 2; ++axis) {
    if (!(periods_[axis] > 0)) continue;
    const double from_low = p[axis] - low_[axis] + kMargin * extent_[axis];
    p[axis] -= periods_[axis] * std::floor(from_low / periods_[axis]);
  }
  return contains_normalized((p - low_) / extent_);
}

bool PolygonTrim::contains_normalized(glm::dvec2 p) const {
  if (!(p.x >= -kMargin && p.x <= 1 + kMargin && p.y >= -kMargin && p.y <= 1 + kMargin)) return false;
  const auto band = std::size_t(std::clamp(std::floor(p.y * bands_), 0.0, bands_ - 1));
  const std::span<const Segment> candidates(segments_.data() + band_begin_[band],
                                            segments_.data() + band_begin_[band + 1]);
  bool inside = false;
  for (const Segment& s : candidates) {
    if ((s.a.y > p.y) == (s.b.y > p.y)) continue;
    if (p.x < s.a.x + (p.y - s.a.y) / (s.b.y - s.a.y) * (s.b.x - s.a.x)) inside = !inside;
  }
  if (inside) return true;
  return std::ranges::any_of(candidates,
                             [&](const Segment& s) { return distance_to_chord(p, s.a, s.b) <= kMargin; });
}

}  // namespace catoptra::cad_import
