#include "optics/src/ray_differentials.h"

namespace catoptra::optics {
namespace {

// Change of the normal while the point moves by `d_point` on the surface: the shape operator.
glm::dvec3 normal_change(const LocalSurface& s, const glm::dvec3& d_point) {
  const glm::dvec3 direction2 = glm::cross(s.normal, s.direction1);
  return s.k1 * glm::dot(d_point, s.direction1) * s.direction1 +
         s.k2 * glm::dot(d_point, direction2) * direction2;
}

}  // namespace

RayDifferential arriving_differential(const Arrival& arrival, const glm::dvec3& normal) {
  const glm::dvec3& d = arrival.direction;
  const double cosine = glm::dot(d, normal);
  RayDifferential at;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 move{0};
    move[axis] = 1;
    at.direction[axis] = arrival.turn[axis];
    at.point[axis] = move - d * (normal[axis] / cosine);  // back into the tangent plane along the ray
  }
  return at;
}

RayDifferential transferred(const RayDifferential& ray, const glm::dvec3& direction, double length_mm,
                            const glm::dvec3& normal) {
  RayDifferential at = ray;
  const double cosine = glm::dot(direction, normal);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 moved = ray.point[axis] + length_mm * ray.direction[axis];
    at.point[axis] = moved - direction * (glm::dot(moved, normal) / cosine);
  }
  return at;
}

RayDifferential reflected(const RayDifferential& ray, const glm::dvec3& d, const LocalSurface& surface) {
  RayDifferential out = ray;
  const glm::dvec3& n = surface.normal;
  const double cosine = glm::dot(d, n);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 d_normal = normal_change(surface, ray.point[axis]);
    const double d_cosine = glm::dot(ray.direction[axis], n) + glm::dot(d, d_normal);
    out.direction[axis] = ray.direction[axis] - 2 * d_cosine * n - 2 * cosine * d_normal;
  }
  return out;
}

RayDifferential refracted(const RayDifferential& ray, const glm::dvec3& d, const glm::dvec3& out, double eta,
                          const LocalSurface& surface) {
  // out = eta d - mu n with mu = eta d.n - out.n; it holds for either sense of n.
  RayDifferential after = ray;
  const glm::dvec3& n = surface.normal;
  const double cos_in = glm::dot(d, n), cos_out = glm::dot(out, n);
  const double mu = eta * cos_in - cos_out, mu_slope = eta - eta * eta * cos_in / cos_out;
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 d_normal = normal_change(surface, ray.point[axis]);
    const double d_cosine = glm::dot(ray.direction[axis], n) + glm::dot(d, d_normal);
    after.direction[axis] = eta * ray.direction[axis] - mu * d_normal - mu_slope * d_cosine * n;
  }
  return after;
}

}  // namespace catoptra::optics
