#include "cad_import/src/turned_surface.h"

#include <cmath>

namespace catoptra::cad_import {

glm::dvec3 PlaneSurface::point(double u, double v) const {
  return axes_.origin + u * axes_.x + v * axes_.y;
}

SurfaceFrame PlaneSurface::d1(double u, double v) const {
  return {point(u, v), axes_.x, axes_.y};
}

SurfaceDerivatives PlaneSurface::d2(double u, double v) const {
  return {point(u, v), axes_.x, axes_.y, glm::dvec3(0), glm::dvec3(0), glm::dvec3(0)};
}

TurnedSurface::TurnedSurface(const Profile& profile, const SurfaceAxes& axes, const ParameterDomain& domain,
                             double orientation)
    : profile_(profile),
      axes_(axes),
      domain_(domain),
      orientation_(orientation),
      sin_angle_(std::sin(profile.half_angle_rad)),
      cos_angle_(std::cos(profile.half_angle_rad)) {}

TurnedSurface::ProfilePoint TurnedSurface::profile_at(double v) const {
  const double r = profile_.radius, m = profile_.minor_radius;
  if (profile_.kind == SurfaceKind::cylinder) return {r, v, 0, 1, 0, 0};
  if (profile_.kind == SurfaceKind::cone)
    return {r + v * sin_angle_, v * cos_angle_, sin_angle_, cos_angle_, 0, 0};
  const double c = std::cos(v), s = std::sin(v);
  if (profile_.kind == SurfaceKind::sphere) return {r * c, r * s, -r * s, r * c, -r * c, -r * s};
  return {r + m * c, m * s, -m * s, m * c, -m * c, -m * s};
}

glm::dvec3 TurnedSurface::point(double u, double v) const {
  const ProfilePoint p = profile_at(v);
  return axes_.origin + p.f * (std::cos(u) * axes_.x + std::sin(u) * axes_.y) + p.g * axes_.z;
}

SurfaceFrame TurnedSurface::d1(double u, double v) const {
  const ProfilePoint p = profile_at(v);
  const double c = std::cos(u), s = std::sin(u);
  const glm::dvec3 radial = c * axes_.x + s * axes_.y, turn = c * axes_.y - s * axes_.x;
  return {axes_.origin + p.f * radial + p.g * axes_.z, p.f * turn, p.f1 * radial + p.g1 * axes_.z};
}

SurfaceDerivatives TurnedSurface::d2(double u, double v) const {
  const ProfilePoint p = profile_at(v);
  const double c = std::cos(u), s = std::sin(u);
  const glm::dvec3 radial = c * axes_.x + s * axes_.y, turn = c * axes_.y - s * axes_.x;
  return {axes_.origin + p.f * radial + p.g * axes_.z,
          p.f * turn,
          p.f1 * radial + p.g1 * axes_.z,
          -p.f * radial,
          p.f1 * turn,
          p.f2 * radial + p.g2 * axes_.z};
}

}  // namespace catoptra::cad_import
