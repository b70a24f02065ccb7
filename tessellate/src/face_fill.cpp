#include "tessellate/src/face_fill.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tessellate/src/delaunay.h"
#include "tessellate/src/deviation.h"

namespace catoptra::tessellate {
namespace {

using cad_import::Face;

constexpr double kClosed =
    0.02;  // of the face's rectangle: gap between the ends of successive edges in (u, v)
constexpr double kClearance = 0.45;  // cells between grid points and border: nearer ones would make slivers
constexpr int kRounds = 12;          // of refinement; each halves the edges that are too far off

/// A vertex of the triangulation.
struct Node {
  int vertex = -1;  ///< in the draft; -1: inside the face, not yet there
  glm::dvec2 uv;
  glm::dvec3 position_mm;  ///< on this face's surface
};

class Filler {
 public:
  Filler(const Face& face, int face_index, const Borders& borders, const FaceSizing& sizing,
         const StepLimits& limits, MeshDraft& draft)
      : face_(face), index_(face_index), borders_(borders), sizing_(sizing), limits_(limits), draft_(draft) {}

  std::string run() {
    if (std::string reason = read_loops(); !reason.empty()) return reason;
    UvBox box;
    for (const auto& polygon : cells_)
      for (const auto& p : polygon) box.add(p);
    Delaunay plane(box.min, box.max);
    if (std::string reason = insert_border(plane); !reason.empty()) return reason;
    insert_grid(plane);
    refine(plane);
    return emit(plane) ? "" : "its border encloses no area";
  }

 private:
  std::string read_loops() {
    const glm::dvec2 allowed = kClosed * sizing_.box.extent();
    for (const auto& loop : face_.loops) {
      std::vector<LoopPoint> polygon;
      glm::dvec2 last{0}, first{0};
      for (const auto& use : loop.edges) {
        const auto points = borders_.points(use);
        const glm::dvec2 gap = glm::abs(points.front().uv - last);
        if (polygon.empty())
          first = points.front().uv;
        else if (gap.x > allowed.x || gap.y > allowed.y)
          return "its border has a gap in (u, v)";
        polygon.insert(polygon.end(), points.begin(), points.end() - 1);
        last = points.back().uv;
      }
      const glm::dvec2 gap = glm::abs(first - last);
      if (gap.x > allowed.x || gap.y > allowed.y) return "its border does not close in (u, v)";
      if (polygon.size() < 3) return "a loop of its border has fewer than three points";
      std::vector<glm::dvec2> cells;
      for (const auto& p : polygon) cells.push_back(sizing_.to_cells(p.uv));
      cells_.push_back(std::move(cells));
      loops_.push_back(std::move(polygon));
    }
    return "";
  }

  std::string insert_border(Delaunay& plane) {
    std::vector<std::vector<int>> numbers(loops_.size());
    for (std::size_t l = 0; l < loops_.size(); ++l)
      for (std::size_t k = 0; k < loops_[l].size(); ++k) {
        const LoopPoint& p = loops_[l][k];
        const int number = plane.insert(cells_[l][k]).value();
        numbers[l].push_back(number);
        if (static_cast<std::size_t>(number) == nodes_.size()) {
          const auto& vertex = draft_.vertices[static_cast<std::size_t>(p.vertex)];
          // Another face's surface may be off by the file's tolerance, which no refinement could mend.
          const glm::dvec3 on_surface =
              vertex.face == index_ ? vertex.position_mm : face_.surface->point(p.uv.x, p.uv.y);
          nodes_.push_back({p.vertex, p.uv, on_surface});
        } else if (nodes_[static_cast<std::size_t>(number)].vertex != p.vertex) {
          return "two points of its border coincide in (u, v)";
        }
      }
    for (const auto& loop : numbers)
      for (std::size_t k = 0; k < loop.size(); ++k)
        if (!plane.add_border(loop[k], loop[(k + 1) % loop.size()]))
          return "its border crosses itself in (u, v)";
    return plane.mark_inside() ? "" : "its border does not close in (u, v)";
  }

  /// Crossings of the loops with the line of constant second cell coordinate, sorted.
  std::vector<double> crossings(double y) const {
    std::vector<double> result;
    for (const auto& polygon : cells_)
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2& a = polygon[k];
        const glm::dvec2& b = polygon[(k + 1) % polygon.size()];
        if ((a.y > y) != (b.y > y)) result.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
      }
    std::sort(result.begin(), result.end());
    return result;
  }

  void insert_grid(Delaunay& plane) {
    const double columns = std::max(1.0, std::ceil(sizing_.u.cells() - 1e-6)),
                 rows = std::max(1.0, std::ceil(sizing_.v.cells() - 1e-6));
    const glm::dvec2 step{sizing_.u.cells() / columns, sizing_.v.cells() / rows};
    const auto width = static_cast<std::size_t>(columns) + 1, height = static_cast<std::size_t>(rows) + 1;
    const std::vector<char> blocked = block_near_border(width, height, step);
    for (std::size_t j = 1; j + 1 < height; ++j) {
      const double y = static_cast<double>(j) * step.y;
      const std::vector<double> crossing = crossings(y);
      std::size_t passed = 0;
      for (std::size_t i = 1; i + 1 < width; ++i) {
        const double x = static_cast<double>(i) * step.x;
        while (passed < crossing.size() && crossing[passed] < x) ++passed;
        if (passed % 2 == 0 || blocked[j * width + i]) continue;
        insert_inside(plane, {sizing_.u.to_parameter(x), sizing_.v.to_parameter(y)}, {x, y});
      }
    }
  }

