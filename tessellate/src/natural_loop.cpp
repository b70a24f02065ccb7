// Loops for faces that come without any: the parameter rectangle, its seams and its poles.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "tessellate/src/border.h"

namespace catoptra::tessellate {
namespace {

using cad_import::EdgeUse;
using cad_import::ExactSurface;
using cad_import::Face;
using cad_import::ParameterDomain;

constexpr double kSamePoint = 1e-9;  // of the surface's size: closed, or degenerate

/// The straight line in (u, v) from `begin` (t = 0) to `end` (t = 1).
class ParameterLine : public cad_import::TrimCurve {
 public:
  ParameterLine(std::shared_ptr<const ExactSurface> surface, glm::dvec2 begin, glm::dvec2 end)
      : surface_(std::move(surface)), begin_(begin), end_(end) {}
  glm::dvec2 uv(double t) const override { return begin_ * (1 - t) + end_ * t; }
  glm::dvec3 point(double t) const override {
    const glm::dvec2 p = uv(t);
    return surface_->point(p.x, p.y);
  }

 private:
  std::shared_ptr<const ExactSurface> surface_;
  glm::dvec2 begin_, end_;
};

/// Numbers for edges and vertices that have none.
struct Numbers {
  int next_edge = 0, next_vertex = 0;

  explicit Numbers(std::span<const Face> faces) {
    for (const auto& face : faces)
      for (const auto& loop : face.loops)
        for (const auto& use : loop.edges) {
          next_edge = std::max(next_edge, use.edge + 1);
          next_vertex = std::max({next_vertex, use.start_vertex + 1, use.end_vertex + 1});
        }
  }
};

bool closed(const ExactSurface& surface, const glm::dvec2& a0, const glm::dvec2& a1, const glm::dvec2& b0,
            const glm::dvec2& b1, double size) {
  for (const double x : {0.0, 0.3, 0.6, 1.0}) {
    const glm::dvec2 a = a0 + x * (a1 - a0), b = b0 + x * (b1 - b0);
    if (glm::distance(surface.point(a.x, a.y), surface.point(b.x, b.y)) > kSamePoint * size) return false;
  }
  return true;
}

cad_import::TrimLoop natural_loop(const std::shared_ptr<const ExactSurface>& surface, Numbers& numbers) {
  const ParameterDomain d = surface->domain();
  const std::array<glm::dvec2, 4> corner{
      glm::dvec2(d.u_min, d.v_min), {d.u_max, d.v_min}, {d.u_max, d.v_max}, {d.u_min, d.v_max}};
  const glm::dvec3 centre = surface->point(0.5 * (d.u_min + d.u_max), 0.5 * (d.v_min + d.v_max));
  double size = 0;
  for (const auto& c : corner) size = std::max(size, glm::distance(centre, surface->point(c.x, c.y)));

  const bool closed_u = closed(*surface, corner[0], corner[3], corner[1], corner[2], size);
  const bool closed_v = closed(*surface, corner[0], corner[1], corner[3], corner[2], size);
  const bool pole_bottom = closed(*surface, corner[0], corner[1], corner[0], corner[0], size);
  const bool pole_top = closed(*surface, corner[3], corner[2], corner[3], corner[3], size);
  const bool pole_left = closed(*surface, corner[0], corner[3], corner[0], corner[0], size);
  const bool pole_right = closed(*surface, corner[1], corner[2], corner[1], corner[1], size);

  std::array<int, 4> vertex{};
  for (auto& v : vertex) v = numbers.next_vertex++;
  const auto join = [&](std::size_t a, std::size_t b) {
    const int from = vertex[b], to = vertex[a];
    std::replace(vertex.begin(), vertex.end(), from, to);
  };
  if (closed_u || pole_bottom) join(0, 1);
  if (closed_u || pole_top) join(3, 2);
  if (closed_v || pole_left) join(0, 3);
  if (closed_v || pole_right) join(1, 2);

  cad_import::TrimLoop loop;
  const std::array<bool, 4> pole{pole_bottom, pole_right, pole_top, pole_left};
  for (std::size_t side = 0; side < 4; ++side) {
    const std::size_t end = (side + 1) % 4;
    EdgeUse use;
    use.start_vertex = vertex[side];
    use.end_vertex = vertex[end];
    use.degenerate = pole[side];
    // The second use of a seam runs against the first, along the same edge.
    use.seam = !use.degenerate && (side % 2 == 0 ? closed_v : closed_u);
    use.reversed = use.seam && side >= 2;
    use.edge = use.reversed ? loop.edges[side - 2].edge : numbers.next_edge++;
    use.curve = use.reversed ? std::make_shared<ParameterLine>(surface, corner[end], corner[side])
                             : std::make_shared<ParameterLine>(surface, corner[side], corner[end]);
    loop.edges.push_back(std::move(use));
  }
  return loop;
}

void number(cad_import::TrimLoop& loop, Numbers& numbers) {
  for (std::size_t i = 0; i < loop.edges.size(); ++i) {
    EdgeUse& use = loop.edges[i];
    EdgeUse& next = loop.edges[(i + 1) % loop.edges.size()];
    if (use.edge < 0) use.edge = numbers.next_edge++;
    if (use.end_vertex < 0)
      use.end_vertex = next.start_vertex >= 0 ? next.start_vertex : numbers.next_vertex++;
    if (next.start_vertex < 0) next.start_vertex = use.end_vertex;
  }
}

}  // namespace

std::vector<Face> with_complete_loops(std::span<const Face> faces) {
  Numbers numbers(faces);
  std::vector<Face> result(faces.begin(), faces.end());
  for (auto& face : result) {
    if (face.loops.empty() && face.surface) face.loops.push_back(natural_loop(face.surface, numbers));
    for (auto& loop : face.loops) number(loop, numbers);
  }
  return result;
}

}  // namespace catoptra::tessellate
