// A mirror of a scene, evaluated: measures, the field on the road, and a rule's verdicts. A plain record that
// the writers (JSON, text, HTML) share; nothing in here prints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene_file.h"
#include "app/src/file_hash.h"
#include "app/src/mirror_rules.h"
#include "optics/mirror_aim.h"
#include "optics/mirror_evaluation.h"
#include "optics/mirror_field.h"

namespace catoptra::app {

struct MirrorEvaluationOptions {
  std::string mirror;                ///< name; empty: the scene's only mirror
  std::optional<RuleFile> rule;      ///< nullopt: measures without verdicts
  std::optional<glm::dvec3> eye_mm;  ///< midpoint of the ocular points, in place of the scene's
  std::optional<double> far_mm;      ///< in place of the scene's
  double object_distance_mm = optics::kInfinity;
  std::optional<double> spherometer_base_mm;  ///< in place of the rule's
  std::optional<optics::AimOptions> aim;      ///< solve for the best attitude first
};

/// One requirement of the rule and what was found.
struct MirrorClause {
  std::string clause;       ///< where the rule says so
  std::string requirement;  ///< in words, with its sense ("at least")
  std::string unit;
  std::optional<double> value, limit;  ///< nullopt: infinite (a plane), or not measurable
  bool pass = false;
  Certainty certainty = Certainty::unverified;  ///< of the limit
  std::string source, note;
};

/// Where the side plane on the mirror's side, outboard of which zones lie, was taken from.
enum class SidePlane {
  scene,    ///< evaluation.left_side or right_side
  vehicle,  ///< the outermost place of the named vehicle's meshes behind the mirror
  mirror,   ///< the mirror's inner end: an assumption, where the scene tells neither
};

/// The vehicle as the evaluation took it, ground coordinates (behind, left) in mm.
struct VehicleSummary {
  optics::RoadFrame road;
  std::vector<glm::dvec3> eyes_mm;  ///< left one first
  bool mirror_left = true;
  std::optional<bool> driver_left;
  std::optional<double> side_left_mm;  ///< of the side plane on the mirror's side
  SidePlane side_from = SidePlane::scene;
  std::optional<double> median_left_mm;
  double far_mm = 0;
  std::vector<std::string> obstructions;  ///< names of the surroundings that count as vehicle
};

struct AimSummary {
  optics::MirrorAim aim;
  double yaw_limit_rad = 0, pitch_limit_rad = 0;
  glm::dvec3 rotate_deg{0},
      translate{0};  ///< the mirror's entry in the scene file, aimed; in the scene's units
};

struct MirrorEvaluation {
  std::string scene, mirror;
  std::string rule_id, rule_title, rule_edition, rule_note;  ///< empty without a rule
  optics::GlassFrame glass;
  glm::dvec2 glass_low_mm{0}, glass_high_mm{0};
  std::vector<std::vector<glm::dvec2>> glass_outlines;
  optics::RadiusMap map;
  std::vector<std::optional<optics::MirrorView>> views;  ///< one per point of the map
  optics::RadiusReadings readings;
  bool ten_readings = false;  ///< FMVSS's procedure; else R46's
  optics::ViewSummary view;
  double reflectance = 0;  ///< luminance of the scene's reflectance, 0..1
  VehicleSummary vehicle;
  /// The rule's, or, where it requires none, the ground around the mirror's field. ZonePart::figure is null.
  std::vector<ZonePart> zone;
  bool zone_required = false;
  optics::FieldAreas field;
  std::optional<optics::FieldAreas> spherical_field;  ///< of the spherical part alone, where there is another
  bool horizon_seen = false;                          ///< straight back, as if nothing were in the way
  std::vector<optics::EdgeMargin> margins;            ///< of a required zone, but for the cut for the horizon
  optics::BlindZone blind;
  optics::GroundPolygon blind_region;
  std::vector<std::vector<glm::dvec2>> outlines;  ///< of the glass on the ground, by eye
  std::optional<optics::HorizonAngle> horizon;    ///< of the eyes' midpoint
  std::optional<double> road_begins_mm;  ///< of the eyes' midpoint, on the median or straight behind it
  std::optional<AimSummary> aim;
  std::vector<MirrorClause> clauses;
  std::vector<InputFile>
      inputs;  ///< the scene's file, the mirror's, the vehicle's, and a rule's of one's own
  std::vector<std::string> notes;  ///< assumptions and shortcomings, one sentence each

  /// Whether a part of the glass is aspheric. Below a share of 0.98: what is less is the width of a cell of
  /// the map along the border.
  [[nodiscard]] bool has_aspheric_part() const { return map.spherical_share < 0.98; }
  [[nodiscard]] bool passes() const;               ///< every clause does; false without clauses
  [[nodiscard]] bool rests_on_unverified() const;  ///< some clause's limit is unverified
};

/// Throws catoptra::Error: no such mirror, a rule that refers to the median plane where the scene does not
/// tell it, a mirror that does not face the eye. A side plane that the scene does not tell is assumed, with a
/// note and VehicleSummary::side_from. The result does not depend on the number of threads.
[[nodiscard]] MirrorEvaluation evaluate_mirror(const SceneFile& scene,
                                               const MirrorEvaluationOptions& options);

/// The rule's verdicts on what `evaluation` holds.
[[nodiscard]] std::vector<MirrorClause> judge_mirror(const RuleFile& rule,
                                                     const MirrorEvaluation& evaluation);

}  // namespace catoptra::app
