#include "optics/mirror_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "optics/reflection.h"
#include "optics/vertex_hits.h"

namespace catoptra::optics {
namespace {

constexpr double kM2 = 1e-6;  // m2 in a mm2
constexpr int kPlacesPerEdge = 33;
constexpr double kMarginStep_mm = 50, kMarginAccuracy_mm = 1;

bool seen(const MirrorSight& sight, const glm::dvec2& place) {
  return (sight.state(place) & kSeenByAny) != 0;
}

/// Where `holds` stops being true on the way from 0 (true) to `limit`: steps, then halving.
template <typename Holds>
double last_true(Holds&& holds, double limit, double step, double accuracy) {
  double good = 0;
  while (good < limit) {
    const double next = std::min(limit, good + step);
    if (!holds(next)) {
      double bad = next;
      while (bad - good > accuracy) (holds((good + bad) / 2) ? good : bad) = (good + bad) / 2;
      return good;
    }
    good = next;
  }
  return limit;
}

/// Margin of one place of an edge; `outwards` is unit. Inwards the part of the zone is the limit.
double margin_at(const MirrorSight& sight, const GroundPolygon& part, const glm::dvec2& place,
                 const glm::dvec2& outwards, double limit) {
  if (seen(sight, place))
    return last_true([&](double d) { return seen(sight, place + d * outwards); }, limit, kMarginStep_mm,
                     kMarginAccuracy_mm);
  return -last_true(
      [&](double d) {
        const glm::dvec2 inside = place - d * outwards;
        return polygon_holds(part, inside) && !seen(sight, inside);
      },
      limit, kMarginStep_mm, kMarginAccuracy_mm);
}

bool shared(std::span<const GroundPolygon> zone, std::size_t own, const glm::dvec2& just_outside) {
  for (std::size_t i = 0; i < zone.size(); ++i)
    if (i != own && polygon_holds(zone[i], just_outside)) return true;
  return false;
}

std::optional<EdgeMargin> margin_of_edge(const MirrorSight& sight, std::span<const GroundPolygon> zone,
                                         std::size_t part, std::size_t edge, double limit) {
  const GroundPolygon& polygon = zone[part];
  EdgeMargin result{polygon[edge], polygon[(edge + 1) % polygon.size()], limit, limit};
  const glm::dvec2 along = result.to_mm - result.from_mm;
  glm::dvec2 outwards = glm::normalize(glm::dvec2(along.y, -along.x));
  if (polygon_holds(polygon, (result.from_mm + result.to_mm) * 0.5 + outwards)) outwards = -outwards;
  std::vector<glm::dvec2> places;
  for (int i = 0; i < kPlacesPerEdge; ++i) {
    const glm::dvec2 place = result.from_mm + (i + 0.5) / kPlacesPerEdge * along;
    if (!shared(zone, part, place + outwards)) places.push_back(place);
  }
  if (places.empty()) return std::nullopt;
  std::vector<double> margins(places.size());
  tbb::parallel_for(std::size_t(0), places.size(), [&](std::size_t i) {
    margins[i] = margin_at(sight, polygon, places[i], outwards, limit);
  });
  result.margin_mm = *std::min_element(margins.begin(), margins.end());
  return result;
}

}  // namespace

FieldAreas measure_field(const MirrorSight& sight, std::span<const GroundPolygon> zone,
                         const RegionOptions& options) {
  RegionMeasure measured = measure_region(
      zone, [&](const glm::dvec2& place) { return std::uint8_t(sight.state(place) & ~kDirect); }, options);
  FieldAreas areas;
  areas.zone_m2 = kM2 * measured.area_mm2;
  areas.reflected_m2 = kM2 * measured.area_of_any(kReflectedByAny);
  areas.covered_m2 = kM2 * measured.area_of_any(kSeenByAny);
  areas.binocular_m2 = kM2 * measured.area_of_all(kSeenByAny);
  for (std::size_t eye = 0; eye < 2; ++eye) areas.monocular_m2[eye] = kM2 * measured.area_of_any(kSeen[eye]);
  areas.obstructed_m2 = areas.reflected_m2 - areas.covered_m2;
  areas.uncertain_m2 = kM2 * measured.mixed_mm2;
  areas.cells = std::move(measured.cells);
  return areas;
}

std::vector<EdgeMargin> field_margins(const MirrorSight& sight, std::span<const GroundPolygon> zone,
                                      double limit_mm) {
  std::vector<EdgeMargin> margins;
  for (std::size_t part = 0; part < zone.size(); ++part)
    for (std::size_t edge = 0; edge < zone[part].size(); ++edge)
      if (const auto margin = margin_of_edge(sight, zone, part, edge, limit_mm)) margins.push_back(*margin);
  return margins;
}

BlindZone measure_blind_zone(const MirrorSight& sight, const GroundPolygon& region,
                             const RegionOptions& options) {
  const RegionMeasure measured = measure_region(
      std::span(&region, 1),
      [&](const glm::dvec2& place) {
        return std::uint8_t((sight.state(place) & (kSeenByAny | kDirect)) ? 0 : 1);
      },
      options);
  BlindZone blind;
  blind.region_m2 = kM2 * measured.area_mm2;
  blind.blind_m2 = kM2 * measured.area_of_any(1);
  blind.uncertain_m2 = kM2 * measured.mixed_mm2;
  blind.cells = measured.cells;
  if (blind.cells.empty()) return blind;
  blind.from_mm = kInfinity;
  blind.to_mm = -kInfinity;
  for (const RegionCell& cell : blind.cells) {
    blind.from_mm = std::min(blind.from_mm, cell.low_mm.x);
    blind.to_mm = std::max(blind.to_mm, cell.low_mm.x + cell.size_mm.x);
  }
  return blind;
}

std::vector<glm::dvec2> field_outline(const MirrorSight& sight, std::size_t eye, double far_mm) {
  const SightOptions& options = sight.options();
  const MirrorGlass& glass = sight.glass();
  std::vector<glm::dvec2> outline;
  const glm::dvec3 eye_mm = options.eyes_mm[eye];
  const glm::dvec3 from = options.pose.to_glass(eye_mm);
  if (glass.outlines().empty()) return outline;
  for (const glm::dvec3& border : glass.borders()[0]) {
    // The border's own normal: from the nearest vertex of the mesh, which it is.
    const auto& vertices = glass.optic().mesh.vertices;
    const auto vertex = std::find_if(vertices.begin(), vertices.end(),
                                     [&](const auto& v) { return v.position_mm == border; });
    const glm::dvec3 way = options.pose.rotation * reflect(glm::normalize(border - from), vertex->normal);
    const glm::dvec3 start = options.road.coordinates(options.pose.to_world(border));
    const glm::dvec2 level{-glm::dot(way, options.road.forward), glm::dot(way, options.road.left)};
    const double down = -glm::dot(way, options.road.up), length = glm::length(level);
    const double reach = down > 0 ? (start.z - options.height_mm) / down * length : kInfinity;
    outline.push_back(glm::dvec2(start) + level / std::max(length, 1e-12) * std::min(reach, far_mm));
  }
  return outline;
}

std::optional<HorizonAngle> horizon_angle(const MirrorSight& sight) {
  const RoadFrame& road = sight.options().road;
  const auto shown = [&](double azimuth) {
    const glm::dvec3 direction = -std::cos(azimuth) * road.forward + std::sin(azimuth) * road.left;
    return (sight.state_far(direction) & kReflectedByAny) != 0;
  };
  if (!shown(0)) return std::nullopt;
  const double limit = glm::half_pi<double>(), step = limit / 900, accuracy = 1e-6;
  return HorizonAngle{last_true(shown, limit, step, accuracy),
                      -last_true([&](double a) { return shown(-a); }, limit, step, accuracy)};
}

std::optional<double> road_begins_mm(const MirrorSight& sight, double left_mm, double far_mm) {
  if (!(sight.state_far(-sight.options().road.forward) & kReflectedByAny)) return std::nullopt;
  const double near = last_true(
      [&](double d) {
        return (sight.state({far_mm - d, left_mm}) & kReflectedByAny) != 0;
      },
      far_mm, far_mm / 1000, kMarginAccuracy_mm);
  return far_mm - near;
}

}  // namespace catoptra::optics
