// Spherometers on the exact surface.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "cad_import/error.h"
#include "optics/mirror_evaluation.h"

namespace catoptra::optics {
namespace {

constexpr int kArcPoints = 201;

/// Places along a straight line of the frame that lie on the glass (and in `part`) without a gap around its
/// centre.
struct Arc {
  std::vector<GlassPoint> points;
  std::vector<double> length_mm;  ///< from the first
  [[nodiscard]] double total_mm() const { return length_mm.empty() ? 0 : length_mm.back(); }
};

bool counts(const std::optional<GlassPoint>& point, const GlassPart& part) {
  return point && (!part || part(*point));
}

/// How far the line runs on the glass from its centre, to 1e-6 mm.
double reach(const MirrorGlass& glass, const glm::dvec2& way, const GlassPart& part) {
  const glm::dvec2 size = glass.high_mm() - glass.low_mm();
  const double limit = std::max(size.x, size.y), step = limit / kArcPoints;
  double good = 0, bad = step;
  while (bad < limit && counts(glass.at(bad * way), part)) {
    good = bad;
    bad += step;
  }
  while (bad - good > 1e-6) (counts(glass.at((good + bad) / 2 * way), part) ? good : bad) = (good + bad) / 2;
  return good;
}

Arc arc_through_center(const MirrorGlass& glass, const glm::dvec2& way, const GlassPart& part) {
  Arc arc;
  const double low = -reach(glass, -way, part), high = reach(glass, way, part);
  for (int i = 0; i < kArcPoints; ++i) {
    const auto point = glass.at((low + (high - low) * i / (kArcPoints - 1)) * way);
    if (!point) continue;
    arc.length_mm.push_back(arc.points.empty()
                                ? 0
                                : arc.total_mm() +
                                      glm::distance(arc.points.back().surface.point, point->surface.point));
    arc.points.push_back(*point);
  }
  return arc;
}

/// The place after `share` of the arc's length.
GlassPoint place_along(const MirrorGlass& glass, const Arc& arc, double share) {
  const double wanted = share * arc.total_mm();
  const auto next = std::lower_bound(arc.length_mm.begin() + 1, arc.length_mm.end() - 1, wanted);
  const auto i = std::size_t(next - arc.length_mm.begin());
  const double part = (wanted - arc.length_mm[i - 1]) / (arc.length_mm[i] - arc.length_mm[i - 1]);
  const glm::dvec2 xy = arc.points[i - 1].xy_mm + part * (arc.points[i].xy_mm - arc.points[i - 1].xy_mm);
  return glass.at(xy).value_or(arc.points[i]);
}

void summarize(RadiusReadings& result) {
  double sum = 0;
  for (const RadiusReading& reading : result.readings) sum += reading.mean_mm();
  result.mean_mm = sum / double(result.readings.size());
  if (!std::isfinite(result.mean_mm)) {  // a plane: no radius to deviate from
    const bool all = std::all_of(result.readings.begin(), result.readings.end(), [](const RadiusReading& r) {
      return !std::isfinite(r.along_mm) && !std::isfinite(r.across_mm);
    });
    result.mean_mm = kInfinity;
    result.worst_difference = result.worst_deviation = all ? 0 : kInfinity;
    return;
  }
  for (const RadiusReading& reading : result.readings) {
    result.worst_difference =
        std::max(result.worst_difference, std::abs((reading.along_mm - reading.across_mm) / result.mean_mm));
    result.worst_deviation =
        std::max(result.worst_deviation, std::abs(reading.mean_mm() / result.mean_mm - 1));
  }
}

/// Reads at each place in `along`, and across it where wanted, with the longest base (halved from `base_mm`)
/// that fits.
RadiusReadings read_all(const MirrorGlass& glass, const std::vector<GlassPoint>& places,
                        const std::vector<glm::dvec3>& along, bool across_too, double base_mm) {
  for (int halving = 0; halving <= 4; ++halving, base_mm /= 2) {
    RadiusReadings result;
    result.base_mm = base_mm;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto one = spherometer_radius_mm(glass, places[i], along[i], base_mm);
      const auto other = across_too ? spherometer_radius_mm(glass, places[i],
                                                            glm::cross(places[i].normal, along[i]), base_mm)
                                    : one;
      if (one && other) result.readings.push_back({places[i].xy_mm, *one, *other});
    }
    if (result.readings.size() < places.size()) continue;
    summarize(result);
    return result;
  }
  throw Error("", glass.optic().name, "is too small for a spherometer", "give a shorter base");
}

}  // namespace

