// What every optic mesh must satisfy, checked from outside: by sampling the exact surfaces, not by asking the
// mesher.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <vector>

#include "tessellate/optic_mesh.h"

namespace catoptra::test {

using tessellate::HalfEdgeMesh;
using tessellate::OpticMesh;

inline glm::dvec3 position(const OpticMesh& optic, HalfEdgeMesh::VertexHandle vertex) {
  const auto& p = optic.half_edges().point(vertex);
  return {p[0], p[1], p[2]};
}

/// The greatest distance of any vertex from its face's surface at its own (u, v), mm.
inline double vertex_error_mm(const OpticMesh& optic) {
  double worst = 0;
  for (const auto vertex : optic.half_edges().vertices()) {
    const auto& v = optic.half_edges().data(vertex).exact;
    const auto& surface = *optic.faces()[static_cast<std::size_t>(v.face)].surface;
    worst = std::max({worst, glm::distance(v.position_mm, surface.point(v.uv.x, v.uv.y)),
                      glm::distance(v.position_mm, position(optic, vertex))});
  }
  return worst;
}

/// Distance of a point from a surface by Gauss-Newton from a start: the foot of the perpendicular.
inline double distance_to_surface_mm(const cad_import::ExactSurface& surface, glm::dvec2 uv,
                                     const glm::dvec3& point) {
  for (int step = 0; step < 12; ++step) {
    const auto f = surface.d1(uv.x, uv.y);
    const glm::dvec3 r = point - f.point;
    const double e = glm::dot(f.du, f.du), m = glm::dot(f.du, f.dv), g = glm::dot(f.dv, f.dv),
                 det = e * g - m * m;
    if (det <= 1e-14 * e * g) break;
    const double a = glm::dot(r, f.du), b = glm::dot(r, f.dv);
    uv += glm::dvec2((g * a - m * b) / det, (e * b - m * a) / det);
  }
  return glm::distance(surface.point(uv.x, uv.y), point);
}

/// The greatest distance of the middles and centres of the facets from their exact surface, mm.
inline double chord_error_mm(const OpticMesh& optic) {
  const auto arrays = optic.arrays();
  double worst = 0;
  for (const auto& t : arrays.triangles) {
    const auto& surface = *optic.faces()[static_cast<std::size_t>(t.face)].surface;
    const auto at = [&](double a, double b, double c) {
      const auto& v = arrays.vertices;
      const glm::dvec3 p = a * v[t.vertices[0]].position_mm + b * v[t.vertices[1]].position_mm +
                           c * v[t.vertices[2]].position_mm;
      return distance_to_surface_mm(surface, a * t.uv[0] + b * t.uv[1] + c * t.uv[2], p);
    };
    worst =
        std::max({worst, at(1 / 3.0, 1 / 3.0, 1 / 3.0), at(0.5, 0.5, 0), at(0, 0.5, 0.5), at(0.5, 0, 0.5)});
  }
  return worst;
}

/// Vertices - edges + triangles: 1 for a disc, 0 for an annulus, 2 for a sphere.
inline int euler_characteristic(const OpticMesh& optic) {
  const auto& m = optic.half_edges();
  return static_cast<int>(m.n_vertices()) - static_cast<int>(m.n_edges()) + static_cast<int>(m.n_faces());
}

/// Closed chains of half edges without a triangle.
inline int boundary_loops(const OpticMesh& optic) {
  const auto& m = optic.half_edges();
  std::set<int> seen;
  int loops = 0;
  for (const auto start : m.halfedges()) {
    if (!m.is_boundary(start) || seen.count(start.idx())) continue;
    ++loops;
    HalfEdgeMesh::HalfedgeHandle h = start;
    while (seen.insert(h.idx()).second) h = m.next_halfedge_handle(h);
  }
  return loops;
}

/// The least cosine between a triangle's geometric normal and the exact normals at its corners.
inline double least_normal_agreement(const OpticMesh& optic) {
  const auto arrays = optic.arrays();
  double least = 1;
  for (const auto& t : arrays.triangles) {
    const auto& a = arrays.vertices[t.vertices[0]];
    const auto& b = arrays.vertices[t.vertices[1]];
    const auto& c = arrays.vertices[t.vertices[2]];
    const glm::dvec3 n =
        glm::normalize(glm::cross(b.position_mm - a.position_mm, c.position_mm - a.position_mm));
    for (const auto* v : {&a, &b, &c}) least = std::min(least, glm::dot(n, v->normal));
  }
  return least;
}

/// Sum of the triangles' areas, mm^2.
inline double mesh_area_mm2(const OpticMesh& optic) {
  const auto arrays = optic.arrays();
  double area = 0;
  for (const auto& t : arrays.triangles) {
    const glm::dvec3 a = arrays.vertices[t.vertices[0]].position_mm;
    area += 0.5 * glm::length(glm::cross(arrays.vertices[t.vertices[1]].position_mm - a,
                                         arrays.vertices[t.vertices[2]].position_mm - a));
  }
  return area;
}

/// Pairs of vertices nearer to each other than `tolerance_mm`: cracks or duplicates.
inline int coincident_vertices(const OpticMesh& optic, double tolerance_mm) {
  std::vector<glm::dvec3> points;
  for (const auto vertex : optic.half_edges().vertices()) points.push_back(position(optic, vertex));
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size() && points[j].x - points[i].x <= tolerance_mm; ++j)
      if (glm::distance(points[i], points[j]) <= tolerance_mm) ++count;
  return count;
}

}  // namespace catoptra::test
