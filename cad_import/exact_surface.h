// The exact surface under a CAD face: point, normal, derivatives and curvatures in double precision.
#pragma once

#include <glm/vec3.hpp>

namespace catoptra::cad_import {

enum class SurfaceKind {
  plane,
  cylinder,
  cone,
  sphere,
  torus,
  bezier,
  bspline,
  revolution,
  extrusion,
  offset,
  other
};

/// The rectangle of parameters on which a surface is defined (already cut to the face's trimming for
/// unbounded ones).
struct ParameterDomain {
  double u_min = 0, u_max = 1, v_min = 0, v_max = 1;
  double u_period = 0;  ///< 0 where the surface is not periodic in u
  double v_period = 0;
};

/// Point and first derivatives, mm and mm per unit of parameter.
struct SurfaceFrame {
  glm::dvec3 point, du, dv;
};

/// Point, first and second derivatives.
struct SurfaceDerivatives {
  glm::dvec3 point, du, dv, duu, duv, dvv;
};

/// Principal curvatures, 1/mm, with their unit directions in the tangent plane. Positive where the surface is
/// convex as seen from the side its normal points to: a sphere of radius R with outward normal has k1 = k2 =
/// +1/R. k1 >= k2; direction2 = cross(normal, direction1).
struct PrincipalCurvatures {
  double k1 = 0, k2 = 0;
  glm::dvec3 direction1{1, 0, 0}, direction2{0, 1, 0};
};

class BSplineSurface;

/// One face's surface in model coordinates (the body's placement is already applied), without any CAD-kernel
/// type. Every member function is safe to call from many threads at once. Parameters outside the domain are
/// evaluated by the surface's natural continuation (never an exception), so that Newton iterations may
/// overshoot.
class ExactSurface {
 public:
  virtual ~ExactSurface() = default;

  [[nodiscard]] virtual SurfaceKind kind() const = 0;
  [[nodiscard]] virtual ParameterDomain domain() const = 0;

  [[nodiscard]] virtual glm::dvec3 point(double u, double v) const = 0;
  [[nodiscard]] virtual SurfaceFrame d1(double u, double v) const = 0;
  [[nodiscard]] virtual SurfaceDerivatives d2(double u, double v) const = 0;

  /// +1 where the face's outward normal is du x dv, -1 where it is dv x du.
  [[nodiscard]] virtual double orientation() const = 0;

  /// The B-spline behind this surface, for evaluators that work on its coefficients; null for every other
  /// kind.
  [[nodiscard]] virtual const BSplineSurface* as_bspline() const { return nullptr; }

  /// Unit normal, pointing out of the material where the face bounds a solid. At a degenerate point (pole of
  /// a sphere, apex of a patch) the limit from inside the domain.
  [[nodiscard]] glm::dvec3 unit_normal(double u, double v) const;

  /// Source: do Carmo, Differential Geometry of Curves and Surfaces, 3-3 (first and second fundamental
  /// forms).
  [[nodiscard]] PrincipalCurvatures principal_curvatures(double u, double v) const;
};

}  // namespace catoptra::cad_import
