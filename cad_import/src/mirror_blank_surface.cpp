// The B-spline surface of a mirror glass: interpolation of the ideal height field.
#include <BSplCLib.hxx>
#include <BSplSLib.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cad_import/src/mirror_blank_parts.h"

namespace catoptra::cad_import {
namespace {

constexpr int kDegree = 3;
/// Half of what write_mirror_blank promises: the check points may miss the worst place.
constexpr double kTolerance_mm = 5e-7;
/// 256 spans a side are 67,000 poles, a file of about 5 MB.
constexpr int kMostSpans = 256;

/// Distinct knots of [from, to] in about `spans` equal steps, with `extra` among them where it lies strictly
/// inside.
std::vector<double> knots_with(double from, double to, int spans, std::optional<double> extra) {
  std::vector<double> knots;
  const auto add = [&knots](double begin, double end, int count) {
    for (int i = 0; i < count; ++i) knots.push_back(begin + (end - begin) * i / count);
  };
  const double margin = 1e-9 * (to - from);
  if (extra && *extra > from + margin && *extra < to - margin) {
    const int left =
        std::clamp(static_cast<int>(std::lround(spans * (*extra - from) / (to - from))), 1, spans - 1);
    add(from, *extra, left);
    add(*extra, to, spans - left);
  } else {
    add(from, to, spans);
  }
  knots.push_back(to);
  return knots;
}

TColStd_Array1OfReal flat_knots(const std::vector<double>& knots) {
  const int spans = static_cast<int>(knots.size()) - 1;
  TColStd_Array1OfReal flat(1, spans + 1 + 2 * kDegree);
  for (int i = flat.Lower(); i <= flat.Upper(); ++i)
    flat(i) = knots[static_cast<std::size_t>(std::clamp(i - 1 - kDegree, 0, spans))];
  return flat;
}

/// The spline through the ideal surface at the Greville points. Since u = x and v = y are linear, their poles
/// are the Greville points themselves and only the heights need solving. Source: de Boor 2001, chapters IX
/// and XIII.
Handle(Geom_BSplineSurface)
    interpolate(const MirrorBlank& blank, const OutlineBox& box, const std::vector<double>& u_knots,
                const std::vector<double>& v_knots) {
  const TColStd_Array1OfReal u_flat = flat_knots(u_knots), v_flat = flat_knots(v_knots);
  TColStd_Array1OfReal u(1, u_flat.Length() - kDegree - 1), v(1, v_flat.Length() - kDegree - 1);
  BSplCLib::BuildSchoenbergPoints(kDegree, u_flat, u);
  BSplCLib::BuildSchoenbergPoints(kDegree, v_flat, v);
  TColgp_Array2OfPnt poles(1, u.Length(), 1, v.Length());
  for (int i = 1; i <= u.Length(); ++i)
    for (int j = 1; j <= v.Length(); ++j) {
      const double x = std::clamp(u(i), box.min.x, box.max.x), y = std::clamp(v(j), box.min.y, box.max.y);
      poles(i, j) = gp_Pnt(x, y, ideal_sag_mm(blank, box, x, y));
    }
  int problem = 0;
  BSplSLib::Interpolate(kDegree, kDegree, u_flat, v_flat, u, v, poles, problem);
  if (problem != 0) throw Error("mirror", "Glass", "the interpolation of the surface failed");

  const auto multiplicities = [](std::size_t count) {
    TColStd_Array1OfInteger m(1, static_cast<int>(count));
    m.Init(1);
    m(m.Lower()) = m(m.Upper()) = kDegree + 1;
    return m;
  };
  const TColStd_Array1OfReal u_array(u_knots.front(), 1, static_cast<int>(u_knots.size()));
  const TColStd_Array1OfReal v_array(v_knots.front(), 1, static_cast<int>(v_knots.size()));
  return new Geom_BSplineSurface(poles, u_array, v_array, multiplicities(u_knots.size()),
                                 multiplicities(v_knots.size()), kDegree, kDegree);
}

/// Largest difference from the ideal surface at four points of every span in each direction.
double largest_error_mm(const MirrorBlank& blank, const OutlineBox& box, const Geom_BSplineSurface& surface,
                        const std::vector<double>& u_knots, const std::vector<double>& v_knots) {
  constexpr int kPerSpan = 4;
  const auto samples = [](const std::vector<double>& knots) {
    std::vector<double> values;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i)
      for (int k = 0; k < kPerSpan; ++k)
        values.push_back(knots[i] + (knots[i + 1] - knots[i]) * (k + 0.5) / kPerSpan);
    return values;
  };
  double worst = 0;
  const std::vector<double> v_samples = samples(v_knots);
  for (const double x : samples(u_knots))
    for (const double y : v_samples)
      worst = std::max(worst, std::abs(surface.Value(x, y).Z() - ideal_sag_mm(blank, box, x, y)));
  return worst;
}

}  // namespace

Handle(Geom_BSplineSurface) glass_surface(const MirrorBlank& blank) {
  const OutlineBox box = outline_box(blank);
  std::optional<double> line;  // the third derivative jumps at the aspheric boundary, so a knot belongs there
  if (blank.aspheric)
    line = blank.aspheric->towards_minus_x ? -blank.aspheric->boundary_mm : blank.aspheric->boundary_mm;
  double error = 0;
  for (int spans = 8; spans <= kMostSpans; spans *= 2) {
    const std::vector<double> u = knots_with(box.min.x, box.max.x, spans, line);
    const std::vector<double> v = knots_with(box.min.y, box.max.y, spans, std::nullopt);
    const Handle(Geom_BSplineSurface) surface = interpolate(blank, box, u, v);
    error = largest_error_mm(blank, box, *surface, u, v);
    if (error <= kTolerance_mm) return surface;
  }
  throw Error(
      "mirror", "radius",
      "the glass is too steep at its edge for a B-spline within 1e-6 mm: " + std::to_string(error) + " mm",
      "make the glass smaller or the radius larger");
}

}  // namespace catoptra::cad_import
