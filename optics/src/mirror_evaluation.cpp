#include "optics/mirror_evaluation.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "cad_import/error.h"
#include "optics/reflection.h"
#include "optics/wavefront.h"

namespace catoptra::optics {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool close_to(double curvature, double reference) {
  return std::abs(curvature - reference) <= kSphericalPart * std::abs(reference) + 1 / kStraight_mm;
}

/// A symmetric tensor across a ray, in an orthonormal pair of directions across it.
struct Across {
  double tt = 0, ts = 0, ss = 0;
  [[nodiscard]] double mean() const { return (tt + ss) / 2; }
  [[nodiscard]] double half_difference() const { return std::hypot((tt - ss) / 2, ts); }
};

Across across(const glm::dmat3& q, const glm::dvec3& t, const glm::dvec3& s) {
  return {glm::dot(t, q * t), glm::dot(t, q * s), glm::dot(s, q * s)};
}

/// Directions across `d`: in the plane that it makes with `normal`, and square to that plane. At normal
/// incidence any.
std::pair<glm::dvec3, glm::dvec3> plane_of_incidence(const glm::dvec3& d, const glm::dvec3& normal,
                                                     const glm::dvec3& fallback) {
  glm::dvec3 s = glm::cross(d, normal);
  if (glm::length(s) < 1e-9) s = glm::cross(d, fallback);
  s = glm::normalize(s);
  return {glm::cross(s, d), s};
}

/// Of the map from the eye's angle to the object's: across the ray by distance a, then turned by Q and, for
/// an object at distance d, moved on: (I + d Q) a / (a + d), whose limit is a Q. Magnification is its
/// inverse.
void set_magnification(MirrorView& view, const Across& q, double object_distance_mm) {
  const double a = view.eye_distance_mm;
  Across m{a * q.tt, a * q.ts, a * q.ss};
  if (std::isfinite(object_distance_mm)) {
    const double scale = a / (a + object_distance_mm);
    m = {scale * (1 + object_distance_mm * q.tt), scale * object_distance_mm * q.ts,
         scale * (1 + object_distance_mm * q.ss)};
  }
  const double determinant = m.tt * m.ss - m.ts * m.ts;
  view.tangential = m.ss / determinant;
  view.sagittal = m.tt / determinant;
  const double one = m.mean() + m.half_difference(), other = m.mean() - m.half_difference();
  view.least = std::min(std::abs(1 / one), std::abs(1 / other));
  view.greatest = std::max(std::abs(1 / one), std::abs(1 / other));
  view.anisotropy = view.greatest / view.least;
}

}  // namespace

RadiusMap map_radii(const MirrorGlass& glass, int per_side) {
  RadiusMap map;
  const glm::dvec2 size = glass.high_mm() - glass.low_mm();
  map.step_mm = std::min(size.x, size.y) / std::max(2, per_side);
  const int columns = std::max(1, int(size.x / map.step_mm)), rows = std::max(1, int(size.y / map.step_mm));
  const glm::dvec2 step{size.x / columns, size.y / rows};
  std::vector<std::optional<GlassPoint>> found(std::size_t(columns * rows));
  tbb::parallel_for(0, columns * rows, [&](int i) {
    const glm::dvec2 cell{i % columns + 0.5, i / columns + 0.5};
    found[std::size_t(i)] = glass.at(glass.low_mm() + cell * step);
  });
  std::vector<double> k1, k2;
  for (const auto& point : found) {
    if (!point) continue;
    map.points.push_back(*point);
    k1.push_back(point->curvatures.k1);
    k2.push_back(point->curvatures.k2);
  }
  if (map.points.empty()) throw Error("", glass.optic().name, "no place of the glass could be evaluated");
  // The border holds the extremes of a strip whose curvature grows outwards.
  for (const auto& vertex : glass.optic().mesh.vertices) {
    k1.push_back(glass.optic().flip ? -vertex.k2 : vertex.k1);
    k2.push_back(glass.optic().flip ? -vertex.k1 : vertex.k2);
  }
  map.min_mm = radius_of_mm(*std::max_element(k1.begin(), k1.end()));
  map.max_mm = radius_of_mm(*std::min_element(k2.begin(), k2.end()));
  k1.resize(map.points.size());
  k2.resize(map.points.size());
  map.median_k1 = median(k1);
  map.median_k2 = median(k2);
  const auto inside = std::count_if(map.points.begin(), map.points.end(),
                                    [&](const GlassPoint& p) { return in_spherical_part(map, p); });
  map.spherical_share = double(inside) / double(map.points.size());
  return map;
}

bool in_spherical_part(const RadiusMap& map, const GlassPoint& point) {
  return close_to(point.curvatures.k1, map.median_k1) && close_to(point.curvatures.k2, map.median_k2);
}

std::optional<MirrorView> mirror_view(const GlassPoint& point, const glm::dvec3& eye_mm,
                                      double object_distance_mm) {
  const glm::dvec3 towards = point.surface.point - eye_mm;
  MirrorView view;
  view.eye_distance_mm = glm::length(towards);
  const glm::dvec3 d = towards / view.eye_distance_mm;
  const double cosine = -glm::dot(d, point.normal);
  if (!(cosine > 0)) return std::nullopt;
  view.incidence_rad = std::acos(std::min(1.0, cosine));
  const glm::dvec3 out = reflect(d, point.normal);

  const Wavefront pencil = reflected(spherical_wavefront(d, view.eye_distance_mm), d, out, point.surface);
  const auto [t, s] = plane_of_incidence(out, point.normal, point.surface.du);
  set_magnification(view, across(pencil.curvature, t, s), object_distance_mm);

  // The object's light comes the other way.
  const Wavefront arriving = spherical_wavefront(-out, object_distance_mm);
  const Wavefront at_eye =
      transferred(reflected(arriving, -out, -d, point.surface), -d, view.eye_distance_mm);
  const auto [te, se] = plane_of_incidence(-d, point.normal, point.surface.du);
  view.astigmatism_d = 1000 * 2 * across(at_eye.curvature, te, se).half_difference();
  return view;
}

ViewSummary summarize_view(const MirrorGlass& glass, const RadiusMap& map, const glm::dvec3& eye_mm,
                           double object_distance_mm) {
  ViewSummary summary;
  const auto center = glass.at({0, 0});
  const auto at_center = center ? mirror_view(*center, eye_mm, object_distance_mm) : std::nullopt;
  if (!at_center)
    throw Error("", glass.optic().name, "does not face the eye", "turn the mirror, or set flip = true");
  summary.center = *at_center;
  summary.least_magnification = kInfinity;
  summary.greatest_magnification = 0;
  double sum = 0;
  std::size_t count = 0;
  for (const GlassPoint& point : map.points) {
    const auto view = mirror_view(point, eye_mm, object_distance_mm);
    if (!view) continue;
    summary.least_magnification = std::min(summary.least_magnification, view->least);
    summary.greatest_magnification = std::max(summary.greatest_magnification, view->greatest);
    summary.greatest_anisotropy = std::max(summary.greatest_anisotropy, view->anisotropy);
    summary.greatest_astigmatism_d = std::max(summary.greatest_astigmatism_d, view->astigmatism_d);
    sum += std::sqrt(view->least * view->greatest);
    ++count;
  }
  summary.mean_magnification = sum / double(count);
  return summary;
}

}  // namespace catoptra::optics
