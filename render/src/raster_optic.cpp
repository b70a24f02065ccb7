#include "render/src/raster_optic.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace catoptra::render {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

struct Vertex {
  glm::vec3 position, normal;
};

double radius_about(const tessellate::OpticArrays& mesh, const glm::dvec3& center) {
  double radius = 0;
  for (const auto& vertex : mesh.vertices)
    radius = std::max(radius, glm::distance(vertex.position_mm, center));
  return radius;
}

/// Of all triangles, or those that belong to one triangle alone.
std::vector<std::uint32_t> unique_edges(const tessellate::OpticArrays& mesh, bool borders) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangle.vertices[k], triangle.vertices[(k + 1) % 3]);
      edges.emplace_back(a, b);
    }
  std::sort(edges.begin(), edges.end());
  std::vector<std::uint32_t> indices;
  indices.reserve(2 * edges.size());
  for (auto edge = edges.begin(); edge != edges.end();) {
    const auto next = std::find_if(edge, edges.end(), [&](const Edge& e) { return e != *edge; });
    if (!borders || next == edge + 1) {
      indices.push_back(edge->first);
      indices.push_back(edge->second);
    }
    edge = next;
  }
  return indices;
}

/// For each vertex the first one at the same place: at a crease every face has a vertex of its own there.
std::vector<std::uint32_t> weld(const tessellate::OpticArrays& mesh) {
  std::map<std::array<double, 3>, std::uint32_t> first;
  std::vector<std::uint32_t> welded;
  welded.reserve(mesh.vertices.size());
  for (const auto& v : mesh.vertices) {
    const std::array<double, 3> key{v.position_mm.x, v.position_mm.y, v.position_mm.z};
    welded.push_back(first.emplace(key, static_cast<std::uint32_t>(welded.size())).first->second);
  }
  return welded;
}

/// Triangles that continue the surface beyond its border.
std::vector<Vertex> make_skirt(const tessellate::OpticArrays& mesh, const glm::dvec3& center) {
  const std::vector<std::uint32_t> welded = weld(mesh);
  std::map<Edge, Edge> border;  // sorted edge -> the edge as its only triangle runs through it
  for (const auto& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Edge directed{welded[triangle.vertices[k]], welded[triangle.vertices[(k + 1) % 3]]};
      const Edge sorted = std::minmax(directed.first, directed.second);
      if (!border.emplace(sorted, directed).second) border.erase(sorted);
    }
  const double width = radius_about(mesh, center);
  // The outward direction at a vertex is the mean over its border edges, so that the skirt has no gap at
  // corners.
  std::map<std::uint32_t, glm::dvec3> outward;
  for (const auto& [sorted, edge] : border) {
    const auto &a = mesh.vertices[edge.first], &b = mesh.vertices[edge.second];
    const glm::dvec3 across = glm::cross(b.position_mm - a.position_mm, a.normal + b.normal);
    const double length = glm::length(across);
    if (length == 0) continue;
    outward[edge.first] += across / length;
    outward[edge.second] += across / length;
  }
  const auto vertex = [&](std::uint32_t index, bool outer) {
    const auto& v = mesh.vertices[index];
    glm::dvec3 position = v.position_mm - center;
    const glm::dvec3 direction = outward[index] - glm::dot(outward[index], v.normal) * v.normal;
    if (outer && glm::length(direction) > 0) position += width * glm::normalize(direction);
    return Vertex{glm::vec3(position), glm::vec3(v.normal)};
  };
  std::vector<Vertex> skirt;
  for (const auto& [sorted, edge] : border)
    for (const auto& [index, outer] : std::array<std::pair<std::uint32_t, bool>, 6>{{{edge.first, false},
                                                                                     {edge.first, true},
                                                                                     {edge.second, true},
                                                                                     {edge.first, false},
                                                                                     {edge.second, true},
                                                                                     {edge.second, false}}})
      skirt.push_back(vertex(index, outer));
  return skirt;
}

GlVertexArray array_of(const GlBuffer& indices, const GlBuffer& vertices) {
  GlVertexArray array = make_vertex_array(indices);
  bind_attributes(array, 0, vertices, sizeof(Vertex), {{0, 3, 0}, {1, 3, sizeof(glm::vec3)}});
  return array;
}

}  // namespace

glm::dvec3 area_centroid(const tessellate::OpticArrays& mesh) {
  glm::dvec3 sum(0);
  double area = 0;
  for (const auto& triangle : mesh.triangles) {
    const auto& a = mesh.vertices[triangle.vertices[0]].position_mm;
    const auto& b = mesh.vertices[triangle.vertices[1]].position_mm;
    const auto& c = mesh.vertices[triangle.vertices[2]].position_mm;
    const double twice_area = glm::length(glm::cross(b - a, c - a));
    sum += twice_area * (a + b + c) / 3.0;
    area += twice_area;
  }
  return area > 0 ? sum / area : glm::dvec3(0);
}

