// The outline of a planar optic as convex pieces.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "cad_import/error.h"
#include "optics/light_path.h"

namespace catoptra::optics {
namespace {

/// How far a mesh may leave its plane, over its size.
constexpr double kFlatness = 1e-5;
/// Sine of the angle by which a corner may be concave: rounding.
constexpr double kConvexity = 1e-9;

using Corners = std::vector<std::uint32_t>;  // indices of mesh vertices, counter-clockwise from the front

/// Whether the corner a, b, c turns left (or goes straight on) as seen from the front.
bool is_convex(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& normal) {
  const glm::dvec3 e = b - a, f = c - b;
  return glm::dot(glm::cross(e, f), normal) >= -kConvexity * glm::length(e) * glm::length(f);
}

/// The two polygons joined at side `side` of `a`, which is side `other` of `b` the other way round.
Corners joined(const Corners& a, std::size_t side, const Corners& b, std::size_t other) {
  Corners result;
  for (std::size_t k = 1; k <= a.size(); ++k) result.push_back(a[(side + k) % a.size()]);
  for (std::size_t k = 2; k < b.size(); ++k) result.push_back(b[(other + k) % b.size()]);
  return result;
}

class PieceMaker {
 public:
  PieceMaker(const tessellate::OpticArrays& mesh, const glm::dvec3& normal) : mesh_(mesh), normal_(normal) {}

  /// Joins triangles greedily as long as what results is convex (after Hertel and Mehlhorn, 1983: at most
  /// four times the least number of pieces).
  [[nodiscard]] std::vector<ConvexPolygon> pieces() const {
    std::vector<Corners> parts;
    for (const auto& t : mesh_.triangles) {
      Corners part{t.vertices[0], t.vertices[1], t.vertices[2]};
      while (join_one(parts, part)) {
      }
      parts.push_back(std::move(part));
    }
    std::vector<ConvexPolygon> result;
    for (const Corners& part : parts) {
      ConvexPolygon& piece = result.emplace_back();
      for (const std::uint32_t corner : part) piece.push_back(at(corner));
    }
    return result;
  }

 private:
  const glm::dvec3& at(std::uint32_t vertex) const { return mesh_.vertices[vertex].position_mm; }

  /// Joins one of `parts`, which it takes out, with `part`.
  bool join_one(std::vector<Corners>& parts, Corners& part) const {
    for (auto candidate = parts.begin(); candidate != parts.end(); ++candidate)
      for (std::size_t i = 0; i < part.size(); ++i)
        for (std::size_t j = 0; j < candidate->size(); ++j) {
          const Corners& b = *candidate;
          if (part[i] != b[(j + 1) % b.size()] || part[(i + 1) % part.size()] != b[j]) continue;
          Corners both = joined(part, i, b, j);
          if (!is_convex_polygon(both)) continue;
          part = std::move(both);
          parts.erase(candidate);
          return true;
        }
    return false;
  }

  bool is_convex_polygon(const Corners& c) const {
    const std::size_t n = c.size();
    for (std::size_t i = 0; i < n; ++i)
      if (!is_convex(at(c[i]), at(c[(i + 1) % n]), at(c[(i + 2) % n]), normal_)) return false;
    return true;
  }

  const tessellate::OpticArrays& mesh_;
  glm::dvec3 normal_;
};

[[noreturn]] void refuse(const Optic& optic, const char* reason) {
  throw Error("", optic.name, reason, "a planar optic is one flat face");
}

/// Sets centroid and normal from the mesh's triangles.
void set_plane(const Optic& optic, LightFace& face) {
  glm::dvec3 area(0), moment(0);
  double weight = 0, size = 0;
  const auto& vertices = optic.mesh.vertices;
  if (vertices.empty()) refuse(optic, "has no mesh");
  for (const auto& t : optic.mesh.triangles) {
    const glm::dvec3 &a = vertices[t.vertices[0]].position_mm, &b = vertices[t.vertices[1]].position_mm,
                     &c = vertices[t.vertices[2]].position_mm;
    const glm::dvec3 part = glm::cross(b - a, c - a);
    const double share = glm::length(part);
    area += part;
    moment += share / 3 * (a + b + c);
    weight += share;
  }
  if (!(weight > 0) || !(glm::length(area) > 0)) refuse(optic, "has no area");
  face.normal = glm::normalize(area) * (optic.flip ? -1.0 : 1.0);
  face.centroid_mm = moment / weight;
  for (const auto& v : vertices) size = std::max(size, glm::distance(v.position_mm, face.centroid_mm));
  for (const auto& v : vertices)
    if (std::abs(glm::dot(v.position_mm - face.centroid_mm, face.normal)) > kFlatness * size)
      refuse(optic, "is not flat");
}

}  // namespace

std::vector<LightFace> light_faces(std::span<const Optic> optics) {
  std::vector<LightFace> faces;
  for (std::size_t i = 0; i < optics.size(); ++i) {
    const Optic& optic = optics[i];
    if (!optic.planar) continue;
    LightFace face;
    face.optic = i;
    face.kind = optic.kind;
    set_plane(optic, face);
    face.pieces = PieceMaker(optic.mesh, optic.flip ? -face.normal : face.normal).pieces();
    face.one_sided = optic.kind == OpticKind::mirror ? !optic.two_sided : optic.one_sided;
    face.reflectance = optic.reflectance;
    face.tint = optic.material.tint;
    face.ior = optic.material.ior;
    face.thickness_mm = optic.material.thickness_mm;
    faces.push_back(std::move(face));
  }
  return faces;
}

}  // namespace catoptra::optics
