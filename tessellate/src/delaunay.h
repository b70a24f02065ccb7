// Constrained Delaunay triangulation in the plane, exact: coordinates are snapped to a grid of 2^26 steps
// over the larger side of the box, so that every predicate is computed in integers without rounding.
//
// Points are inserted one by one and edges flipped (Lawson 1977); border edges are forced by flipping what
// crosses them (Sloan 1993).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

namespace catoptra::tessellate {

class Delaunay {
 public:
  /// A triangle of the triangulation, counter-clockwise. Neighbour and border k lie opposite vertex k.
  struct Triangle {
    std::array<int, 3> vertex{-1, -1, -1};
    std::array<int, 3> neighbour{-1, -1, -1};
    std::array<std::uint8_t, 3> border{0, 0, 0};  ///< how often the edge was made a border
    bool inside = false;                          ///< set by mark_inside()
    bool fresh = true;                            ///< changed since the caller last cleared it
  };

  /// All points must lie in the box [min, max].
  Delaunay(const glm::dvec2& min, const glm::dvec2& max);

  /// The number of the vertex at `p` (0, 1, 2, ...): that of an earlier point where both snap to the same
  /// place. Nullopt where the point lies on a border edge.
  std::optional<int> insert(const glm::dvec2& p);

  /// The same, but only for a point inside as mark_inside() found: nullopt elsewhere.
  std::optional<int> insert_inside(const glm::dvec2& p);

  /// Makes (a, b) an edge that stays. False where it would cross another border or run through a vertex.
  [[nodiscard]] bool add_border(int a, int b);

  /// Marks what an odd number of borders separates from outside. False where the borders do not close.
  [[nodiscard]] bool mark_inside();

  [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }
  [[nodiscard]] const Triangle& triangle(std::size_t t) const { return triangles_[t]; }
  void clear_fresh(std::size_t t) { triangles_[t].fresh = false; }

  /// The vertices of a triangle inside, as insert() numbered them.
  [[nodiscard]] std::array<int, 3> corners(std::size_t t) const {
    const auto& v = triangles_[t].vertex;
    return {v[0] - kOuter, v[1] - kOuter, v[2] - kOuter};
  }

 private:
  struct Point {
    std::int64_t x, y;
    friend bool operator==(const Point&, const Point&) = default;
  };

  static constexpr int kOuter = 3;  ///< vertices of the enclosing triangle come first, hidden from the caller

  [[nodiscard]] Point snap(const glm::dvec2& p) const;
  [[nodiscard]] const Point& at(int vertex) const { return points_[static_cast<std::size_t>(vertex)]; }
  [[nodiscard]] Triangle& tri(int t) { return triangles_[static_cast<std::size_t>(t)]; }
  [[nodiscard]] const Triangle& tri(int t) const { return triangles_[static_cast<std::size_t>(t)]; }
  [[nodiscard]] int locate(const Point& p) const;
  std::optional<int> insert(const Point& point, int t);
  [[nodiscard]] std::size_t side_towards(int triangle, int neighbour) const;

  void link(int triangle, std::size_t side, int neighbour, int old_triangle);
  void split_triangle(int t, int vertex);
  void split_edge(int t, std::size_t side, int vertex);
  void flip(int t, std::size_t side);
  void legalise();
  void push_edges(int t);
  [[nodiscard]] bool should_flip(int t, std::size_t side) const;
  [[nodiscard]] bool convex(int t, std::size_t side) const;
  [[nodiscard]] std::optional<std::pair<int, std::size_t>> find_edge(int a, int b) const;
  [[nodiscard]] bool clear_way(int a, int b);

  glm::dvec2 min_;
  double scale_;
  std::vector<Point> points_;
  std::vector<Triangle> triangles_;
  std::vector<int> triangle_at_;                       ///< per vertex: one of its triangles
  std::vector<std::pair<int, std::size_t>> suspects_;  ///< edges to look at again
  mutable int last_ = 0;                               ///< where the last search ended
};

}  // namespace catoptra::tessellate