RasterOptic::RasterOptic(const tessellate::OpticArrays& mesh, bool with_skirt)
    : center_mm_(area_centroid(mesh)) {
  std::vector<Vertex> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const auto& v : mesh.vertices)
    vertices.push_back({glm::vec3(v.position_mm - center_mm_), glm::vec3(v.normal)});
  std::vector<std::uint32_t> triangles;
  triangles.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    triangles.insert(triangles.end(), t.vertices.begin(), t.vertices.end());
  const std::vector<std::uint32_t> edges = unique_edges(mesh, false), borders = unique_edges(mesh, true);
  const std::vector<Vertex> skirt = with_skirt ? make_skirt(mesh, center_mm_) : std::vector<Vertex>();

  for (const Vertex& vertex : vertices) points_.push_back(vertex.position);
  for (const Vertex& vertex : skirt) points_.push_back(vertex.position);

  vertices_ = make_static_buffer(std::as_bytes(std::span(vertices)));
  map_coordinates_ = make_dynamic_buffer(vertices.size() * sizeof(glm::vec3));
  triangles_ = make_static_buffer(std::as_bytes(std::span(triangles)));
  edges_ = make_static_buffer(std::as_bytes(std::span(edges)));
  borders_ = make_static_buffer(std::as_bytes(std::span(borders)));
  skirt_vertices_ = make_static_buffer(std::as_bytes(std::span(skirt)));
  triangle_indices_ = static_cast<GLsizei>(triangles.size());
  part_begins_ = {0, triangle_indices_};
  edge_indices_ = static_cast<GLsizei>(edges.size());
  border_indices_ = static_cast<GLsizei>(borders.size());
  skirt_vertex_count_ = static_cast<GLsizei>(skirt.size());

  surface_array_ = make_array();
  bind_attributes(surface_array_, 1, map_coordinates_, sizeof(glm::vec3), {{2, 3, 0}});
  edge_array_ = array_of(edges_, vertices_);
  border_array_ = array_of(borders_, vertices_);
  skirt_array_ = array_of({}, skirt_vertices_);
}

double RasterOptic::farthest_mm(const RasterView& view) const {
  const glm::dvec3 ahead = placement_.own_direction(-glm::transpose(view.rotation)[2]);
  const glm::vec3 along(ahead);
  float farthest = -std::numeric_limits<float>::infinity();
  for (const glm::vec3& p : points_) farthest = std::max(farthest, glm::dot(p, along));
  return farthest + glm::dot(center_mm_ - placement_.own_point(view.origin_mm), ahead);
}

GlVertexArray RasterOptic::make_array() const {
  return array_of(triangles_, vertices_);
}

void RasterOptic::set_map_coordinates(std::span<const glm::dvec3> coordinates) {
  std::vector<glm::vec3> narrow;
  narrow.reserve(coordinates.size());
  for (const glm::dvec3& c : coordinates) narrow.emplace_back(c);
  update_buffer(map_coordinates_, std::as_bytes(std::span(narrow)));
}

void RasterOptic::draw_surface() const {
  glBindVertexArray(surface_array_.id());
  glDrawElements(GL_TRIANGLES, triangle_indices_, GL_UNSIGNED_INT, nullptr);
}

void RasterOptic::set_parts(std::span<const std::size_t> triangles) {
  part_begins_ = {0};
  for (const std::size_t count : triangles)
    part_begins_.push_back(part_begins_.back() + static_cast<GLsizei>(3 * count));
}

void RasterOptic::draw_part(std::size_t part, const GlVertexArray& array) const {
  glBindVertexArray(array.id());
  const GLsizei begin = part_begins_[part];
  glDrawElements(GL_TRIANGLES, part_begins_[part + 1] - begin, GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(std::size_t(begin) * sizeof(std::uint32_t)));
}

void RasterOptic::draw_edges() const {
  glBindVertexArray(edge_array_.id());
  glDrawElements(GL_LINES, edge_indices_, GL_UNSIGNED_INT, nullptr);
}

void RasterOptic::draw_borders() const {
  glBindVertexArray(border_array_.id());
  glDrawElements(GL_LINES, border_indices_, GL_UNSIGNED_INT, nullptr);
}

void RasterOptic::draw_surface_with_skirt() const {
  draw_surface();
  glBindVertexArray(skirt_array_.id());
  glDrawArrays(GL_TRIANGLES, 0, skirt_vertex_count_);
}

}  // namespace catoptra::render
