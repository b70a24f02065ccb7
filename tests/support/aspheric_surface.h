// A toric, aspheric and tilted surface with a closed form, as a height field.
#pragma once

#include <cmath>
#include <memory>

#include "cad_import/exact_surface.h"

namespace catoptra::test {

/// z(x, y) = -q / (1 + w) - a r^4 - b r^6 + sx x + sy y, u = x, v = y, normal towards +z, where q = c1 p^2 +
/// c2 s^2, w = sqrt(1 - (1 + k1) c1^2 p^2 - (1 + k2) c2^2 s^2) and (p, s) are (x, y) turned by `angle_rad`.
struct AsphereSpec {
  double c1 = 0, c2 = 0;  ///< 1/mm, positive: convex towards +z
  double k1 = 0, k2 = 0;  ///< conic constants
  double angle_rad = 0;   ///< of the meridian of c1, from +x
  double a = 0, b = 0;    ///< 1/mm^3, 1/mm^5
  double sx = 0, sy = 0;  ///< tilt
  double half_width_mm = 30;
};

class AsphericSurface : public cad_import::ExactSurface {
 public:
  explicit AsphericSurface(const AsphereSpec& spec)
      : s_(spec), cos_(std::cos(spec.angle_rad)), sin_(std::sin(spec.angle_rad)) {}

  cad_import::SurfaceKind kind() const override { return cad_import::SurfaceKind::other; }
  cad_import::ParameterDomain domain() const override {
    return {-s_.half_width_mm, s_.half_width_mm, -s_.half_width_mm, s_.half_width_mm, 0, 0};
  }
  double orientation() const override { return 1; }
  glm::dvec3 point(double u, double v) const override { return d2(u, v).point; }
  cad_import::SurfaceFrame d1(double u, double v) const override {
    const auto d = d2(u, v);
    return {d.point, d.du, d.dv};
  }
  cad_import::SurfaceDerivatives d2(double u, double v) const override {
    const double p = cos_ * u + sin_ * v, s = -sin_ * u + cos_ * v;
    const double e1 = (1 + s_.k1) * s_.c1 * s_.c1, e2 = (1 + s_.k2) * s_.c2 * s_.c2;
    const double q = s_.c1 * p * p + s_.c2 * s * s, qp = 2 * s_.c1 * p, qs = 2 * s_.c2 * s;
    const double w = std::sqrt(std::max(1e-12, 1 - e1 * p * p - e2 * s * s)), w3 = w * w * w;
    const double wp = -e1 * p / w, ws = -e2 * s / w;
    const double wpp = -e1 / w - e1 * e1 * p * p / w3, wps = -e1 * p * e2 * s / w3,
                 wss = -e2 / w - e2 * e2 * s * s / w3;
    const double n = 1 / (1 + w), n2 = n * n, n3 = n2 * n;
    const double fp = qp * n - q * wp * n2, fs = qs * n - q * ws * n2;
    const double fpp = 2 * s_.c1 * n - 2 * qp * wp * n2 - q * wpp * n2 + 2 * q * wp * wp * n3;
    const double fss = 2 * s_.c2 * n - 2 * qs * ws * n2 - q * wss * n2 + 2 * q * ws * ws * n3;
    const double fps = -(qp * ws + qs * wp) * n2 - q * wps * n2 + 2 * q * wp * ws * n3;
    // The polynomial g = a r^4 + b r^6 with g' = dg / d(r^2).
    const double r2 = u * u + v * v, g = r2 * r2 * (s_.a + s_.b * r2), g1 = r2 * (2 * s_.a + 3 * s_.b * r2),
                 g2 = 2 * s_.a + 6 * s_.b * r2;
    const double zu = -(fp * cos_ - fs * sin_) - 2 * u * g1 + s_.sx,
                 zv = -(fp * sin_ + fs * cos_) - 2 * v * g1 + s_.sy;
    const double zuu =
        -(fpp * cos_ * cos_ - 2 * fps * cos_ * sin_ + fss * sin_ * sin_) - 2 * g1 - 4 * u * u * g2;
    const double zvv =
        -(fpp * sin_ * sin_ + 2 * fps * cos_ * sin_ + fss * cos_ * cos_) - 2 * g1 - 4 * v * v * g2;
    const double zuv = -((fpp - fss) * cos_ * sin_ + fps * (cos_ * cos_ - sin_ * sin_)) - 4 * u * v * g2;
    return {{u, v, -q * n - g + s_.sx * u + s_.sy * v},
            {1, 0, zu},
            {0, 1, zv},
            {0, 0, zuu},
            {0, 0, zuv},
            {0, 0, zvv}};
  }

 private:
  AsphereSpec s_;
  double cos_, sin_;
};

}  // namespace catoptra::test
