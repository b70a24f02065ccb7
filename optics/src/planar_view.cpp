#include "optics/planar_view.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "optics/refraction.h"

namespace catoptra::optics {
namespace {

// Twice the area of a triangle over the product of two of its sides, below which its corners are in line.
constexpr double kInLine = 1e-12;

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

glm::dmat3 adjoint(const glm::dmat3& m) {
  return glm::determinant(m) * glm::inverse(m);
}

/// The plane's normal on the side of the eye.
glm::dvec3 towards(const Plane& plane, const glm::dvec3& eye_mm) {
  return plane.height_mm(eye_mm) < 0 ? -plane.normal : plane.normal;
}

}  // namespace

double Plane::height_mm(const glm::dvec3& point) const {
  return glm::dot(point - point_mm, normal);
}

ProjectiveView mirrored(const ProjectiveView& view, const Plane& plane) {
  const glm::dmat3 reflection = glm::dmat3(1) - 2.0 * glm::outerProduct(plane.normal, plane.normal);
  return {view.eye_mm - 2 * plane.height_mm(view.eye_mm) * plane.normal, view.image * reflection};
}

ProjectiveView through(const ProjectiveView& view, const Plane& plane, const glm::dvec3& eye_mm) {
  // On the plane n (q - eye') is the same everywhere, so that q - eye = (q - eye') + (eye' - eye) is a linear
  // map of q - eye'.
  const glm::dvec3 moved = eye_mm - view.eye_mm;
  return {eye_mm,
          view.image * (glm::dmat3(1) + glm::outerProduct(moved, plane.normal / -plane.height_mm(eye_mm)))};
}

std::optional<glm::dvec3> refracted_eye(const glm::dvec3& eye_mm, const glm::dvec3& at_mm, const Plane& plane,
                                        double eta, RefractedEye place) {
  const double distance = glm::distance(eye_mm, at_mm);
  const auto direction = refract((at_mm - eye_mm) / distance, towards(plane, eye_mm), eta);
  if (!direction) return std::nullopt;
  return at_mm - distance * (place == RefractedEye::sagittal ? 1 / eta : 1.0) * *direction;
}

double plate_shift_mm(double thickness_mm, double ior, double cos_theta_i) {
  const double sin_squared = 1 - cos_theta_i * cos_theta_i;
  return thickness_mm * (1 - cos_theta_i / std::sqrt(ior * ior - sin_squared));
}

bool totally_reflected(const glm::dvec3& eye_mm, const glm::dvec3& at_mm, const Plane& plane, double eta) {
  return !refract(glm::normalize(at_mm - eye_mm), towards(plane, eye_mm), eta);
}

std::optional<glm::dmat3> square_to_quad(const Quad& quad) {
  const auto& [p0, p1, p2, p3] = quad;
  const glm::dvec2 d1 = p1 - p2, d2 = p3 - p2, sum = p0 - p1 + p2 - p3;
  for (int k = 0; k < 4; ++k) {
    const glm::dvec2 before = quad[std::size_t(k + 3) % 4] - quad[std::size_t(k)],
                     after = quad[std::size_t(k + 1) % 4] - quad[std::size_t(k)];
    if (!(std::abs(cross(before, after)) > kInLine * glm::length(before) * glm::length(after)))
      return std::nullopt;
  }
  const double determinant = cross(d1, d2);
  const double g = cross(sum, d2) / determinant, h = cross(d1, sum) / determinant;
  return glm::dmat3(glm::dvec3(p1 - p0 + g * p1, g), glm::dvec3(p3 - p0 + h * p3, h), glm::dvec3(p0, 1));
}

std::optional<glm::dmat3> quad_to_quad(const Quad& from, const Quad& to) {
  const auto of_from = square_to_quad(from), of_to = square_to_quad(to);
  if (!of_from || !of_to) return std::nullopt;
  return *of_to * adjoint(*of_from);
}

}  // namespace catoptra::optics
