#include "optics/src/lens_batch_surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "optics/src/least_squares.h"

namespace catoptra::optics {
namespace {

struct Sample {
  double u, v;
  glm::dvec3 point, normal;
};

// Points of the trimmed face, or of the whole surface where the outline leaves too few of them.
std::vector<Sample> samples_of(const cad_import::Face& face) {
  constexpr int kPerSide = 17;
  constexpr std::size_t kFewest = 30;  // five per unknown of a quadric
  const auto d = face.surface->domain();
  std::vector<Sample> all, kept;
  for (int i = 0; i < kPerSide; ++i)
    for (int j = 0; j < kPerSide; ++j) {
      const double u = d.u_min + (d.u_max - d.u_min) * (i + 0.5) / kPerSide,
                   v = d.v_min + (d.v_max - d.v_min) * (j + 0.5) / kPerSide;
      all.push_back({u, v, face.surface->point(u, v), face.surface->unit_normal(u, v)});
      if (!face.trim || face.trim->contains(u, v)) kept.push_back(all.back());
    }
  return kept.size() >= kFewest ? kept : all;
}

void copy(const glm::dvec3& from, double (&to)[3]) {
  for (int k = 0; k < 3; ++k) to[k] = from[k];
}

}  // namespace

LensBatchSurface::LensBatchSurface(const cad_import::Face& face) {
  const auto& spline = *face.surface->as_bspline();
  const auto domain = spline.domain();
  u_ = tables_of(spline.axis_u(), domain.u_min, domain.u_max);
  v_ = tables_of(spline.axis_v(), domain.v_min, domain.v_max);
  surface_.u = u_.axis;
  surface_.v = v_.axis;
  surface_.coefficients = &spline.coefficients().data()->x;
  surface_.degree_u = spline.degree_u();
  surface_.degree_v = spline.degree_v();
  surface_.spans_v = spline.axis_v().span_count();
  surface_.rational = spline.rational();
  surface_.orientation = spline.orientation();
  copy(spline.origin(), surface_.origin);
  fit_start(face);
}

LensBatchSurface::AxisTables LensBatchSurface::tables_of(const cad_import::SpanAxis& axis, double begin,
                                                         double end) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  AxisTables t;
  const int spans = axis.span_count();
  for (int s = 0; s < spans; ++s) {
    t.low.push_back(s == 0 ? -kInfinite : axis.span_begin(s));
    t.high.push_back(s + 1 == spans ? kInfinite : axis.span_end(s));
    t.middle.push_back(0.5 * (axis.span_begin(s) + axis.span_end(s)));
    t.rate.push_back(2 / (axis.span_end(s) - axis.span_begin(s)));
  }
  const int buckets = 2 * spans;  // even knots then need no step beyond the table
  const double rate = buckets / (axis.end() - axis.begin());
  for (int b = 0; b < buckets; ++b) t.bucket.push_back(axis.locate(axis.begin() + (b + 0.5) / rate).span);
  t.axis = {t.low.data(), t.high.data(), t.middle.data(), t.rate.data(), t.bucket.data(),
            axis.begin(), rate,          buckets,         begin,         end};
  return t;
}

// The plane through the middle of the face across its mean normal, the quadric of heights over it, and u and
// v as linear functions on it, each by least squares.
void LensBatchSurface::fit_start(const cad_import::Face& face) {
  const auto samples = samples_of(face);
  glm::dvec3 centre{0}, normal{0};
  for (const Sample& s : samples) {
    centre += s.point / double(samples.size());
    normal += s.normal;
  }
  normal = glm::normalize(normal);
  const glm::dvec3 helper = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 ex = glm::normalize(glm::cross(normal, helper)), ey = glm::cross(normal, ex);
  double size = 0;  // coordinates are fitted in units of it
  for (const Sample& s : samples) size = std::max(size, glm::distance(s.point, centre));
  LeastSquares<6> height;
  LeastSquares<3> u, v;
  for (const Sample& s : samples) {
    const glm::dvec3 p = (s.point - centre) / size;
    const double x = glm::dot(p, ex), y = glm::dot(p, ey);
    height.add({1, x, y, x * x, x * y, y * y}, glm::dot(p, normal));
    u.add({1, x, y}, s.u);
    v.add({1, x, y}, s.v);
  }
  const auto h = height.solve();
  const double units[6] = {size, 1, 1, 1 / size, 1 / size, 1 / size};
  for (std::size_t k = 0; k < 6; ++k) surface_.height[k] = h[k] * units[k];
  const auto linear_u = u.solve(), linear_v = v.solve();
  for (std::size_t k = 0; k < 3; ++k) {
    surface_.start_u[k] = linear_u[k] / (k == 0 ? 1 : size);
    surface_.start_v[k] = linear_v[k] / (k == 0 ? 1 : size);
  }
  copy(centre - face.surface->as_bspline()->origin(), surface_.plane_point);
  copy(ex, surface_.axis_x);
  copy(ey, surface_.axis_y);
  copy(normal, surface_.normal);
}

}  // namespace catoptra::optics
