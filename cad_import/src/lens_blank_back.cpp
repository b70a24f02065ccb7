// Backs of lenses: the surface that turns the wavefront behind the front into the prescribed one.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>

#include "cad_import/src/lens_blank_parts.h"

namespace catoptra::cad_import {
namespace {

/// Rotation that carries the unit vector `a` into `b` about their common perpendicular (a != -b).
glm::dmat3 rotation_between(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 w = glm::cross(a, b);
  glm::dmat3 rotation{1};
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 across = glm::cross(w, rotation[i]);
    rotation[i] += across + glm::cross(w, across) / (1 + glm::dot(a, b));
  }
  return rotation;
}

/// Vergences in 1/mm along x and y of the prescription's axes. Source: Thibos et al. 1997.
glm::dmat2 power_matrix(const LensBlank& blank) {
  const double a = blank.axis_deg * std::numbers::pi / 180;
  const double s = blank.sphere_d / 1000, c = blank.cylinder_d / 1000;
  const double off = -c * std::sin(a) * std::cos(a);
  return {{s + c * std::sin(a) * std::sin(a), off}, {off, s + c * std::cos(a) * std::cos(a)}};
}

struct Principal {
  double c1, c2, angle;  // c1 along `angle` from the first axis
};
Principal principal(const glm::dmat2& m) {
  const double mean = 0.5 * (m[0][0] + m[1][1]), half = 0.5 * (m[0][0] - m[1][1]), off = m[0][1];
  const double root = std::hypot(half, off);
  return {mean + root, mean - root, root > 0 ? 0.5 * std::atan2(off, half) : 0};
}

}  // namespace

LensBack solve_back(const LensBlank& blank, double front_curvature, double thickness_mm) {
  const double n = blank.index;
  // Behind the front: a wavefront of vergence (n - 1) c / n, further converged on its way to the back.
  const double behind_front = (n - 1) * front_curvature / n;
  const double shrinkage = 1 - thickness_mm * behind_front;
  if (!(shrinkage > 0.05))
    refuse_lens("center thickness",
                number_text(thickness_mm) + " mm is too much for this front: the light focuses in the lens",
                "make the lens thinner or its front flatter");
  const double at_back = behind_front / shrinkage;
  // The prism: the ray leaves towards the base, and Snell's law gives the normal, n d - d' up to length.
  const double base = blank.prism_base_deg * std::numbers::pi / 180;
  const glm::dvec3 d{0, 0, -1};
  const glm::dvec3 out = glm::normalize(
      glm::dvec3(blank.prism_d / 100 * std::cos(base), blank.prism_d / 100 * std::sin(base), -1));
  const double bend = glm::length(n * d - out);
  const glm::dvec3 normal = (out - n * d) / bend;
  const glm::dmat3 tilt = rotation_between({0, 0, 1}, normal);
  const glm::dmat3 turn = rotation_between(d, out);
  // Phases of both wavefronts agree on the surface to second order in the tangent plane's p: with T and T'
  // the components of its axes across the rays, bend * H = T'^t P T' - n T^t W T, H the surface's Hessian
  // along its normal. Source: Landgrave and Moya-Cessa 1996.
  glm::dmat2 across_in, across_out;  // [column: tangent axis][row: wave axis]
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      across_in[i][j] = tilt[i][j];
      across_out[i][j] = glm::dot(turn[j], tilt[i]);
    }
  const glm::dmat2 wanted = glm::transpose(across_out) * power_matrix(blank) * across_out;
  const glm::dmat2 present = glm::transpose(across_in) * across_in * (n * at_back);
  const Principal shape = principal((wanted - present) / bend);

  LensBack back;
  back.vertex_mm = {0, 0, -thickness_mm};
  back.c1 = shape.c1;
  back.c2 = shape.c2;
  back.conic = blank.back_conic;
  const double cosine = std::cos(shape.angle), sine = std::sin(shape.angle);
  back.frame = glm::dmat3(cosine * tilt[0] + sine * tilt[1], cosine * tilt[1] - sine * tilt[0], tilt[2]);
  return back;
}

double LensBack::limit_mm() const {
  const double steepest = std::max(std::abs(c1), std::abs(c2)) * std::sqrt(std::max(0.0, 1 + conic));
  return steepest > 0 ? 1 / steepest : std::numeric_limits<double>::infinity();
}

double LensBack::z_mm(double x_mm, double y_mm) const {
  double z = vertex_mm.z;
  // Newton on z: the height of (x, y, z) above the surface in its own frame vanishes. One step where the
  // frame is not tilted.
  for (int iteration = 0; iteration < 50; ++iteration) {
    const glm::dvec3 p = (glm::dvec3(x_mm, y_mm, z) - vertex_mm) * frame;
    const double curved = c1 * p.x * p.x + c2 * p.y * p.y;
    const double root = std::sqrt(1 - (1 + conic) * (c1 * c1 * p.x * p.x + c2 * c2 * p.y * p.y));
    if (!(root > 0)) break;
    const double miss = p.z - curved / (1 + root);
    const double turn = (1 + conic) * curved / (root * (1 + root) * (1 + root));
    const double slope_x = 2 * c1 * p.x / (1 + root) + turn * c1 * c1 * p.x;
    const double slope_y = 2 * c2 * p.y / (1 + root) + turn * c2 * c2 * p.y;
    const double rate = frame[2].z - slope_x * frame[0].z - slope_y * frame[1].z;
    if (!(rate > 0)) break;
    z -= miss / rate;
    if (std::abs(miss) < 1e-13 * (1 + std::abs(z))) return z;
  }
  refuse_lens("back", "the surface does not reach (" + number_text(x_mm) + ", " + number_text(y_mm) + ") mm",
              "make the lens smaller, the front curve flatter or the prism weaker");
}

}  // namespace catoptra::cad_import
