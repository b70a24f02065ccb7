// The least-squares viewpoint of a bundle of lines.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include "cad_import/error.h"
#include "optics/virtual_view.h"

namespace catoptra::optics {
namespace {

// Lines that spread by less than this (root mean square, rad) are parallel: their viewpoint would lie so far
// away that a parallel projection differs from a perspective one by less than 0.1 mm at 100 m.
constexpr double kParallelSpread = 1e-6;

}  // namespace

ViewpointFit fit_viewpoint(std::span<const glm::dvec3> points, std::span<const glm::dvec3> directions) {
  if (points.empty() || points.size() != directions.size())
    throw Error("", "virtual viewpoint", "needs as many directions as points, and one at least");
  const double n = static_cast<double>(points.size());
  glm::dvec3 centroid{0}, sum{0};
  for (const auto& p : points) centroid += p / n;
  for (const auto& d : directions) sum += d;
  if (glm::length(sum) < 1e-6 * n) sum = directions[0];  // a bundle into all directions has no mean
  const glm::dvec3 axis = glm::normalize(sum);
  const glm::dvec3 helper = std::abs(axis.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 e1 = glm::normalize(glm::cross(axis, helper)), e2 = glm::cross(axis, e1);

  // Normal equations sum (I - d d^T)(o - x) = 0 about the centroid, in the frame (e1, e2, axis). With d = (a,
  // b, c) the diagonal entry along the axis is a^2 + b^2, taken directly: as 1 - c^2 it would lose all digits
  // for narrow bundles.
  glm::dmat2 across{0};    // the block of e1, e2
  glm::dvec2 coupling{0};  // between that block and the axis
  glm::dvec2 across_right{0};
  double along = 0, along_right = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double a = glm::dot(directions[i], e1), b = glm::dot(directions[i], e2),
                 c = glm::dot(directions[i], axis);
    const glm::dvec3 offset = points[i] - centroid;
    const double x = glm::dot(offset, e1), y = glm::dot(offset, e2), z = glm::dot(offset, axis);
    const double transverse = a * x + b * y, d_dot_x = transverse + c * z;
    across += glm::dmat2(1 - a * a, -a * b, -a * b, 1 - b * b);
    coupling += glm::dvec2(-a * c, -b * c);
    across_right += glm::dvec2(x - a * d_dot_x, y - b * d_dot_x);
    along += a * a + b * b;
    along_right += (a * a + b * b) * z - c * transverse;
  }
  // Eliminating the block leaves one equation for the distance along the axis; its coefficient is the sum of
  // squared angles about the mean, so that it says whether there is a viewpoint at all.
  const glm::dmat2 inverse = glm::inverse(across);
  const double spread = along - glm::dot(coupling, inverse * coupling);
  if (!(spread > n * kParallelSpread * kParallelSpread)) return {centroid, 0, true};
  const double z = (along_right - glm::dot(coupling, inverse * across_right)) / spread;
  const glm::dvec2 xy = inverse * (across_right - coupling * z);

  ViewpointFit fit{centroid + xy.x * e1 + xy.y * e2 + z * axis, 0, false};
  double squares = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec3 away = glm::cross(points[i] - fit.viewpoint_mm, directions[i]);
    squares += glm::dot(away, away);
  }
  fit.residual_mm = std::sqrt(squares / n);
  return fit;
}

}  // namespace catoptra::optics
