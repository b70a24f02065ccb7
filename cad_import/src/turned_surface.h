// Planes and the surfaces of revolution with a closed form: cylinder, cone, sphere, torus.
#pragma once

#include "cad_import/exact_surface.h"

namespace catoptra::cad_import {

/// Origin and axes; the axes need be neither unit nor orthogonal, so that any affine placement is in them
/// already.
struct SurfaceAxes {
  glm::dvec3 origin{0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

/// origin + u x + v y.
class PlaneSurface final : public ExactSurface {
 public:
  PlaneSurface(const SurfaceAxes& axes, const ParameterDomain& domain, double orientation)
      : axes_(axes), domain_(domain), orientation_(orientation) {}
  [[nodiscard]] SurfaceKind kind() const override { return SurfaceKind::plane; }
  [[nodiscard]] ParameterDomain domain() const override { return domain_; }
  [[nodiscard]] double orientation() const override { return orientation_; }
  [[nodiscard]] glm::dvec3 point(double u, double v) const override;
  [[nodiscard]] SurfaceFrame d1(double u, double v) const override;
  [[nodiscard]] SurfaceDerivatives d2(double u, double v) const override;

 private:
  SurfaceAxes axes_;
  ParameterDomain domain_;
  double orientation_;
};

/// origin + f(v) (cos u x + sin u y) + g(v) z, with the profile (f, g) of
///   cylinder: (radius, v)                         cone: (radius + v sin(angle), v cos(angle))
///   sphere: (radius cos v, radius sin v)          torus: (radius + minor cos v, minor sin v)
/// Parametrisation as ISO 10303-42 and every CAD kernel has it.
class TurnedSurface final : public ExactSurface {
 public:
  struct Profile {
    SurfaceKind kind = SurfaceKind::cylinder;
    double radius = 1;
    double minor_radius = 0;    ///< torus
    double half_angle_rad = 0;  ///< cone
  };
  TurnedSurface(const Profile& profile, const SurfaceAxes& axes, const ParameterDomain& domain,
                double orientation);

  [[nodiscard]] SurfaceKind kind() const override { return profile_.kind; }
  [[nodiscard]] ParameterDomain domain() const override { return domain_; }
  [[nodiscard]] double orientation() const override { return orientation_; }
  [[nodiscard]] glm::dvec3 point(double u, double v) const override;
  [[nodiscard]] SurfaceFrame d1(double u, double v) const override;
  [[nodiscard]] SurfaceDerivatives d2(double u, double v) const override;

 private:
  // f, g and their derivatives by v.
  struct ProfilePoint {
    double f, g, f1, g1, f2, g2;
  };
  [[nodiscard]] ProfilePoint profile_at(double v) const;

  Profile profile_;
  SurfaceAxes axes_;
  ParameterDomain domain_;
  double orientation_;
  double sin_angle_, cos_angle_;
};

}  // namespace catoptra::cad_import
