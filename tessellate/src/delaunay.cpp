#include "tessellate/src/delaunay.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace catoptra::tessellate {
namespace {

__extension__ typedef __int128 Int128;  // in_circle needs 120 bits

constexpr double kSteps = 67108864;  // 2^26
constexpr std::int64_t kFar =
    1LL << 28;  // the enclosing triangle; differences stay below 2^30: areas fit 64 bits

std::size_t next(std::size_t k) {
  return k == 2 ? 0 : k + 1;
}
std::size_t previous(std::size_t k) {
  return k == 0 ? 2 : k - 1;
}

/// Twice the signed area of (a, b, c): positive where it runs counter-clockwise.
template <class Point>
std::int64_t orient(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether d lies inside the circle through a, b, c (counter-clockwise).
template <class Point>
bool in_circle(const Point& a, const Point& b, const Point& c, const Point& d) {
  const std::int64_t ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x,
                     cy = c.y - d.y;
  const Int128 det = Int128(ax * ax + ay * ay) * (bx * cy - by * cx) +
                     Int128(bx * bx + by * by) * (cx * ay - cy * ax) +
                     Int128(cx * cx + cy * cy) * (ax * by - ay * bx);
  return det > 0;
}

}  // namespace

Delaunay::Delaunay(const glm::dvec2& min, const glm::dvec2& max) : min_(min) {
  const double size = std::max(max.x - min.x, max.y - min.y);
  scale_ = size > 0 ? kSteps / size : 1;
  points_ = {{-kFar, -kFar}, {kFar, -kFar}, {0, kFar}};
  triangles_.push_back({{0, 1, 2}, {-1, -1, -1}, {0, 0, 0}, false, true});
  triangle_at_ = {0, 0, 0};
}

Delaunay::Point Delaunay::snap(const glm::dvec2& p) const {
  // The box's centre lies near the enclosing triangle's, where that is widest.
  return {std::llround((p.x - min_.x) * scale_) - (1LL << 25),
          std::llround((p.y - min_.y) * scale_) - (1LL << 26)};
}

int Delaunay::locate(const Point& p) const {
  int t = last_;
  // Each step crosses an edge that separates the triangle from p. Starting at a different edge every time
  // keeps the walk from circling, which it could in a triangulation that borders make other than Delaunay.
  const std::size_t most_steps = 16 + 4 * triangles_.size();
  for (std::size_t step = 0; step < most_steps; ++step) {
    const Triangle& triangle = tri(t);
    int onward = -1;
    for (std::size_t i = 0; i < 3 && onward < 0; ++i) {
      const std::size_t k = (i + step) % 3;
      if (orient(at(triangle.vertex[next(k)]), at(triangle.vertex[previous(k)]), p) < 0)
        onward = triangle.neighbour[k];
    }
    if (onward < 0) return last_ = t;
    t = onward;
  }
  const auto holds = [&](const Triangle& triangle) {
    for (std::size_t k = 0; k < 3; ++k)
      if (orient(at(triangle.vertex[next(k)]), at(triangle.vertex[previous(k)]), p) < 0) return false;
    return true;
  };
  return last_ =
             static_cast<int>(std::find_if(triangles_.begin(), triangles_.end(), holds) - triangles_.begin());
}

std::size_t Delaunay::side_towards(int triangle, int neighbour) const {
  const auto& n = tri(triangle).neighbour;
  return n[0] == neighbour ? 0 : n[1] == neighbour ? 1 : 2;
}

std::optional<int> Delaunay::insert(const glm::dvec2& p) {
  const Point point = snap(p);
  return insert(point, locate(point));
}

std::optional<int> Delaunay::insert_inside(const glm::dvec2& p) {
  const Point point = snap(p);
  const int t = locate(point);
  return tri(t).inside ? insert(point, t) : std::nullopt;
}

std::optional<int> Delaunay::insert(const Point& point, int t) {
  const Triangle& found = tri(t);
  std::size_t on_side = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    if (at(found.vertex[k]) == point) return found.vertex[k] - kOuter;
    if (orient(at(found.vertex[next(k)]), at(found.vertex[previous(k)]), point) == 0) on_side = k;
  }
  if (on_side < 3 && found.border[on_side]) return std::nullopt;
  const auto vertex = static_cast<int>(points_.size());
  points_.push_back(point);
  triangle_at_.push_back(t);
  if (on_side < 3)
    split_edge(t, on_side, vertex);
  else
    split_triangle(t, vertex);
  legalise();
  return vertex - kOuter;
}

/// Joins side `side` of `triangle` with `neighbour`, which was joined with `old_triangle` there.
void Delaunay::link(int triangle, std::size_t side, int neighbour, int old_triangle) {
  tri(triangle).neighbour[side] = neighbour;
  if (neighbour >= 0) tri(neighbour).neighbour[side_towards(neighbour, old_triangle)] = triangle;
}

