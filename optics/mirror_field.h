// What a driver sees of the road in a mirror: exact reflected rays from both eyes, the vehicle's own body in
// the way.
//
// A place on the ground counts as seen by an eye if the mirror has a reflection point for it within its
// outline, and neither the ray from the eye to that point nor the one from there to the ground meets the
// vehicle. Monocular: one eye's; binocular: both eyes at once; ambinocular: at least one, which is how fields
// are judged.
#pragma once

#include <array>
#include <functional>
#include <glm/mat3x3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "optics/ground_region.h"
#include "optics/mirror_glass.h"
#include "optics/ray_scene.h"

namespace catoptra::optics {

/// The vehicle on its flat ground. Ground coordinates are (behind, left) in mm: behind the vertical plane
/// through the ocular points, and to the left of the midpoint between them.
struct RoadFrame {
  glm::dvec3 origin_mm{0};      ///< on the ground, under the midpoint of the ocular points
  glm::dvec3 forward{0, 1, 0};  ///< unit, level
  glm::dvec3 left{-1, 0, 0};    ///< unit, level
  glm::dvec3 up{0, 0, 1};       ///< unit
  [[nodiscard]] glm::dvec3 point(const glm::dvec2& ground_mm, double height_mm = 0) const {
    return origin_mm - ground_mm.x * forward + ground_mm.y * left + height_mm * up;
  }
  /// Ground coordinates of the foot of a point, and its height.
  [[nodiscard]] glm::dvec3 coordinates(const glm::dvec3& point_mm) const;
};

/// Makes a frame from a direction of travel and an up (any lengths; `forward` is made level), a point of the
/// ground, and the midpoint of the ocular points. Throws catoptra::Error where the directions are parallel or
/// null.
[[nodiscard]] RoadFrame make_road_frame(const glm::dvec3& forward, const glm::dvec3& up,
                                        const glm::dvec3& ground_mm, const glm::dvec3& eye_mm);

/// The mirror turned about a fixed point.
struct MirrorPose {
  glm::dmat3 rotation{1};
  glm::dvec3 pivot_mm{0};
  [[nodiscard]] glm::dvec3 to_world(const glm::dvec3& p) const {
    return pivot_mm + rotation * (p - pivot_mm);
  }
  [[nodiscard]] glm::dvec3 to_glass(const glm::dvec3& p) const {
    return pivot_mm + glm::transpose(rotation) * (p - pivot_mm);
  }
};

/// Bits of a place's state. Index 0 is the first eye.
inline constexpr std::array<std::uint8_t, 2> kReflected{1, 2};  ///< the glass has a reflection point for it
inline constexpr std::array<std::uint8_t, 2> kSeen{4, 8};       ///< ... and nothing is in the way
inline constexpr std::uint8_t kDirect = 16;                     ///< seen without the mirror
inline constexpr std::uint8_t kSeenByAny = 12, kReflectedByAny = 3;

struct SightOptions {
  std::vector<glm::dvec3> eyes_mm;  ///< one or two
  RoadFrame road;
  const RayScene* vehicle = nullptr;   ///< in the way; committed; must outlive the sight
  const RayScene* attached = nullptr;  ///< what turns with the mirror: its edge and back
  MirrorPose pose;
  double clearance_mm = 20;  ///< what is lower than this over the ground hides no ground
  double height_mm = 0;      ///< of the looked-at plane over the ground
  double direct_limit_rad =
      0;  ///< direct view reaches so far from straight ahead, to both sides; 0: not asked for
  /// Only this part of the glass reflects (the spherical part of an aspheric mirror). Empty: all of it.
  std::function<bool(const GlassPoint&)> part;
};

class ReflectionFinder;

/// Looks from the eyes by way of the mirror. Const functions are safe from many threads.
class MirrorSight {
 public:
  /// Keeps `glass`.
  MirrorSight(const MirrorGlass& glass, SightOptions options);
  ~MirrorSight();
  MirrorSight(MirrorSight&&) noexcept;

  /// State bits of a place on the ground.
  [[nodiscard]] std::uint8_t state(const glm::dvec2& ground_mm) const;
  /// State bits (without kDirect) of what lies infinitely far in a direction.
  [[nodiscard]] std::uint8_t state_far(const glm::dvec3& direction) const;

