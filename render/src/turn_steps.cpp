#include "render/src/turn_steps.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::render {

double steps_to_turn(const glm::dvec3& by_x, const glm::dvec3& by_y, const glm::dvec3& wanted, double least) {
  // Singular values of the matrix (by_x, by_y), from the eigenvalues of its square.
  const double a = glm::dot(by_x, by_x), b = glm::dot(by_x, by_y), c = glm::dot(by_y, by_y);
  const double mean = 0.5 * (a + c), half = std::hypot(0.5 * (a - c), b);
  const double large = std::sqrt(mean + half), small = std::sqrt(std::max(0.0, mean - half));
  const double angle = 0.5 * std::atan2(2 * b, a - c);
  const glm::dvec3 along = std::cos(angle) * by_x + std::sin(angle) * by_y;
  const double most = large > 0 ? glm::dot(along, wanted) / large : 0;
  const double rest = std::sqrt(std::max(0.0, glm::dot(wanted, wanted) - most * most));
  return std::hypot(most / std::max(large, least), rest / std::max(small, least));
}

}  // namespace catoptra::render
