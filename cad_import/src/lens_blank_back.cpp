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
  back.form = back_form(blank);
  back.conic = blank.back_conic;
  const double cosine = std::cos(shape.angle), sine = std::sin(shape.angle);
  back.frame = glm::dmat3(cosine * tilt[0] + sine * tilt[1], cosine * tilt[1] - sine * tilt[0], tilt[2]);
  return back;
}

LensBackForm back_form(const LensBlank& blank) {
  return blank.back.value_or(blank.back_conic == 0 ? LensBackForm::toric : LensBackForm::biconic);
}

/// Where the first slope becomes vertical. For a torus that is the radius of its steeper section too: on the
/// cylinder of that radius the ring through (x, y) is still as wide as x, in either formation.
double LensBack::limit_mm() const {
  const double steepest = std::max(std::abs(c1), std::abs(c2)) * std::sqrt(std::max(0.0, 1 + conic));
  return steepest > 0 ? 1 / steepest : std::numeric_limits<double>::infinity();
}

/// The circle of the steeper section, of height s above its own coordinate, turned about an axis parallel to
/// that coordinate at the flatter section's centre: rings of radius (1 - c s) / c around it, hence
///   z = s + c x^2 / (q + sqrt(q^2 - c^2 x^2)),  q = 1 - c s,  c and x along the flatter section.
std::optional<LensBack::Sag> LensBack::toric_sag(double x, double y) const {
  const bool first_is_circle = std::abs(c1) > std::abs(c2);
  const double circle = first_is_circle ? c1 : c2, ring = first_is_circle ? c2 : c1;
  const double along = first_is_circle ? x : y, across = first_is_circle ? y : x;
  const double upright = std::sqrt(1 - circle * circle * along * along);
  if (!(upright > 0)) return std::nullopt;
  const double s = circle * along * along / (1 + upright), q = 1 - ring * s;
  const double root = std::sqrt(q * q - ring * ring * across * across);
  if (!(q > 0 && root > 0)) return std::nullopt;
  const double z = s + ring * across * across / (q + root);
  const double slope_along = circle * along / upright * q / root, slope_across = ring * across / root;
  return first_is_circle ? Sag{z, slope_along, slope_across} : Sag{z, slope_across, slope_along};
}

std::optional<LensBack::Sag> LensBack::biconic_sag(double x, double y) const {
  const double curved = c1 * x * x + c2 * y * y;
  const double root = std::sqrt(1 - (1 + conic) * (c1 * c1 * x * x + c2 * c2 * y * y));
  if (!(root > 0)) return std::nullopt;
  const double turn = (1 + conic) * curved / (root * (1 + root) * (1 + root));
  return Sag{curved / (1 + root), 2 * c1 * x / (1 + root) + turn * c1 * c1 * x,
             2 * c2 * y / (1 + root) + turn * c2 * c2 * y};
}

double LensBack::z_mm(double x_mm, double y_mm) const {
  double z = vertex_mm.z;
  // Newton on z: the height of (x, y, z) above the surface in its own frame vanishes. One step where the
  // frame is not tilted.
  for (int iteration = 0; iteration < 50; ++iteration) {
    const glm::dvec3 p = (glm::dvec3(x_mm, y_mm, z) - vertex_mm) * frame;
    const auto sag = form == LensBackForm::toric ? toric_sag(p.x, p.y) : biconic_sag(p.x, p.y);
    if (!sag) break;
    const double miss = p.z - sag->z;
    const double rate = frame[2].z - sag->slope_x * frame[0].z - sag->slope_y * frame[1].z;
    if (!(rate > 0)) break;
    z -= miss / rate;
    if (std::abs(miss) < 1e-13 * (1 + std::abs(z))) return z;
  }
  refuse_lens("back", "the surface does not reach (" + number_text(x_mm) + ", " + number_text(y_mm) + ") mm",
              "make the lens smaller, the front curve flatter or the prism weaker");
}

}  // namespace catoptra::cad_import