void Delaunay::push_edges(int t) {
  Triangle& triangle = tri(t);
  triangle.fresh = true;
  for (std::size_t k = 0; k < 3; ++k) {
    triangle_at_[static_cast<std::size_t>(triangle.vertex[k])] = t;
    suspects_.emplace_back(t, k);
  }
}

void Delaunay::split_triangle(int t, int vertex) {
  const Triangle old = tri(t);
  const auto first = static_cast<int>(triangles_.size());
  const std::array<int, 3> part{t, first, first + 1};
  triangles_.resize(triangles_.size() + 2);
  // Part k keeps the old side k; its vertex 0 is the new one.
  for (std::size_t k = 0; k < 3; ++k) {
    Triangle& p = tri(part[k]);
    p.vertex = {vertex, old.vertex[next(k)], old.vertex[previous(k)]};
    p.neighbour = {old.neighbour[k], part[next(k)], part[previous(k)]};
    p.border = {old.border[k], 0, 0};
    p.inside = old.inside;
  }
  for (std::size_t k = 1; k < 3; ++k) link(part[k], 0, old.neighbour[k], t);
  for (const int p : part) push_edges(p);
}

void Delaunay::split_edge(int t, std::size_t side, int vertex) {
  const int u = tri(t).neighbour[side];
  const Triangle a = tri(t), b = tri(u);
  const std::size_t other = side_towards(u, t);
  const auto a2 = static_cast<int>(triangles_.size()), b2 = a2 + 1;
  triangles_.resize(triangles_.size() + 2);
  // a = (apex, p, q) with the edge p-q; b = (foot, q, p).
  const int apex = a.vertex[side], p = a.vertex[next(side)], q = a.vertex[previous(side)],
            foot = b.vertex[other];
  tri(t) = {{vertex, apex, p},
            {a.neighbour[previous(side)], b2, a2},
            {a.border[previous(side)], 0, 0},
            a.inside,
            true};
  tri(a2) = {
      {vertex, q, apex}, {a.neighbour[next(side)], t, u}, {a.border[next(side)], 0, 0}, a.inside, true};
  tri(u) = {{vertex, foot, q},
            {b.neighbour[previous(other)], a2, b2},
            {b.border[previous(other)], 0, 0},
            b.inside,
            true};
  tri(b2) = {
      {vertex, p, foot}, {b.neighbour[next(other)], u, t}, {b.border[next(other)], 0, 0}, b.inside, true};
  link(a2, 0, a.neighbour[next(side)], t);
  link(b2, 0, b.neighbour[next(other)], u);
  for (const int part : {t, a2, u, b2}) push_edges(part);
}

/// Replaces the edge opposite vertex `side` of `t` by the other diagonal of the two triangles.
void Delaunay::flip(int t, std::size_t side) {
  const int u = tri(t).neighbour[side];
  const Triangle a = tri(t), b = tri(u);
  const std::size_t other = side_towards(u, t);
  const int apex = a.vertex[side], p = a.vertex[next(side)], q = a.vertex[previous(side)],
            foot = b.vertex[other];
  // a = (apex, p, q), b = (foot, q, p) become (apex, p, foot) and (foot, q, apex).
  tri(t) = {{apex, p, foot},
            {b.neighbour[next(other)], u, a.neighbour[previous(side)]},
            {b.border[next(other)], 0, a.border[previous(side)]},
            a.inside,
            true};
  tri(u) = {{foot, q, apex},
            {a.neighbour[next(side)], t, b.neighbour[previous(other)]},
            {a.border[next(side)], 0, b.border[previous(other)]},
            b.inside,
            true};
  link(t, 0, b.neighbour[next(other)], u);
  link(u, 0, a.neighbour[next(side)], t);
  for (const int v : {apex, p, foot}) triangle_at_[static_cast<std::size_t>(v)] = t;
  triangle_at_[static_cast<std::size_t>(q)] = u;
}

bool Delaunay::should_flip(int t, std::size_t side) const {
  const Triangle& triangle = tri(t);
  const int u = triangle.neighbour[side];
  if (u < 0 || triangle.border[side]) return false;
  const int foot = tri(u).vertex[side_towards(u, t)];
  return in_circle(at(triangle.vertex[0]), at(triangle.vertex[1]), at(triangle.vertex[2]), at(foot));
}

void Delaunay::legalise() {
  while (!suspects_.empty()) {
    const auto [t, side] = suspects_.back();
    suspects_.pop_back();
    if (!should_flip(t, side)) continue;
    const int u = tri(t).neighbour[side];
    flip(t, side);
    push_edges(t);
    push_edges(u);
  }
}

bool Delaunay::convex(int t, std::size_t side) const {
  const Triangle& a = tri(t);
  const int u = a.neighbour[side];
  const Point& apex = at(a.vertex[side]);
  const Point& foot = at(tri(u).vertex[side_towards(u, t)]);
  return orient(apex, at(a.vertex[next(side)]), foot) > 0 &&
         orient(foot, at(a.vertex[previous(side)]), apex) > 0;
}

