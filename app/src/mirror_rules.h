// The words of rule files about mirrors, and the ground zones they describe.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "app/src/rule_file.h"
#include "optics/ground_region.h"

namespace catoptra::app {

/// kind = "mirror"; docs/mirror-rules.md says what each quantity, variable and unit means.
[[nodiscard]] const RuleVocabulary& mirror_rule_words();

/// Where a rule's zone lies on a vehicle: ground coordinates of optics::RoadFrame (behind, left), mm.
struct ZonePlacement {
  double side_left_mm = 0;    ///< of the vehicle's side plane on the mirror's side
  double outwards = 1;        ///< +1: the mirror is on the left, -1: on the right
  double median_left_mm = 0;  ///< of the median plane
  double far_mm = 100000;     ///< stands for the horizon
};

/// One trapezoid of a zone.
struct ZonePart {
  optics::GroundPolygon polygon;  ///< near inner, near outer, far outer, far inner corner
  bool to_horizon = false;        ///< its far edge is the cut
  const RuleFigure* figure = nullptr;
};

/// The parts of the zone that `rule` requires; empty where it requires none. They do not overlap. Throws
/// catoptra::Error with the figure's line where one begins beyond its end, or beyond the cut.
[[nodiscard]] std::vector<ZonePart> required_zone(const RuleFile& rule, const ZonePlacement& placement);

/// Whether a zone of the rule refers to the vehicle's median plane.
[[nodiscard]] bool needs_median_plane(const RuleFile& rule);

}  // namespace catoptra::app