  std::vector<char> block_near_border(std::size_t width, std::size_t height, const glm::dvec2& step) const {
    std::vector<char> blocked(width * height, 0);
    const auto block = [&](const glm::dvec2& p) {
      for (double j = std::ceil((p.y - kClearance) / step.y); j <= (p.y + kClearance) / step.y; ++j)
        for (double i = std::ceil((p.x - kClearance) / step.x); i <= (p.x + kClearance) / step.x; ++i)
          if (i >= 0 && j >= 0 && i < static_cast<double>(width) && j < static_cast<double>(height) &&
              glm::distance(p, glm::dvec2(i, j) * step) < kClearance)
            blocked[static_cast<std::size_t>(j) * width + static_cast<std::size_t>(i)] = 1;
    };
    for (const auto& polygon : cells_)
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
        const double pieces = std::ceil(glm::distance(a, b) / (0.5 * kClearance));
        for (double piece = 0; piece < pieces; ++piece) block(a + (b - a) * (piece / pieces));
      }
    return blocked;
  }

  void insert_inside(Delaunay& plane, const glm::dvec2& uv, const glm::dvec2& cells) {
    const auto number = plane.insert_inside(cells);
    if (number && static_cast<std::size_t>(*number) == nodes_.size())
      nodes_.push_back({-1, uv, face_.surface->point(uv.x, uv.y)});
  }

  /// Parameters in triangle `t` where the mesh is too far from the surface: middles of edges, or else the
  /// centre.
  void find_faults(const Delaunay& plane, std::size_t t, std::vector<glm::dvec2>& faults) const {
    const auto& triangle = plane.triangle(t);
    const auto corner = plane.corners(t);
    const auto node = [&](std::size_t k) -> const Node& {
      return nodes_[static_cast<std::size_t>(corner[k])];
    };
    bool edge_fault = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Node &a = node((k + 1) % 3), &b = node((k + 2) % 3);
      const auto neighbour = static_cast<std::size_t>(triangle.neighbour[k]);
      const bool counted = neighbour < t && plane.triangle(neighbour).fresh;
      if (triangle.border[k] || counted) continue;
      const glm::dvec2 uv = 0.5 * (a.uv + b.uv);
      if (chord_share(*face_.surface, uv, 0.5 * (a.position_mm + b.position_mm), limits_) <= 1) continue;
      faults.push_back(uv);
      edge_fault = true;
    }
    if (edge_fault) return;
    const glm::dvec2 uv = (node(0).uv + node(1).uv + node(2).uv) / 3.0;
    const glm::dvec3 flat = (node(0).position_mm + node(1).position_mm + node(2).position_mm) / 3.0;
    if (chord_share(*face_.surface, uv, flat, limits_) > 1) faults.push_back(uv);
  }

  void refine(Delaunay& plane) {
    if (limits_.chord_mm == kUnlimited) return;
    for (int round = 0; round < kRounds; ++round) {
      std::vector<glm::dvec2> faults;
      for (std::size_t t = 0; t < plane.triangle_count(); ++t)
        if (plane.triangle(t).inside && plane.triangle(t).fresh) find_faults(plane, t, faults);
      for (std::size_t t = 0; t < plane.triangle_count(); ++t) plane.clear_fresh(t);
      if (faults.empty()) return;
      for (const auto& uv : faults) insert_inside(plane, uv, sizing_.to_cells(uv));
    }
  }

  bool emit(const Delaunay& plane) {
    for (auto& node : nodes_)
      if (node.vertex < 0) node.vertex = draft_.add({node.position_mm, index_, node.uv});
    const bool reversed = face_.surface->orientation() < 0;
    bool any = false;
    for (std::size_t t = 0; t < plane.triangle_count(); ++t) {
      if (!plane.triangle(t).inside) continue;
      auto corner = plane.corners(t);
      if (reversed) std::swap(corner[1], corner[2]);
      DraftTriangle triangle{{}, index_, {}};
      for (std::size_t k = 0; k < 3; ++k) {
        const Node& node = nodes_[static_cast<std::size_t>(corner[k])];
        triangle.vertices[k] = node.vertex;
        triangle.uv[k] = node.uv;
      }
      const auto& v = triangle.vertices;
      // At a pole two corners are one point: the triangle is an edge.
      if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
      draft_.triangles.push_back(triangle);
      any = true;
    }
    return any;
  }

  const Face& face_;
  int index_;
  const Borders& borders_;
  const FaceSizing& sizing_;
  const StepLimits& limits_;
  MeshDraft& draft_;
  std::vector<std::vector<LoopPoint>> loops_;
  std::vector<std::vector<glm::dvec2>> cells_;  ///< the same points in cells
  std::vector<Node> nodes_;                     ///< by the triangulation's numbers
};

}  // namespace

std::string fill_face(const Face& face, int face_index, const Borders& borders, const FaceSizing& sizing,
                      const StepLimits& limits, MeshDraft& draft) {
  return Filler(face, face_index, borders, sizing, limits, draft).run();
}

}  // namespace catoptra::tessellate
