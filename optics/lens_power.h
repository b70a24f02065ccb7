// Sphere, cylinder and axis, and the symmetric power matrix that they stand for.
#pragma once

namespace catoptra::optics {

/// Sign in which a cylinder is written.
enum class CylinderForm { plus, minus };

/// A spectacle power, dioptre. The axis is TABO: 0 < axis_rad <= pi, from +x (right of someone who faces the
/// wearer) counter-clockwise; pi where there is no cylinder.
struct SphereCylinder {
  double sphere_d = 0, cylinder_d = 0, axis_rad = 3.14159265358979323846;
};

/// The power matrix [[xx, xy], [xy, yy]] in x right, y up, dioptre: the vergence added to a wave's. Sums of
/// thin lenses in contact add. Source: Long 1976; facts: S + C sin^2 A, -C sin A cos A, S + C cos^2 A.
struct PowerMatrix {
  double xx = 0, xy = 0, yy = 0;

  [[nodiscard]] double mean() const { return 0.5 * (xx + yy); }
  /// Power along the meridian at `angle_rad` from +x.
  [[nodiscard]] double along(double angle_rad) const;
};

[[nodiscard]] PowerMatrix power_matrix(const SphereCylinder& power);

/// Cylinders below 1e-9 D are written as none, axes within 1e-9 rad above 0 as pi.
[[nodiscard]] SphereCylinder sphere_cylinder(const PowerMatrix& matrix, CylinderForm form);

/// The same power with the cylinder in the other form, or the same.
[[nodiscard]] SphereCylinder transposed(const SphereCylinder& power, CylinderForm form);

/// Thibos' power vector: M = S + C/2, J0 = -(C/2) cos 2A, J45 = -(C/2) sin 2A.
struct PowerVector {
  double m = 0, j0 = 0, j45 = 0;
};
[[nodiscard]] PowerVector power_vector(const SphereCylinder& power);

}  // namespace catoptra::optics
