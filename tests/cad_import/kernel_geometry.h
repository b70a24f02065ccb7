// Random surfaces as the CAD kernel's own objects, and the importer's evaluators of them.
#pragma once

#include <GeomConvert.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <algorithm>
#include <glm/geometric.hpp>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>
#include <memory>
#include <random>

#include "cad_import/exact_surface.h"
#include "cad_import/src/surface_factory.h"

namespace catoptra::test {

struct RandomSurface {
  int degree_u = 3, degree_v = 3;
  int spans_u = 4, spans_v = 3;
  bool rational = false;
  bool periodic_u = false, periodic_v = false;
};

/// One direction: distinct knots, their multiplicities and the number of poles they ask for.
struct RandomKnots {
  TColStd_Array1OfReal knots;
  TColStd_Array1OfInteger multiplicities;
  int poles;

  RandomKnots(int degree, int spans, bool periodic, std::mt19937& random)
      : knots(1, spans + 1), multiplicities(1, spans + 1) {
    std::uniform_real_distribution<double> gap(0.2, 1.7);  // uneven spans
    std::uniform_int_distribution<int> multiplicity(1, std::max(1, degree - 1));
    double at = -0.3;
    poles = 0;
    for (int i = 1; i <= spans + 1; ++i) {
      knots(i) = at;
      at += gap(random);
      const bool end = i == 1 || i == spans + 1;
      multiplicities(i) = end ? (periodic ? 1 : degree + 1) : (periodic ? 1 : multiplicity(random));
      poles += multiplicities(i);
    }
    poles -= periodic ? multiplicities(1) : degree + 1;
  }
};

/// A wavy patch of about 100 mm, or a closed tube where periodic, with uneven knots of several
/// multiplicities.
inline Handle(Geom_BSplineSurface) random_bspline(const RandomSurface& spec, std::mt19937& random) {
  const RandomKnots u(spec.degree_u, spec.spans_u, spec.periodic_u, random);
  const RandomKnots v(spec.degree_v, spec.spans_v, spec.periodic_v, random);
  TColgp_Array2OfPnt poles(1, u.poles, 1, v.poles);
  TColStd_Array2OfReal weights(1, u.poles, 1, v.poles);
  std::uniform_real_distribution<double> wave(-8, 8), weight(0.4, 2.5);
  for (int i = 1; i <= u.poles; ++i)
    for (int j = 1; j <= v.poles; ++j) {
      poles(i, j) =
          gp_Pnt(100.0 * i / u.poles + wave(random), 80.0 * j / v.poles + wave(random), wave(random));
      weights(i, j) = spec.rational ? weight(random) : 1.0;
    }
  return new Geom_BSplineSurface(poles, weights, u.knots, v.knots, u.multiplicities, v.multiplicities,
                                 spec.degree_u, spec.degree_v, spec.periodic_u, spec.periodic_v);
}

/// The importer's evaluator of a kernel surface, placed by `map`, over the surface's whole domain.
inline std::shared_ptr<const cad_import::ExactSurface> evaluator_of(
    const Handle(Geom_Surface) & surface, const cad_import::AffineMap& map = {},
    const cad_import::ParameterRange& range = {}) {
  cad_import::ParameterRange whole = range;
  double u0, u1, v0, v1;
  surface->Bounds(u0, u1, v0, v1);
  const auto bounded = [](double a) { return std::abs(a) < 1e50; };
  if (bounded(u0)) whole.u_min = u0;
  if (bounded(u1)) whole.u_max = u1;
  if (bounded(v0)) whole.v_min = v0;
  if (bounded(v1)) whole.v_max = v1;
  return cad_import::make_surface(surface, map, whole, false);
}

/// The kernel's own derivatives, by the stateless members of Geom_Surface.
inline cad_import::SurfaceDerivatives kernel_d2(const Handle(Geom_Surface) & surface, double u, double v) {
  gp_Pnt p;
  gp_Vec du, dv, duu, dvv, duv;
  surface->D2(u, v, p, du, dv, duu, dvv, duv);
  using cad_import::to_glm;
  return {to_glm(p.XYZ()),   to_glm(du.XYZ()),  to_glm(dv.XYZ()),
          to_glm(duu.XYZ()), to_glm(duv.XYZ()), to_glm(dvv.XYZ())};
}

}  // namespace catoptra::test