double radius_of_mm(double curvature) {
  return std::abs(curvature) * kStraight_mm < 1 ? kInfinity : 1 / curvature;
}

double RadiusReading::mean_mm() const {
  if (!std::isfinite(along_mm) || !std::isfinite(across_mm)) return kInfinity;
  return (along_mm + across_mm) / 2;
}

std::optional<double> spherometer_radius_mm(const MirrorGlass& glass, const GlassPoint& point,
                                            const glm::dvec3& direction, double base_mm) {
  const glm::dvec3 n = point.normal;
  const glm::dvec3 t = glm::normalize(direction - glm::dot(direction, n) * n);
  const glm::dvec3& p = point.surface.point;
  const auto foot1 = glass.meet(p - base_mm / 2 * t, n, point);
  const auto foot2 = glass.meet(p + base_mm / 2 * t, n, point);
  if (!foot1 || !foot2) return std::nullopt;
  const glm::dvec3 bar = foot2->surface.point - foot1->surface.point;
  const glm::dvec3 middle = (foot1->surface.point + foot2->surface.point) * 0.5;
  // The pin moves square to the bar, in the plane of both feet.
  const glm::dvec3 pin_way = glm::normalize(glm::cross(glm::cross(bar, n), bar));
  const auto pin = glass.meet(middle, pin_way, point);
  if (!pin) return std::nullopt;
  const double h = glm::dot(pin->surface.point - middle, pin_way), c = glm::length(bar) / 2;
  return radius_of_mm(2 * h / (c * c + h * h));
}

RadiusReadings readings_r46(const MirrorGlass& glass, double base_mm, const GlassPart& part) {
  const Arc upright = arc_through_center(glass, {0, 1}, part),
            level = arc_through_center(glass, {1, 0}, part);
  const bool along_upright = upright.total_mm() >= level.total_mm();
  const Arc& arc = along_upright ? upright : level;
  if (arc.points.size() < 3)
    throw Error("", glass.optic().name, "has no arc through its centre to measure a radius on");
  std::vector<GlassPoint> places;
  std::vector<glm::dvec3> along;
  for (const double share : {1.0 / 3, 0.5, 2.0 / 3}) {
    places.push_back(place_along(glass, arc, share));
    along.push_back(along_upright ? glass.frame().upward : glass.frame().across);
  }
  RadiusReadings result = read_all(glass, places, along, true, base_mm);
  result.along_upright = along_upright;
  return result;
}

RadiusReadings readings_fmvss(const MirrorGlass& glass, double base_mm) {
  std::vector<GlassPoint> places;
  std::vector<glm::dvec3> along;
  for (const bool level : {true, false}) {
    const Arc arc = arc_through_center(glass, level ? glm::dvec2(1, 0) : glm::dvec2(0, 1), {});
    if (arc.points.size() < 3) throw Error("", glass.optic().name, "has no arc through its centre");
    const double end = std::min(0.45, base_mm / 2 / arc.total_mm() + 0.02);
    for (int i = 0; i < 5; ++i) {
      places.push_back(place_along(glass, arc, end + (1 - 2 * end) * i / 4));
      along.push_back(level ? glass.frame().across : glass.frame().upward);
    }
  }
  return read_all(glass, places, along, false, base_mm);
}

}  // namespace catoptra::optics
