// B-spline surfaces of blanks: interpolation of a height field.
#include <BSplCLib.hxx>
#include <BSplSLib.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cad_import/src/blank_parts.h"

namespace catoptra::cad_import {
namespace {

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

TColStd_Array1OfReal flat_knots(const std::vector<double>& knots, int degree) {
  const int spans = static_cast<int>(knots.size()) - 1;
  TColStd_Array1OfReal flat(1, spans + 1 + 2 * degree);
  for (int i = flat.Lower(); i <= flat.Upper(); ++i)
    flat(i) = knots[static_cast<std::size_t>(std::clamp(i - 1 - degree, 0, spans))];
  return flat;
}

/// The spline through the ideal surface at the Greville points. Since u = x and v = y are linear, their poles
/// are the Greville points themselves and only the heights need solving. Source: de Boor 2001, chapters IX
/// and XIII.
Handle(Geom_BSplineSurface)
    interpolate(const HeightField& field, const OutlineBox& box, int degree,
                const std::vector<double>& u_knots, const std::vector<double>& v_knots) {
  const TColStd_Array1OfReal u_flat = flat_knots(u_knots, degree), v_flat = flat_knots(v_knots, degree);
  TColStd_Array1OfReal u(1, u_flat.Length() - degree - 1), v(1, v_flat.Length() - degree - 1);
  BSplCLib::BuildSchoenbergPoints(degree, u_flat, u);
  BSplCLib::BuildSchoenbergPoints(degree, v_flat, v);
  TColgp_Array2OfPnt poles(1, u.Length(), 1, v.Length());
  for (int i = 1; i <= u.Length(); ++i)
    for (int j = 1; j <= v.Length(); ++j) {
      const double x = std::clamp(u(i), box.min.x, box.max.x), y = std::clamp(v(j), box.min.y, box.max.y);
      poles(i, j) = gp_Pnt(x, y, field(x, y));
    }
  int problem = 0;
  BSplSLib::Interpolate(degree, degree, u_flat, v_flat, u, v, poles, problem);
  if (problem != 0) throw Error("", "surface", "the interpolation of the surface failed");

  const auto multiplicities = [degree](std::size_t count) {
    TColStd_Array1OfInteger m(1, static_cast<int>(count));
    m.Init(1);
    m(m.Lower()) = m(m.Upper()) = degree + 1;
    return m;
  };
  const TColStd_Array1OfReal u_array(u_knots.front(), 1, static_cast<int>(u_knots.size()));
  const TColStd_Array1OfReal v_array(v_knots.front(), 1, static_cast<int>(v_knots.size()));
  return new Geom_BSplineSurface(poles, u_array, v_array, multiplicities(u_knots.size()),
                                 multiplicities(v_knots.size()), degree, degree);
}

/// Largest difference from the ideal surface at four points of every span in each direction.
double largest_error_mm(const HeightField& field, const HeightFit& fit, const Geom_BSplineSurface& surface,
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
    for (const double y : v_samples) {
      if (fit.inside && !fit.inside(x, y)) continue;
      worst = std::max(worst, std::abs(surface.Value(x, y).Z() - field(x, y)));
    }
  return worst;
}

}  // namespace

FittedSurface fit_height_field(const HeightField& field, const OutlineBox& box, const HeightFit& fit) {
  FittedSurface fitted;
  for (int spans = 8; spans <= kMostSpans; spans *= 2) {
    const std::vector<double> u = knots_with(box.min.x, box.max.x, spans, fit.x_line);
    const std::vector<double> v = knots_with(box.min.y, box.max.y, spans, std::nullopt);
    fitted.surface = interpolate(field, box, fit.degree, u, v);
    fitted.error_mm = largest_error_mm(field, fit, *fitted.surface, u, v);
    if (fitted.error_mm <= fit.tolerance_mm) break;
  }
  return fitted;
}

}  // namespace catoptra::cad_import
