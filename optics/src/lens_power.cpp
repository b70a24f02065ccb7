#include "optics/lens_power.h"

#include <cmath>
#include <numbers>

namespace catoptra::optics {
namespace {

constexpr double kNoCylinder_d = 1e-9;

// Axes are angles modulo pi, written as 0 < axis <= pi: what lies within rounding above 0 is pi too.
constexpr double kNoAngle_rad = 1e-9;
double axis_in_range(double axis_rad) {
  const double axis = axis_rad - std::numbers::pi * std::floor(axis_rad / std::numbers::pi);
  return axis > kNoAngle_rad ? axis : std::numbers::pi;
}

}  // namespace

double PowerMatrix::along(double angle_rad) const {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return xx * c * c + 2 * xy * c * s + yy * s * s;
}

PowerMatrix power_matrix(const SphereCylinder& power) {
  const double c = std::cos(power.axis_rad), s = std::sin(power.axis_rad);
  return {power.sphere_d + power.cylinder_d * s * s, -power.cylinder_d * s * c,
          power.sphere_d + power.cylinder_d * c * c};
}

SphereCylinder sphere_cylinder(const PowerMatrix& matrix, CylinderForm form) {
  const double j0 = 0.5 * (matrix.xx - matrix.yy), j45 = matrix.xy, half = std::hypot(j0, j45);
  if (2 * half < kNoCylinder_d) return {matrix.mean(), 0, std::numbers::pi};
  const double sign = form == CylinderForm::plus ? -1 : 1;
  return {matrix.mean() + sign * half, -2 * sign * half,
          axis_in_range(0.5 * std::atan2(sign * j45, sign * j0))};
}

SphereCylinder transposed(const SphereCylinder& power, CylinderForm form) {
  const bool right = form == CylinderForm::plus ? power.cylinder_d >= 0 : power.cylinder_d <= 0;
  if (right) return power;
  return {power.sphere_d + power.cylinder_d, -power.cylinder_d,
          axis_in_range(power.axis_rad + 0.5 * std::numbers::pi)};
}

PowerVector power_vector(const SphereCylinder& power) {
  return {power.sphere_d + 0.5 * power.cylinder_d, -0.5 * power.cylinder_d * std::cos(2 * power.axis_rad),
          -0.5 * power.cylinder_d * std::sin(2 * power.axis_rad)};
}

}  // namespace catoptra::optics
