#include "cad_import/src/kernel_surface.h"

#include <Standard_Failure.hxx>
#include <array>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

namespace catoptra::cad_import {
namespace {

// An offset surface has no derivative, and the kernel throws, where its basis has no normal (a pole). The
// limit from inside the domain is taken there: steps as a share of the way to the domain's centre, the first
// being none.
constexpr std::array kSteps{0.0, 1e-8, 1e-6, 1e-4, 1e-2, 1.0};

template <class Evaluate>
auto at_regular_point(const ParameterDomain& d, double u, double v, Evaluate evaluate)
    -> decltype(evaluate(u, v)) {
  for (const double step : kSteps) try {
      return evaluate(u + step * (0.5 * (d.u_min + d.u_max) - u), v + step * (0.5 * (d.v_min + d.v_max) - v));
    } catch (const Standard_Failure&) {
    }
  return {};
}

}  // namespace

glm::dvec3 KernelSurface::point(double u, double v) const {
  return at_regular_point(domain_, u, v, [this](double a, double b) {
    gp_Pnt p;
    surface_->D0(a, b, p);
    return map_.point(p.XYZ());
  });
}

SurfaceFrame KernelSurface::d1(double u, double v) const {
  return at_regular_point(domain_, u, v, [this](double a, double b) {
    gp_Pnt p;
    gp_Vec du, dv;
    surface_->D1(a, b, p, du, dv);
    return SurfaceFrame{map_.point(p.XYZ()), map_.vector(du.XYZ()), map_.vector(dv.XYZ())};
  });
}

SurfaceDerivatives KernelSurface::d2(double u, double v) const {
  return at_regular_point(domain_, u, v, [this](double a, double b) {
    gp_Pnt p;
    gp_Vec du, dv, duu, dvv, duv;
    surface_->D2(a, b, p, du, dv, duu, dvv, duv);
    return SurfaceDerivatives{map_.point(p.XYZ()),    map_.vector(du.XYZ()),  map_.vector(dv.XYZ()),
                              map_.vector(duu.XYZ()), map_.vector(duv.XYZ()), map_.vector(dvv.XYZ())};
  });
}

}  // namespace catoptra::cad_import
