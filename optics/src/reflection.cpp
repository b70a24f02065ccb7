#include "optics/reflection.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::optics {

glm::dvec3 reflect(const glm::dvec3& d, const glm::dvec3& n) {
  return glm::normalize(d - 2 * glm::dot(d, n) * n);
}

MirrorMagnification mirror_magnification(double eye_distance_mm, double radius_mm, double incidence_rad) {
  const double c = std::cos(incidence_rad);
  return {1 / (1 + 2 * eye_distance_mm / (radius_mm * c)), 1 / (1 + 2 * eye_distance_mm * c / radius_mm)};
}

}  // namespace catoptra::optics
