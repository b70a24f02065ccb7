#include "tessellate/refined_mesh.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <tuple>

#include "tessellate/src/edge_use.h"
#include "tessellate/src/exact_vertex.h"

namespace catoptra::tessellate {
namespace {

std::array<std::uint32_t, 2> sorted(std::uint32_t a, std::uint32_t b) {
  return a < b ? std::array{a, b} : std::array{b, a};
}

/// For each vertex the first one at the same place: at a crease every face has a vertex of its own there.
std::vector<std::uint32_t> weld(const OpticArrays& mesh) {
  std::map<std::array<double, 3>, std::uint32_t> first;
  std::vector<std::uint32_t> welded;
  welded.reserve(mesh.vertices.size());
  for (const auto& v : mesh.vertices)
    welded.push_back(first
                         .try_emplace({v.position_mm.x, v.position_mm.y, v.position_mm.z},
                                      static_cast<std::uint32_t>(welded.size()))
                         .first->second);
  return welded;
}

}  // namespace

RefinedMesh::RefinedMesh(std::span<const cad_import::Face> faces, const OpticArrays& base)
    : faces_(faces.begin(), faces.end()), base_(base), base_welded_(weld(base)), nodes_(base.vertices) {
  restart();
}

void RefinedMesh::restart() {
  mesh_.vertices = base_.vertices;
  welded_ = base_welded_;
  node_of_.resize(base_.vertices.size());
  std::iota(node_of_.begin(), node_of_.end(), 0u);
  parents_.clear();
  triangles_.clear();
  for (const OpticTriangle& triangle : base_.triangles) triangles_.push_back({triangle, {}});
  for (const OpticBorder& border : base_.borders)
    triangles_[border.triangle].curves[border.side] = {border.cad_edge, border.t_from, border.t_to};
  publish_triangles();
  find_new_edges();
}

void RefinedMesh::publish_triangles() {
  mesh_.triangles.clear();
  for (const Triangle& triangle : triangles_) mesh_.triangles.push_back(triangle.shape);
}

RefinedMesh::Side RefinedMesh::make_side(std::uint32_t index, std::uint8_t side) const {
  const Triangle& triangle = triangles_[index];
  const std::size_t from = side, to = (from + 1) % 3;
  const auto a = triangle.shape.vertices[from], b = triangle.shape.vertices[to];
  Side made{sorted(welded_[a], welded_[b]),
            sorted(a, b),
            triangle.shape.face,
            0.5 * (triangle.shape.uv[from] + triangle.shape.uv[to]),
            index,
            side};
  const Curve& curve = triangle.curves[from];
  if (curve.cad_edge < 0) return made;
  const cad_import::EdgeUse* use = find_use(faces_[static_cast<std::size_t>(made.face)], curve.cad_edge,
                                            curve.t_to, triangle.shape.uv[to]);
  if (use) made.uv = use->curve->uv(0.5 * (curve.t_from + curve.t_to));
  return made;
}

void RefinedMesh::find_new_edges() {
  new_sides_.clear();
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for (std::uint8_t side = 0; side < 3; ++side)
      if (triangles_[t].open[side]) new_sides_.push_back(make_side(t, side));
  // Sides of one edge together; which comes first, and so places the middle, depends on the surface alone.
  std::sort(new_sides_.begin(), new_sides_.end(), [](const Side& a, const Side& b) {
    return std::tie(a.welded, a.face, a.uv.x, a.uv.y, a.triangle, a.side) <
           std::tie(b.welded, b.face, b.uv.x, b.uv.y, b.triangle, b.side);
  });
  new_edges_.clear();
  edge_of_.clear();
  for (auto begin = new_sides_.begin(); begin != new_sides_.end();) {
    const auto end =
        std::find_if(begin, new_sides_.end(), [&](const Side& s) { return s.welded != begin->welded; });
    add_group({begin, end});
    begin = end;
  }
}

void RefinedMesh::add_group(std::span<Side> sides) {
  const std::size_t first = new_edges_.size();
  const std::uint32_t group = first == 0 ? 0 : new_edges_.back().group + 1;
  for (Side& side : sides) {
    // Inside a face both triangles must take the same parameters, also where their corners at a pole differ.
    const Side& leading = sides.front();
    if (side.face == leading.face && triangles_[side.triangle].curves[side.side].cad_edge < 0)
      side.uv = leading.uv;
    const auto known = std::find_if(new_edges_.begin() + std::ptrdiff_t(first), new_edges_.end(),
                                    [&](const EdgeMiddle& edge) { return edge.ends == side.ends; });
    edge_of_.push_back(static_cast<std::uint32_t>(known - new_edges_.begin()));
    if (known != new_edges_.end()) continue;
    const std::uint32_t node = node_between(side, first < new_edges_.size() ? new_edges_[first].node : kNone);
    new_edges_.push_back({side.ends, node, group});
  }
}

std::uint32_t RefinedMesh::node_between(const Side& side, std::uint32_t first_of_group) {
  const auto [a, b] = sorted(node_of_[side.ends[0]], node_of_[side.ends[1]]);
  const auto [place, is_new] = node_.try_emplace(std::uint64_t(a) << 32 | b, 0);
  if (!is_new) return place->second;
  const auto& face = faces_[static_cast<std::size_t>(side.face)];
  const glm::dvec3 position = first_of_group == kNone ? face.surface->point(side.uv.x, side.uv.y)
                                                      : nodes_[first_of_group].position_mm;
  place->second = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back(exact_vertex(face, side.face, side.uv, position));
  return place->second;
}

void RefinedMesh::split(std::span<const char> wanted) {
  std::vector<std::uint32_t> vertex_of_edge(new_edges_.size(), kNone);
  add_vertices(wanted, vertex_of_edge);
  std::vector<std::array<Middle, 3>> middles(triangles_.size(),
                                             {Middle{kNone, {}}, Middle{kNone, {}}, Middle{kNone, {}}});
  for (std::size_t i = 0; i < new_sides_.size(); ++i)
    middles[new_sides_[i].triangle][new_sides_[i].side] = {vertex_of_edge[edge_of_[i]], new_sides_[i].uv};
  std::vector<Triangle> cut_triangles;
  cut_triangles.reserve(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) cut(triangles_[t], middles[t], cut_triangles);
  triangles_ = std::move(cut_triangles);
  publish_triangles();
  find_new_edges();
}

void RefinedMesh::add_vertices(std::span<const char> wanted, std::vector<std::uint32_t>& vertex_of_edge) {
  for (std::size_t begin = 0; begin < new_edges_.size();) {
    std::size_t end = begin;
    bool split = false;
    for (; end < new_edges_.size() && new_edges_[end].group == new_edges_[begin].group; ++end)
      split = split || wanted[end] != 0;
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (; begin < end; ++begin) {
      if (!split) continue;
      const EdgeMiddle& edge = new_edges_[begin];
      vertex_of_edge[begin] = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(nodes_[edge.node]);
      parents_.push_back(edge.ends);
      node_of_.push_back(edge.node);
      welded_.push_back(first);
    }
  }
}

void RefinedMesh::cut(const Triangle& triangle, const std::array<Middle, 3>& middles,
                      std::vector<Triangle>& into) const {
  // Places 0 to 2 are the corners, 3 + k the middle of side k.
  const auto is_cut = [&](std::size_t side) { return middles[side % 3].vertex != kNone; };
  const auto vertex = [&](std::size_t place) {
    return place < 3 ? triangle.shape.vertices[place] : middles[place - 3].vertex;
  };
  const auto curve_between = [&](std::size_t from, std::size_t to) -> Curve {
    for (std::size_t k = 0; k < 3; ++k) {
      const Curve& c = triangle.curves[k];
      const double middle = 0.5 * (c.t_from + c.t_to);
      if (from == k && to == (k + 1) % 3) return c;
      if (from == k && to == 3 + k) return {c.cad_edge, c.t_from, middle};
      if (from == 3 + k && to == (k + 1) % 3) return {c.cad_edge, middle, c.t_to};
    }
    return {};
  };
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    Triangle part{triangle.shape, {}};
    const std::array places{a, b, c};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t from = places[k], to = places[(k + 1) % 3];
      part.shape.vertices[k] = vertex(from);
      part.shape.uv[k] = from < 3 ? triangle.shape.uv[from] : middles[from - 3].uv;
      part.curves[k] = curve_between(from, to);
      part.open[k] = from >= 3 || to >= 3;
    }
    into.push_back(part);
  };
  const auto distance = [&](std::size_t a, std::size_t b) {
    return glm::distance(mesh_.vertices[vertex(a)].position_mm, mesh_.vertices[vertex(b)].position_mm);
  };
  const int cuts = is_cut(0) + is_cut(1) + is_cut(2);
  if (cuts == 0) return add(0, 1, 2);
  if (cuts == 3) {
    for (std::size_t k = 0; k < 3; ++k) add(k, 3 + k, 3 + (k + 2) % 3);
    return add(3, 4, 5);
  }
  std::size_t k = 0;  // the side that is cut alone, or the first of two that follow each other
  while (!is_cut(k) || (cuts == 2 && !is_cut(k + 1))) ++k;
  const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
  if (cuts == 1) {
    add(k, 3 + k, last);
    return add(3 + k, next, last);
  }
  add(3 + k, next, 3 + next);
  // The shorter diagonal of what remains; a difference by rounding alone decides nothing.
  constexpr double kRounding = 1e-9;
  if (distance(3 + k, last) <= (1 + kRounding) * distance(k, 3 + next)) {
    add(k, 3 + k, last);
    add(3 + k, 3 + next, last);
  } else {
    add(k, 3 + k, 3 + next);
    add(k, 3 + next, last);
  }
}

}  // namespace catoptra::tessellate
