#include "cad_import/src/surface_factory.h"

#include <GeomConvert.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Precision.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <algorithm>

#include "cad_import/bspline_surface.h"
#include "cad_import/src/kernel_surface.h"
#include "cad_import/src/turned_surface.h"

namespace catoptra::cad_import {
namespace {

SurfaceAxes axes_of(const gp_Ax3& frame, const AffineMap& map) {
  return {map.point(frame.Location().XYZ()), map.vector(frame.XDirection().XYZ()),
          map.vector(frame.YDirection().XYZ()), map.vector(frame.Direction().XYZ())};
}

std::vector<double> flat_knots(const TColStd_Array1OfReal& sequence) {
  return {sequence.begin(), sequence.end()};
}

SurfaceKind kernel_kind(const Handle(Geom_Surface) & s) {
  if (s->IsKind(STANDARD_TYPE(Geom_SurfaceOfRevolution))) return SurfaceKind::revolution;
  if (s->IsKind(STANDARD_TYPE(Geom_SurfaceOfLinearExtrusion))) return SurfaceKind::extrusion;
  if (s->IsKind(STANDARD_TYPE(Geom_OffsetSurface))) return SurfaceKind::offset;
  return SurfaceKind::other;
}

// The surface's own rectangle; unbounded directions are cut to the face, periodic ones begin where the face
// does.
ParameterDomain domain_of(const Handle(Geom_Surface) & s, const ParameterRange& face) {
  ParameterDomain d;
  s->Bounds(d.u_min, d.u_max, d.v_min, d.v_max);
  const auto cut = [](double& low, double& high, double face_low, double face_high) {
    if (Precision::IsNegativeInfinite(low)) low = face_low;
    if (Precision::IsPositiveInfinite(high)) high = face_high;
  };
  cut(d.u_min, d.u_max, face.u_min, face.u_max);
  cut(d.v_min, d.v_max, face.v_min, face.v_max);
  // A face whose loops stay within the surface's own first period keeps that period's begin.
  const auto shift = [](double& low, double& high, double period, double face_low, double face_high) {
    const double slack = 1e-9 * period;
    if (face_low < low - slack || face_high > high + slack) low = face_low;
    high = low + period;
  };
  if (s->IsUPeriodic()) shift(d.u_min, d.u_max, d.u_period = s->UPeriod(), face.u_min, face.u_max);
  if (s->IsVPeriodic()) shift(d.v_min, d.v_max, d.v_period = s->VPeriod(), face.v_min, face.v_max);
  return d;
}

std::shared_ptr<const ExactSurface> make_elementary(const Handle(Geom_Surface) & s, const AffineMap& map,
                                                    const ParameterDomain& domain, double orientation) {
  using Profile = TurnedSurface::Profile;
  const auto turned = [&](const Profile& profile, const gp_Ax3& frame) {
    return std::make_shared<TurnedSurface>(profile, axes_of(frame, map), domain, orientation);
  };
  if (const auto plane = Handle(Geom_Plane)::DownCast(s); !plane.IsNull())
    return std::make_shared<PlaneSurface>(axes_of(plane->Position(), map), domain, orientation);
  if (const auto cylinder = Handle(Geom_CylindricalSurface)::DownCast(s); !cylinder.IsNull())
    return turned({SurfaceKind::cylinder, cylinder->Radius(), 0, 0}, cylinder->Position());
  if (const auto cone = Handle(Geom_ConicalSurface)::DownCast(s); !cone.IsNull())
    return turned({SurfaceKind::cone, cone->RefRadius(), 0, cone->SemiAngle()}, cone->Position());
  if (const auto sphere = Handle(Geom_SphericalSurface)::DownCast(s); !sphere.IsNull())
    return turned({SurfaceKind::sphere, sphere->Radius(), 0, 0}, sphere->Position());
  if (const auto torus = Handle(Geom_ToroidalSurface)::DownCast(s); !torus.IsNull())
    return turned({SurfaceKind::torus, torus->MajorRadius(), torus->MinorRadius(), 0}, torus->Position());
  return nullptr;
}

}  // namespace

BSplineData bspline_data(const Handle(Geom_BSplineSurface) & original, const AffineMap& map) {
  Handle(Geom_BSplineSurface) s = original;
  BSplineData data;
  if (s->IsUPeriodic() ||
      s->IsVPeriodic()) {  // write the periodic poles out; the evaluator wraps the parameter
    s = Handle(Geom_BSplineSurface)::DownCast(original->Copy());
    if (s->IsUPeriodic()) {
      data.period_u = s->UPeriod();
      s->SetUNotPeriodic();
    }
    if (s->IsVPeriodic()) {
      data.period_v = s->VPeriod();
      s->SetVNotPeriodic();
    }
  }
  data.degree_u = s->UDegree();
  data.degree_v = s->VDegree();
  data.pole_count_u = s->NbUPoles();
  data.pole_count_v = s->NbVPoles();
  data.knots_u = flat_knots(s->UKnotSequence());
  data.knots_v = flat_knots(s->VKnotSequence());
  const bool rational = s->IsURational() || s->IsVRational();
  for (int i = 1; i <= data.pole_count_u; ++i)
    for (int j = 1; j <= data.pole_count_v; ++j) {
      data.poles.push_back(map.point(s->Pole(i, j).XYZ()));
      if (rational) data.weights.push_back(s->Weight(i, j));
    }
  return data;
}

std::shared_ptr<const ExactSurface> make_surface(const Handle(Geom_Surface) & surface, const AffineMap& map,
                                                 const ParameterRange& range, bool face_reversed) {
  Handle(Geom_Surface) s = surface;
  while (s->IsKind(STANDARD_TYPE(Geom_RectangularTrimmedSurface)))
    s = Handle(Geom_RectangularTrimmedSurface)::DownCast(s)->BasisSurface();
  const double orientation = face_reversed == (map.determinant() < 0) ? 1 : -1;
  const ParameterDomain domain = domain_of(s, range);
  if (auto elementary = make_elementary(s, map, domain, orientation)) return elementary;

  SurfaceKind kind = SurfaceKind::bspline;
  auto spline = Handle(Geom_BSplineSurface)::DownCast(s);
  if (const auto bezier = Handle(Geom_BezierSurface)::DownCast(s); !bezier.IsNull()) {
    spline = GeomConvert::SurfaceToBSplineSurface(bezier);
    kind = SurfaceKind::bezier;
  }
  if (spline.IsNull()) return std::make_shared<KernelSurface>(s, kernel_kind(s), map, domain, orientation);
  auto result = std::make_shared<BSplineSurface>(bspline_data(spline, map), orientation, kind);
  result->set_domain(domain);
  return result;
}

}  // namespace catoptra::cad_import
