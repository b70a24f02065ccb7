#include "tessellate/src/face_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::tessellate {
namespace {

using cad_import::EdgeUse;
using cad_import::Face;

constexpr double kStraight = 1e-3;  // of the rectangle: how far a side may stray from constant u or v
constexpr int kSamples = 8;

/// The side (0: v_min, 1: u_max, 2: v_max, 3: u_min) that the use runs along, in the sense of the loop.
std::optional<std::size_t> side_of(const EdgeUse& use, const UvBox& box) {
  std::array<bool, 4> on{true, true, true, true};
  double last_u = 0, last_v = 0;
  bool u_rises = true, u_falls = true, v_rises = true, v_falls = true;
  const glm::dvec2 extent = box.extent();
  for (int k = 0; k <= kSamples; ++k) {
    const double x = static_cast<double>(use.reversed ? kSamples - k : k) / kSamples;
    const glm::dvec2 p = (use.curve->uv(use.t_begin + x * (use.t_end - use.t_begin)) - box.min) / extent;
    on[0] = on[0] && p.y < kStraight;
    on[1] = on[1] && p.x > 1 - kStraight;
    on[2] = on[2] && p.y > 1 - kStraight;
    on[3] = on[3] && p.x < kStraight;
    if (k > 0) {
      u_rises = u_rises && p.x > last_u;
      u_falls = u_falls && p.x < last_u;
      v_rises = v_rises && p.y > last_v;
      v_falls = v_falls && p.y < last_v;
    }
    last_u = p.x;
    last_v = p.y;
  }
  if (on[0] && u_rises) return 0;
  if (on[1] && v_rises) return 1;
  if (on[2] && u_falls) return 2;
  if (on[3] && v_falls) return 3;
  return std::nullopt;
}

struct GridPoint {
  int vertex = 0;
  glm::dvec2 uv;
};

/// Two triangles for a cell with corners counter-clockwise in (u, v), or one where a side has shrunk to a
/// pole.
void add_cell(const std::array<GridPoint, 4>& corner, int face, bool reversed, MeshDraft& draft) {
  const auto& p = draft.vertices;
  const auto at = [&](std::size_t k) { return p[static_cast<std::size_t>(corner[k].vertex)].position_mm; };
  // The shorter diagonal; 1e-9 keeps the pattern regular where both are equal but for rounding.
  const bool diagonal_02 = glm::distance(at(0), at(2)) <= glm::distance(at(1), at(3)) * (1 + 1e-9);
  const std::array<std::array<std::size_t, 3>, 2> split =
      diagonal_02 ? std::array<std::array<std::size_t, 3>, 2>{{{0, 1, 2}, {0, 2, 3}}}
                  : std::array<std::array<std::size_t, 3>, 2>{{{0, 1, 3}, {1, 2, 3}}};
  for (const auto& t : split) {
    DraftTriangle triangle{{corner[t[0]].vertex, corner[t[1]].vertex, corner[t[2]].vertex},
                           face,
                           {corner[t[0]].uv, corner[t[1]].uv, corner[t[2]].uv}};
    const auto& v = triangle.vertices;
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    // At a pole every parameter along the side is the same point: take the one in the middle of the cell.
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t k = 0; k < 4; ++k)
        if (k != t[a] && corner[k].vertex == v[a]) triangle.uv[a] = 0.5 * (corner[k].uv + corner[t[a]].uv);
    if (reversed) {
      std::swap(triangle.vertices[1], triangle.vertices[2]);
      std::swap(triangle.uv[1], triangle.uv[2]);
    }
    draft.triangles.push_back(triangle);
  }
}

}  // namespace

std::optional<GridSides> recognise_grid(const Face& face) {
  if (face.loops.size() != 1 || face.loops.front().edges.size() != 4) return std::nullopt;
  const UvBox box = loop_box(face);
  const glm::dvec2 extent = box.extent();
  if (!(extent.x > 0) || !(extent.y > 0)) return std::nullopt;
  GridSides sides{};
  for (const auto& use : face.loops.front().edges) {
    const auto side = side_of(use, box);
    if (!side || sides[*side]) return std::nullopt;
    sides[*side] = &use;
  }
  return sides;
}

void mesh_grid(const Face& face, int face_index, const GridSides& sides, const Borders& borders,
               MeshDraft& draft) {
  const auto bottom = borders.points(*sides[0]), right = borders.points(*sides[1]);
  auto top = borders.points(*sides[2]), left = borders.points(*sides[3]);
  std::reverse(top.begin(), top.end());
  std::reverse(left.begin(), left.end());
  const std::size_t columns = bottom.size(), rows = left.size();

  std::vector<GridPoint> grid(columns * rows);
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      GridPoint& point = grid[j * columns + i];
      const auto take = [&](const LoopPoint& p) { point = {p.vertex, p.uv}; };
      if (j == 0) {
        take(bottom[i]);
      } else if (j + 1 == rows) {
        take(top[i]);
      } else if (i == 0) {
        take(left[j]);
      } else if (i + 1 == columns) {
        take(right[j]);
      } else {
        // The crossing of the line that joins the cuts of the sides with the one that joins bottom and top.
        const double y = static_cast<double>(j) / static_cast<double>(rows - 1);
        const double x = static_cast<double>(i) / static_cast<double>(columns - 1);
        point.uv = {(1 - y) * bottom[i].uv.x + y * top[i].uv.x, (1 - x) * left[j].uv.y + x * right[j].uv.y};
        point.vertex = draft.add({face.surface->point(point.uv.x, point.uv.y), face_index, point.uv});
      }
    }
  const bool reversed = face.surface->orientation() < 0;
  for (std::size_t j = 0; j + 1 < rows; ++j)
    for (std::size_t i = 0; i + 1 < columns; ++i) {
      const std::size_t a = j * columns + i;
      add_cell({grid[a], grid[a + 1], grid[a + columns + 1], grid[a + columns]}, face_index, reversed, draft);
    }
}

}  // namespace catoptra::tessellate
