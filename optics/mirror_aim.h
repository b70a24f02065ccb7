// The aim of a mirror: two angles about its pivot, solved for the best coverage of a zone between the stops
// of its drive.
#pragma once

#include <span>

#include "optics/mirror_field.h"

namespace catoptra::optics {

/// Stops of the drive, measured from the mirror's given attitude.
struct AimOptions {
  double yaw_limit_rad = 0.1745;       ///< about the road's up through the pivot, either way; >= 0
  double pitch_limit_rad = 0.1745;     ///< about the glass's level axis through the pivot, either way; >= 0
  std::optional<glm::dvec3> pivot_mm;  ///< left out: the glass's centre
  int samples = 400;                   ///< places of the zone that the search looks at
};

struct MirrorAim {
  double yaw_rad = 0;    ///< counter-clockwise seen from above
  double pitch_rad = 0;  ///< positive: the glass turns up
  MirrorPose pose;
  /// Share of the search's places that are seen, before and after.
  double coverage_before = 0, coverage = 0;
  /// Least distance of their reflection points from the glass's outline, mm; negative where some lie beside
  /// it.
  double inside_mm = 0;
  bool at_yaw_stop = false, at_pitch_stop = false;
  int evaluations = 0;
};

/// The attitude of yaw and pitch: pitch first, about the glass's own axis, then yaw.
[[nodiscard]] MirrorPose aimed_pose(const MirrorGlass& glass, const RoadFrame& road,
                                    const glm::dvec3& pivot_mm, double yaw_rad, double pitch_rad);

/// Most of the zone seen (ambinocular, obstruction counts); of equally good attitudes the one whose
/// reflection points stay farthest inside the glass's outline, which centres the zone in the mirror.
/// Deterministic: a grid over the stops, then a compass search down to 0.001 degrees. `sight.pose` is where
/// it starts from and must be the identity.
[[nodiscard]] MirrorAim solve_aim(const MirrorGlass& glass, const SightOptions& sight,
                                  std::span<const GroundPolygon> zone, const AimOptions& options = {});

}  // namespace catoptra::optics
