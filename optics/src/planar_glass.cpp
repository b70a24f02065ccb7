#include "optics/planar_glass.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::optics {

PlanarFace planar_face(const Optic& optic) {
  const auto& vertices = optic.mesh.vertices;
  PlanarFace face;
  if (vertices.empty()) return face;
  face.normal = glm::normalize(vertices[0].normal);
  // Relative to a vertex, so that a face far from the origin loses nothing.
  const glm::dvec3 origin = vertices[0].position_mm;
  glm::dvec3 moment(0);
  double area = 0;
  for (const auto& triangle : optic.mesh.triangles) {
    const glm::dvec3 a = vertices[triangle.vertices[0]].position_mm - origin,
                     b = vertices[triangle.vertices[1]].position_mm - origin,
                     c = vertices[triangle.vertices[2]].position_mm - origin;
    const double twice = glm::length(glm::cross(b - a, c - a));
    moment += twice / 3 * (a + b + c);
    area += twice;
  }
  face.centre_mm = area > 0 ? origin + moment / area : origin;
  const glm::dvec3 edge =
      optic.material.first_edge - glm::dot(optic.material.first_edge, face.normal) * face.normal;
  const glm::dvec3 other = std::abs(face.normal.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  face.along =
      glm::length(edge) > 1e-6 ? glm::normalize(edge) : glm::normalize(glm::cross(face.normal, other));
  face.across = glm::cross(face.normal, face.along);
  return face;
}

glm::dvec3 tilted_normal(const PlanarFace& face, const glm::dvec2& tilt_rad) {
  return glm::normalize(face.normal + std::tan(tilt_rad.x) * face.along + std::tan(tilt_rad.y) * face.across);
}

double plate_reflectance(double border) {
  return 2 * border / (1 + border);
}

glm::dvec3 plate_shift(const glm::dvec3& d, const glm::dvec3& normal, double ior, double thickness_mm) {
  const double cosine = std::abs(glm::dot(d, normal));
  const glm::dvec3 along = d - glm::dot(d, normal) * normal;  // sin a e
  return -thickness_mm * (1 / cosine - 1 / std::sqrt(ior * ior - 1 + cosine * cosine)) * along;
}

double fog_share(double translucency, double way_mm) {
  constexpr double kPerMetre = 1e-3;
  if (!(translucency > 0)) return 0;
  return 1 - std::pow(1 - translucency, kPerMetre * way_mm);
}

}  // namespace catoptra::optics
