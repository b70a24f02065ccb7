#include "optics/mirror_glass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <tuple>

#include "cad_import/error.h"
#include "optics/exact_hit.h"
#include "optics/vertex_hits.h"

namespace catoptra::optics {
namespace {

using Corner = std::tuple<double, double, double>;

Corner corner_at(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

struct AreaCenter {
  glm::dvec3 center{0}, normal{0};
  std::size_t nearest_vertex = 0;
};

AreaCenter center_of_area(const Optic& mirror) {
  AreaCenter result;
  double area = 0;
  for (const auto& triangle : mirror.mesh.triangles) {
    const auto& a = mirror.mesh.vertices[triangle.vertices[0]].position_mm;
    const auto& b = mirror.mesh.vertices[triangle.vertices[1]].position_mm;
    const auto& c = mirror.mesh.vertices[triangle.vertices[2]].position_mm;
    const glm::dvec3 twice = glm::cross(b - a, c - a);
    result.normal += twice;
    result.center += glm::length(twice) * (a + b + c) / 3.0;
    area += glm::length(twice);
  }
  result.center /= area;
  result.normal = reflecting_normal(mirror, glm::normalize(result.normal));
  double nearest = kInfinity;
  for (std::size_t i = 0; i < mirror.mesh.vertices.size(); ++i) {
    const double distance = glm::distance(mirror.mesh.vertices[i].position_mm, result.center);
    if (distance < nearest) {
      nearest = distance;
      result.nearest_vertex = i;
    }
  }
  return result;
}

/// Edges that one triangle alone has, chained; creases repeat vertices, so corners are known by their
/// position.
std::vector<std::vector<glm::dvec3>> border_chains(const tessellate::OpticArrays& mesh) {
  std::map<std::pair<Corner, Corner>, int> uses;
  const auto position = [&](std::uint32_t v) { return mesh.vertices[v].position_mm; };
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      ++uses[{corner_at(position(triangle.vertices[k])),
              corner_at(position(triangle.vertices[(k + 1) % 3]))}];
  std::multimap<Corner, Corner> next;
  for (const auto& [edge, count] : uses)
    if (!uses.contains({edge.second, edge.first})) next.insert(edge);
  std::vector<std::vector<glm::dvec3>> chains;
  while (!next.empty()) {
    std::vector<glm::dvec3> chain;
    for (auto link = next.begin(); link != next.end();) {
      const auto [x, y, z] = link->first;
      chain.emplace_back(x, y, z);
      const Corner end = link->second;
      next.erase(link);
      link = next.find(end);
    }
    chains.push_back(std::move(chain));
  }
  return chains;
}

double length_of(const std::vector<glm::dvec3>& chain) {
  double sum = 0;
  for (std::size_t i = 0; i < chain.size(); ++i)
    sum += glm::distance(chain[i], chain[(i + 1) % chain.size()]);
  return sum;
}

}  // namespace

MirrorGlass::MirrorGlass(const Optic& mirror, const glm::dvec3& up) : optic_(mirror) {
  if (mirror.kind != OpticKind::mirror) throw Error("", mirror.name, "is no mirror");
  if (mirror.mesh.triangles.empty()) throw Error("", mirror.name, "has no surface");
  const AreaCenter area = center_of_area(mirror);
  const auto& start = mirror.mesh.vertices[area.nearest_vertex];
  const Ray line{area.center, area.normal, -kInfinity, kInfinity};
  const auto& faces = optic_.faces;
  const auto hit = newton_hit(*faces[std::size_t(start.face)].surface, line, start.uv);
  // A glass with a hole in its middle: the nearest vertex stands in.
  const GlassPoint center = hit ? place(start.face, hit->uv) : place(start.face, start.uv);
  frame_.center_mm = center.surface.point;
  frame_.normal = center.normal;
  frame_.across = glm::cross(up, frame_.normal);
  if (glm::length(frame_.across) < 1e-6 * glm::length(up))
    frame_.across = glm::cross(std::abs(frame_.normal.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0),
                               frame_.normal);
  frame_.across = glm::normalize(frame_.across);
  frame_.upward = glm::cross(frame_.normal, frame_.across);

  borders_ = border_chains(optic_.mesh);
  std::stable_sort(borders_.begin(), borders_.end(),
                   [](const auto& a, const auto& b) { return length_of(a) > length_of(b); });
  low_ = glm::dvec2(kInfinity);
  high_ = glm::dvec2(-kInfinity);
  for (const auto& border : borders_) {
    outlines_.emplace_back();
    for (const glm::dvec3& point : border) outlines_.back().push_back(frame_xy(point));
  }
  for (const auto& vertex : optic_.mesh.vertices) {
    const glm::dvec2 xy = frame_xy(vertex.position_mm);
    low_ = {std::min(low_.x, xy.x), std::min(low_.y, xy.y)};
    high_ = {std::max(high_.x, xy.x), std::max(high_.y, xy.y)};
  }
}

glm::dvec2 MirrorGlass::frame_xy(const glm::dvec3& point_mm) const {
  const glm::dvec3 offset = point_mm - frame_.center_mm;
  return {glm::dot(offset, frame_.across), glm::dot(offset, frame_.upward)};
}

GlassPoint MirrorGlass::place(int face, const glm::dvec2& uv) const {
  const cad_import::ExactSurface& surface = *optic_.faces[std::size_t(face)].surface;
  GlassPoint point;
  point.face = face;
  point.uv = uv;
  point.surface = surface.d2(uv.x, uv.y);
  point.normal = reflecting_normal(optic_, surface.unit_normal(uv.x, uv.y));
  point.curvatures = surface.principal_curvatures(uv.x, uv.y);
  if (optic_.flip) {  // seen from the other side: signs and order turn round
    const auto other = point.curvatures;
    point.curvatures = {-other.k2, -other.k1, other.direction2, other.direction1};
  }
  point.xy_mm = frame_xy(point.surface.point);
  return point;
}

bool MirrorGlass::on_glass(int face, const glm::dvec2& uv) const {
  const cad_import::Face& known = optic_.faces[std::size_t(face)];
  const auto domain = known.surface->domain();
  const auto inside = [](double x, double low, double high, double period) {
    const double slack = 1e-9 * (high - low);
    return period > 0 || (x >= low - slack && x <= high + slack);
  };
  return inside(uv.x, domain.u_min, domain.u_max, domain.u_period) &&
         inside(uv.y, domain.v_min, domain.v_max, domain.v_period) &&
         (!known.trim || known.trim->contains(uv.x, uv.y));
}

std::optional<glm::dvec2> MirrorGlass::nearest_vertex(int face, const glm::dvec2& xy) const {
  std::optional<glm::dvec2> uv;
  double nearest = kInfinity;
  for (const auto& triangle : optic_.mesh.triangles) {
    if (triangle.face != face) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const double distance =
          glm::distance(frame_xy(optic_.mesh.vertices[triangle.vertices[k]].position_mm), xy);
      if (distance < nearest) {
        nearest = distance;
        uv = triangle.uv[k];
      }
    }
  }
  return uv;
}

std::optional<GlassPoint> MirrorGlass::meet_face(int face, const Ray& line, const glm::dvec2& start) const {
  const auto hit = newton_hit(*optic_.faces[std::size_t(face)].surface, line, start);
  if (!hit || !on_glass(face, hit->uv)) return std::nullopt;
  return place(face, hit->uv);
}

std::optional<GlassPoint> MirrorGlass::at(const glm::dvec2& xy_mm) const {
  const Ray line{frame_.center_mm + xy_mm.x * frame_.across + xy_mm.y * frame_.upward, frame_.normal,
                 -kInfinity, kInfinity};
  for (int face = 0; face < int(optic_.faces.size()); ++face)
    if (const auto start = nearest_vertex(face, xy_mm))
      if (auto point = meet_face(face, line, *start)) return point;
  return std::nullopt;
}

std::optional<GlassPoint> MirrorGlass::meet(const glm::dvec3& origin_mm, const glm::dvec3& direction,
                                            const GlassPoint& near) const {
  const Ray line{origin_mm, direction, -kInfinity, kInfinity};
  if (auto point = meet_face(near.face, line, near.uv)) return point;
  for (int face = 0; face < int(optic_.faces.size()); ++face) {
    if (face == near.face) continue;
    if (const auto start = nearest_vertex(face, frame_xy(origin_mm)))
      if (auto point = meet_face(face, line, *start)) return point;
  }
  return std::nullopt;
}

}  // namespace catoptra::optics
