#include "optics/mirror_aim.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "cad_import/error.h"

namespace catoptra::optics {
namespace {

constexpr int kGridPerSide = 9;

/// Places spread over the zone: the middles of a grid's cells, and the corners, which are what is lost first.
struct Places {
  std::vector<glm::dvec2> inside, corners;
};

Places places_of(std::span<const GroundPolygon> zone, int wanted) {
  Places places;
  double area = 0;
  for (const GroundPolygon& part : zone) area += polygon_area_mm2(part);
  for (const GroundPolygon& part : zone) {
    glm::dvec2 low{1e300}, high{-1e300};
    for (const glm::dvec2& p : part) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      places.corners.push_back(p);
    }
    const glm::dvec2 size = high - low;
    const double share = std::max(1.0, wanted * size.x * size.y / area);
    const int columns = std::max(4, int(std::lround(std::sqrt(share * size.x / size.y))));
    const int rows = std::max(4, int(std::lround(share / columns)));
    for (int i = 0; i < columns; ++i)
      for (int j = 0; j < rows; ++j) {
        const glm::dvec2 place = low + size * glm::dvec2((i + 0.5) / columns, (j + 0.5) / rows);
        if (polygon_holds(part, place)) places.inside.push_back(place);
      }
  }
  return places;
}

/// Coverage decides, then how far inside the glass the worst place is.
struct Score {
  double coverage = -1, inside_mm = -kInfinity;
  [[nodiscard]] bool better_than(const Score& other) const {
    if (coverage != other.coverage) return coverage > other.coverage;
    return inside_mm > other.inside_mm;
  }
};

class AimSearch {
 public:
  AimSearch(const MirrorGlass& glass, const SightOptions& sight, std::span<const GroundPolygon> zone,
            const AimOptions& options)
      : glass_(glass),
        sight_(sight),
        options_(options),
        places_(places_of(zone, options.samples)),
        pivot_(options.pivot_mm.value_or(glass.frame().center_mm)) {}

  MirrorAim run() {
    MirrorAim aim;
    const Score start = score({0, 0});
    aim.coverage_before = start.coverage;
    glm::dvec2 best{0};
    Score best_score = start;
    const glm::dvec2 limit{options_.yaw_limit_rad, options_.pitch_limit_rad};
    for (int i = 0; i < kGridPerSide; ++i)
      for (int j = 0; j < kGridPerSide; ++j)
        consider(limit * glm::dvec2(grid_share(i), grid_share(j)), best, best_score);
    climb(limit, best, best_score);
    aim.yaw_rad = best.x;
    aim.pitch_rad = best.y;
    aim.pose = pose(best);
    aim.coverage = best_score.coverage;
    aim.inside_mm = best_score.inside_mm;
    const double slack = glm::radians(0.002);
    aim.at_yaw_stop = std::abs(best.x) > limit.x - slack;
    aim.at_pitch_stop = std::abs(best.y) > limit.y - slack;
    aim.evaluations = evaluations_;
    return aim;
  }

 private:
  static double grid_share(int i) { return 2.0 * i / (kGridPerSide - 1) - 1; }

  [[nodiscard]] MirrorPose pose(const glm::dvec2& angles) const {
    return aimed_pose(glass_, sight_.road, pivot_, angles.x, angles.y);
  }

  bool consider(const glm::dvec2& angles, glm::dvec2& best, Score& best_score) {
    const Score found = score(angles);
    if (!found.better_than(best_score)) return false;
    best = angles;
    best_score = found;
    return true;
  }

  /// Eight directions, step halved where none is better.
  void climb(const glm::dvec2& limit, glm::dvec2& best, Score& best_score) {
    constexpr std::array<glm::dvec2, 8> kWays{
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
    glm::dvec2 step = limit / double(kGridPerSide - 1);
    while (std::max(step.x, step.y) > glm::radians(0.001)) {
      bool moved = false;
      const glm::dvec2 from = best;
      for (const glm::dvec2& way : kWays) {
        const glm::dvec2 next{std::clamp(from.x + way.x * step.x, -limit.x, limit.x),
                              std::clamp(from.y + way.y * step.y, -limit.y, limit.y)};
        if (next != from) moved |= consider(next, best, best_score);
      }
      if (!moved) step *= 0.5;
    }
  }

  Score score(const glm::dvec2& angles) {
    ++evaluations_;
    SightOptions turned = sight_;
    turned.pose = pose(angles);
    const MirrorSight sight(glass_, turned);
    const std::size_t inner = places_.inside.size(), all = inner + places_.corners.size();
    std::vector<char> seen(inner);
    std::vector<double> inside(all);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, all, 32), [&](const auto& some) {
      for (std::size_t i = some.begin(); i < some.end(); ++i) {
        const glm::dvec2& place = i < inner ? places_.inside[i] : places_.corners[i - inner];
        inside[i] = sight.inside_glass_mm(place);
        if (i < inner) seen[i] = inside[i] > -1 && (sight.state(place) & kSeenByAny) != 0;
      }
    });
    return {double(std::count(seen.begin(), seen.end(), 1)) / double(inner),
            *std::min_element(inside.begin(), inside.end())};
  }

  const MirrorGlass& glass_;
  const SightOptions& sight_;
  AimOptions options_;
  Places places_;
  glm::dvec3 pivot_;
  int evaluations_ = 0;
};

}  // namespace

MirrorPose aimed_pose(const MirrorGlass& glass, const RoadFrame& road, const glm::dvec3& pivot_mm,
                      double yaw_rad, double pitch_rad) {
  // Turning up: the normal moves towards `upward`, which is a turn about `across` by -pitch (right-handed).
  const glm::dmat4 pitch = glm::rotate(glm::dmat4(1), -pitch_rad, glass.frame().across);
  const glm::dmat4 yaw = glm::rotate(glm::dmat4(1), yaw_rad, road.up);
  return {glm::dmat3(yaw * pitch), pivot_mm};
}

MirrorAim solve_aim(const MirrorGlass& glass, const SightOptions& sight, std::span<const GroundPolygon> zone,
                    const AimOptions& options) {
  if (!(options.yaw_limit_rad >= 0) || !(options.pitch_limit_rad >= 0))
    throw Error("", glass.optic().name, "the stops of the aim must not be negative");
  if (zone.empty()) throw Error("", glass.optic().name, "an aim needs a zone to look at");
  return AimSearch(glass, sight, zone, options).run();
}

}  // namespace catoptra::optics