  /// Greatest length over the eyes by which a place's reflection point lies inside the glass's outline, mm;
  /// negative beside it. Where no eye has one: below -10 m, and the lower the farther the mirror looks past
  /// the place. Obstruction is not asked.
  [[nodiscard]] double inside_glass_mm(const glm::dvec2& ground_mm) const;

  [[nodiscard]] const SightOptions& options() const { return options_; }
  [[nodiscard]] const MirrorGlass& glass() const { return *glass_; }

 private:
  [[nodiscard]] std::uint8_t state_of(std::size_t eye, const glm::dvec3& target, bool far) const;
  [[nodiscard]] bool blocked(const glm::dvec3& from, const glm::dvec3& to, double share) const;
  [[nodiscard]] bool sees_directly(const glm::dvec3& target) const;

  const MirrorGlass* glass_;
  SightOptions options_;
  std::vector<ReflectionFinder> finders_;  // one per eye
};

/// Areas of a zone by who sees them; they refer to exact rays, up to `uncertain_m2`.
struct FieldAreas {
  double zone_m2 = 0;
  double reflected_m2 = 0;  ///< ambinocular, as if nothing were in the way
  double covered_m2 = 0;    ///< ambinocular
  double binocular_m2 = 0;
  std::array<double, 2> monocular_m2{0, 0};  ///< by eye
  double obstructed_m2 = 0;                  ///< reflected but hidden by the vehicle
  double uncertain_m2 = 0;                   ///< see RegionMeasure::mixed_mm2
  std::vector<RegionCell> cells;
};
[[nodiscard]] FieldAreas measure_field(const MirrorSight& sight, std::span<const GroundPolygon> zone,
                                       const RegionOptions& options = {});

/// How far the field reaches over an edge of the zone.
struct EdgeMargin {
  glm::dvec2 from_mm{0}, to_mm{0};  ///< the edge, ground coordinates
  /// Least distance over the edge's places to the field's border: outwards where the place is seen; inwards,
  /// negative, where it is not, at most through its part of the zone.
  double margin_mm = 0;
  double limit_mm = 0;  ///< farther was not looked
};
/// One per edge of the zone that is not shared with another part of it, by ambinocular sight (obstruction
/// counts), at 33 places of the edge, to 1 mm.
[[nodiscard]] std::vector<EdgeMargin> field_margins(const MirrorSight& sight,
                                                    std::span<const GroundPolygon> zone,
                                                    double limit_mm = 10000);

/// The ground beside the vehicle that is seen neither directly nor in the mirror.
struct BlindZone {
  double region_m2 = 0, blind_m2 = 0, uncertain_m2 = 0;
  double from_mm = 0, to_mm = 0;  ///< extent behind the ocular points; both 0 where nothing is blind
  std::vector<RegionCell> cells;  ///< the blind ones, state 1
};
[[nodiscard]] BlindZone measure_blind_zone(const MirrorSight& sight, const GroundPolygon& region,
                                           const RegionOptions& options = {});

/// The glass's outline on the ground as one eye sees it, longest outline only, ground coordinates. What is
/// farther than `far_mm` or above the horizon is drawn at `far_mm` in its direction. For drawings.
[[nodiscard]] std::vector<glm::dvec2> field_outline(const MirrorSight& sight, std::size_t eye, double far_mm);

/// The level angle that the glass shows at the horizon around straight back, as if nothing were in the way:
/// azimuths of its ends, positive to the left. Nullopt where straight back is not shown.
struct HorizonAngle {
  double left_rad = 0, right_rad = 0;
  [[nodiscard]] double angle_rad() const { return left_rad - right_rad; }
};
[[nodiscard]] std::optional<HorizonAngle> horizon_angle(const MirrorSight& sight);

/// Where the road begins on the line `left_mm` to the left: the least distance behind from which on
/// everything up to the horizon is reflected (obstruction not asked). Nullopt where the horizon is not.
[[nodiscard]] std::optional<double> road_begins_mm(const MirrorSight& sight, double left_mm, double far_mm);

}  // namespace catoptra::optics