/// The triangle and side of the edge from a to b, seen from the left.
std::optional<std::pair<int, std::size_t>> Delaunay::find_edge(int a, int b) const {
  if (a < kOuter) {  // nothing goes all round these: look from the other end
    const auto seen_from_right = find_edge(b, a);
    if (!seen_from_right) return std::nullopt;
    const int left = tri(seen_from_right->first).neighbour[seen_from_right->second];
    return std::pair{left, side_towards(left, seen_from_right->first)};
  }
  const int start = triangle_at_[static_cast<std::size_t>(a)];
  int t = start;
  do {  // counter-clockwise around a, which the enclosing triangle surrounds
    const Triangle& triangle = tri(t);
    const std::size_t k = triangle.vertex[0] == a ? 0 : triangle.vertex[1] == a ? 1 : 2;
    if (triangle.vertex[next(k)] == b) return std::pair{t, previous(k)};
    t = triangle.neighbour[next(k)];
  } while (t != start);
  return std::nullopt;
}

bool Delaunay::add_border(int a, int b) {
  a += kOuter;
  b += kOuter;
  if (a == b) return true;
  if (!find_edge(a, b) && !clear_way(a, b)) return false;
  const auto [t, side] = *find_edge(a, b);
  const int u = tri(t).neighbour[side];
  ++tri(t).border[side];
  ++tri(u).border[side_towards(u, t)];
  legalise();
  return true;
}

/// Flips every edge that crosses the segment from a to b (Sloan 1993).
bool Delaunay::clear_way(int a, int b) {
  std::deque<std::pair<int, int>> crossing;  // edges by their vertices: flips renumber sides
  std::vector<int> touched;
  const Point pa = at(a), pb = at(b);
  int t = triangle_at_[static_cast<std::size_t>(a)];
  const int start = t;
  // The triangle at a through whose opposite side the segment leaves.
  while (true) {
    const Triangle& triangle = tri(t);
    const std::size_t k = triangle.vertex[0] == a ? 0 : triangle.vertex[1] == a ? 1 : 2;
    const int right = triangle.vertex[next(k)], left = triangle.vertex[previous(k)];
    if (orient(pa, pb, at(right)) < 0 && orient(pa, pb, at(left)) > 0) break;
    t = triangle.neighbour[next(k)];
    if (t == start) return false;  // the segment runs along an edge: through a vertex
  }
  for (std::size_t k = tri(t).vertex[0] == a ? 0 : tri(t).vertex[1] == a ? 1 : 2;;) {
    const Triangle& triangle = tri(t);
    if (triangle.border[k]) return false;
    crossing.emplace_back(triangle.vertex[next(k)], triangle.vertex[previous(k)]);
    const int u = triangle.neighbour[k];
    const std::size_t entry = side_towards(u, t);
    const int ahead = tri(u).vertex[entry];
    if (ahead == b) break;
    const std::int64_t sense = orient(pa, pb, at(ahead));
    if (sense == 0) return false;
    // Seen along the segment, next(entry) lies to the left of it. Leave between `ahead` and the vertex
    // across.
    k = sense > 0 ? next(entry) : previous(entry);
    t = u;
  }
  // Sloan's loop ends by itself; the bound only turns a mistake in that proof into an error message.
  for (std::size_t left = 64 + crossing.size() * crossing.size() * 8; !crossing.empty(); --left) {
    if (left == 0) return false;
    const auto [p, q] = crossing.front();
    crossing.pop_front();
    const auto edge = find_edge(p, q);
    if (!convex(edge->first, edge->second)) {
      crossing.emplace_back(p, q);
      continue;
    }
    const int u = tri(edge->first).neighbour[edge->second];
    flip(edge->first, edge->second);
    const int from = tri(edge->first).vertex[0], to = tri(u).vertex[0];
    const bool crosses = from != a && from != b && to != a && to != b &&
                         (orient(pa, pb, at(from)) > 0) != (orient(pa, pb, at(to)) > 0);
    if (crosses) crossing.emplace_back(from, to);
    touched.push_back(edge->first);
    touched.push_back(u);
  }
  for (const int changed : touched) push_edges(changed);  // for legalise(), once the border is marked as such
  return find_edge(a, b).has_value();
}

bool Delaunay::mark_inside() {
  std::vector<int> state(triangles_.size(), -1);  // number of borders crossed, modulo 2
  std::vector<int> stack{triangle_at_[0]};
  state[static_cast<std::size_t>(stack.front())] = 0;
  bool consistent = true;
  while (!stack.empty()) {
    const int t = stack.back();
    stack.pop_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const int u = tri(t).neighbour[k];
      if (u < 0) continue;
      const int beyond = (state[static_cast<std::size_t>(t)] + tri(t).border[k]) % 2;
      int& there = state[static_cast<std::size_t>(u)];
      if (there < 0) {
        there = beyond;
        stack.push_back(u);
      } else if (there != beyond) {
        consistent = false;
      }
    }
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t) triangles_[t].inside = state[t] == 1;
  return consistent;
}

}  // namespace catoptra::tessellate
