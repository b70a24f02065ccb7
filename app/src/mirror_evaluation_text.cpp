// The form of mirror_evaluation.h for people.
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <glm/trigonometric.hpp>

#include "app/src/mirror_evaluation_writers.h"

namespace catoptra::app {
namespace {

class Lines {
 public:
  [[gnu::format(printf, 2, 3)]] void add(const char* format, ...) {
    std::array<char, 1024> line{};
    va_list values;
    va_start(values, format);
    std::vsnprintf(line.data(), line.size(), format, values);
    va_end(values);
    text += line.data();
    text += '\n';
  }
  std::string text;
};

std::string in_mm(double value) {
  if (!std::isfinite(value)) return "plane";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.1f mm", value);
  return text.data();
}

std::string number(const std::optional<double>& value) {
  if (!value) return "infinite";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.5g", *value);
  return text.data();
}

void add_glass(const MirrorEvaluation& e, Lines& lines) {
  lines.add("mirror '%s' of %s", e.mirror.c_str(), e.scene.c_str());
  lines.add("mean radius %s (%s, feet %g mm apart), principal radii %s to %s",
            in_mm(e.readings.mean_mm).c_str(), e.ten_readings ? "ten readings" : "three places",
            e.readings.base_mm, in_mm(e.map.min_mm).c_str(), in_mm(e.map.max_mm).c_str());
  if (e.has_aspheric_part())
    lines.add("aspheric outside %.0f %% of the glass", 100 * e.map.spherical_share);
  const optics::ViewSummary& v = e.view;
  lines.add(
      "magnification at the centre %.4f tangential, %.4f sagittal (eye %.0f mm away, incidence %.1f deg), "
      "%.4f to %.4f over the glass",
      v.center.tangential, v.center.sagittal, v.center.eye_distance_mm, glm::degrees(v.center.incidence_rad),
      v.least_magnification, v.greatest_magnification);
  lines.add("astigmatism at the centre %.4f D, at most %.4f D; anisotropy at most %.3f",
            v.center.astigmatism_d, v.greatest_astigmatism_d, v.greatest_anisotropy);
}

void add_field(const MirrorEvaluation& e, Lines& lines) {
  const optics::FieldAreas& f = e.field;
  if (e.zone_required)
    lines.add("field on the ground: %.3f of %.3f m2 required, %.2f %%", f.covered_m2, f.zone_m2,
              100 * f.covered_m2 / f.zone_m2);
  else
    lines.add("field on the ground: %.1f m2 up to %.0f m behind", f.covered_m2, e.vehicle.far_mm / 1000);
  lines.add(
      "  shown %.3f m2, of which the vehicle hides %.3f; left eye %.3f, right eye %.3f, both at once %.3f; "
      "each within %.3f m2",
      f.reflected_m2, f.obstructed_m2, f.monocular_m2[0], f.monocular_m2[1], f.binocular_m2, f.uncertain_m2);
  for (const optics::EdgeMargin& m : e.margins)
    lines.add("  margin over the edge (%.1f, %.1f) to (%.1f, %.1f) m: %s%.2f m", m.from_mm.x / 1000,
              m.from_mm.y / 1000, m.to_mm.x / 1000, m.to_mm.y / 1000,
              m.margin_mm >= m.limit_mm ? "at least " : "", m.margin_mm / 1000);
  if (e.horizon) lines.add("level angle at the horizon %.2f deg", glm::degrees(e.horizon->angle_rad()));
  if (e.blind.blind_m2 > 0)
    lines.add(
        "blind between direct view and mirror: %.2f of %.0f m2 beside the vehicle, from %.1f to %.1f m "
        "behind",
        e.blind.blind_m2, e.blind.region_m2, e.blind.from_mm / 1000, e.blind.to_mm / 1000);
}

void add_aim(const AimSummary& a, Lines& lines) {
  lines.add(
      "aimed: yaw %.3f deg (to the left%s), pitch %.3f deg (up%s); of the zone's places %.2f %% are seen "
      "(before: %.2f %%)",
      glm::degrees(a.aim.yaw_rad), a.aim.at_yaw_stop ? "; at the stop" : "", glm::degrees(a.aim.pitch_rad),
      a.aim.at_pitch_stop ? "; at the stop" : "", 100 * a.aim.coverage, 100 * a.aim.coverage_before);
  lines.add("  in the scene: rotate_deg = [%.4f, %.4f, %.4f], translate = [%.4f, %.4f, %.4f]", a.rotate_deg.x,
            a.rotate_deg.y, a.rotate_deg.z, a.translate.x, a.translate.y, a.translate.z);
}

void add_verdicts(const MirrorEvaluation& e, Lines& lines) {
  lines.add("%s: %s, %s", e.rule_id.c_str(), e.rule_title.c_str(), e.rule_edition.c_str());
  for (const MirrorClause& c : e.clauses)
    lines.add("  %s  %s: %s, limit %s %s  (%s%s)", c.pass ? "pass" : "FAIL", c.requirement.c_str(),
              number(c.value).c_str(), number(c.limit).c_str(), c.unit == "1" ? "" : c.unit.c_str(),
              c.clause.c_str(), c.certainty == Certainty::unverified ? ", limit unverified" : "");
  lines.add(
      "%s%s", e.passes() ? "passes" : "does not pass",
      e.rests_on_unverified() ? " (rests on figures that are not verified against the rule's text)" : "");
}

}  // namespace

std::string mirror_text(const MirrorEvaluation& e) {
  Lines lines;
  add_glass(e, lines);
  if (e.aim) add_aim(*e.aim, lines);
  add_field(e, lines);
  if (!e.rule_id.empty()) add_verdicts(e, lines);
  for (const std::string& note : e.notes) lines.add("note: %s", note.c_str());
  return lines.text;
}

}  // namespace catoptra::app
