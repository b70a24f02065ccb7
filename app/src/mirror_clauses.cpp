// A rule's figures against what was measured.
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/trigonometric.hpp>

#include "app/src/mirror_evaluation.h"

namespace catoptra::app {
namespace {

/// Share by which a radius may miss its limit: CAD surfaces are within 1e-6 mm of what was meant, and a pin
/// that travels 0.06 mm (r 3000, feet 38 mm apart) turns that into 2e-5.
constexpr double kRadiusAccuracy = 1e-4;

/// Lengths on the outline are to 0.1 mm: the outline's chords and the search.
constexpr double kOutlineAccuracy_mm = 0.1;

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

class Judge {
 public:
  Judge(const RuleFile& rule, const MirrorEvaluation& e) : rule_(rule), e_(e) {}

  std::vector<MirrorClause> run() {
    field();
    radii();
    size();
    view();
    return std::move(clauses_);
  }

 private:
  [[nodiscard]] const RuleFigure* figure(std::string_view quantity) const {
    // A plane has no radius: it is in the range of the greatest.
    const double radius = std::isfinite(e_.readings.mean_mm) ? e_.readings.mean_mm : 1e300;
    return find_figure(rule_, quantity, "", {{"mean_radius_mm", radius}});
  }

  void add(const RuleFigure& figure, std::string requirement, double value, double limit, bool pass) {
    clauses_.push_back({figure.clause, std::move(requirement), figure.unit, finite(value), finite(limit),
                        pass, figure.certainty, figure.source, figure.note});
  }

  /// The zone's own figures may be less sure than the share asked for: the clause is as sure as its worst.
  void rest_on_zone() {
    for (const RuleFigure& zone : rule_.figures)
      if (zone.quantity == "field" || zone.quantity == "field_across_median")
        clauses_.back().certainty = std::max(clauses_.back().certainty, zone.certainty);
  }

  void field() {
    const double zone = e_.field.zone_m2;
    if (const RuleFigure* f = figure("coverage_min"); f && e_.zone_required) {
      const double share = 100 * e_.field.reflected_m2 / zone, slack = 100 * e_.field.uncertain_m2 / zone;
      add(*f, "share of the zone that the mirror shows, at least", share, *f->value,
          share >= *f->value - slack);
      rest_on_zone();
      if (e_.spherical_field) {
        const double part = 100 * e_.spherical_field->reflected_m2 / zone;
        const double part_slack = 100 * e_.spherical_field->uncertain_m2 / zone;
        add(*f, "the same by the spherical part alone, at least", part, *f->value,
            part >= *f->value - part_slack);
        rest_on_zone();
      }
      if (std::any_of(e_.zone.begin(), e_.zone.end(), [](const ZonePart& p) { return p.to_horizon; })) {
        add(*f, "the horizon straight back is shown (1: yes)", e_.horizon_seen, 1, e_.horizon_seen);
        clauses_.back().unit.assign(1, '1');
        rest_on_zone();
      }
    }
    if (const RuleFigure* f = figure("obstruction_max"); f && e_.zone_required) {
      const double share = 100 * e_.field.obstructed_m2 / zone;
      add(*f, "share of the zone that the vehicle hides, at most", share, *f->value, share <= *f->value);
      rest_on_zone();
    }
  }

  void radii() {
    const optics::RadiusReadings& r = e_.readings;
    if (const RuleFigure* f = figure("mean_radius_min"))
      add(*f, "mean radius of curvature, at least", r.mean_mm, *f->value,
          r.mean_mm >= *f->value * (1 - kRadiusAccuracy));
    if (const RuleFigure* f = figure("mean_radius_max"))
      add(*f, "mean radius of curvature, at most", r.mean_mm, *f->value,
          r.mean_mm <= *f->value * (1 + kRadiusAccuracy));
    if (const RuleFigure* f = figure("radius_difference_max"))
      add(*f, "difference of the two radii at a place, share of the mean, at most", 100 * r.worst_difference,
          *f->value, 100 * r.worst_difference <= *f->value);
    if (const RuleFigure* f = figure("radius_deviation_max"))
      add(*f, "deviation of a reading from the mean, share of it, at most", 100 * r.worst_deviation,
          *f->value, 100 * r.worst_deviation <= *f->value);
    if (const RuleFigure* f = figure("aspheric_radius_min"); f && e_.has_aspheric_part())
      add(*f, "least radius of the aspheric part, at least", e_.map.min_mm, *f->value,
          e_.map.min_mm >= *f->value * (1 - kRadiusAccuracy));
  }

  void size() {
    if (const RuleFigure* f = figure("rectangle")) {
      const double radius = e_.readings.mean_mm;
      const double reference = f->values.at("radius_mm"), flat = f->values.at("flat_width_mm");
      const double wanted = std::isfinite(radius) ? flat / (1 + reference / radius) : flat;
      const double found = optics::widest_rectangle_mm(e_.glass_outlines, f->values.at("height_mm"));
      add(*f,
          "width of a rectangle " + std::to_string(std::lround(f->values.at("height_mm"))) +
              " mm high on the glass, at least",
          found, wanted, found >= wanted - kOutlineAccuracy_mm);
    }
    if (const RuleFigure* f = figure("upright_segment_min")) {
      const double found = optics::longest_upright_mm(e_.glass_outlines);
      add(*f, "upright segment on the glass, at least", found, *f->value,
          found >= *f->value - kOutlineAccuracy_mm);
    }
  }

  void view() {
    if (const RuleFigure* f = figure("reflectance_min"))
      add(*f, "reflectance, at least", 100 * e_.reflectance, *f->value, 100 * e_.reflectance >= *f->value);
    if (const RuleFigure* f = figure("magnification_min"))
      add(*f, "least magnification, at least", e_.view.least_magnification, *f->value,
          e_.view.least_magnification >= *f->value);
    if (const RuleFigure* f = figure("horizon_angle_min")) {
      const double angle = e_.horizon ? glm::degrees(e_.horizon->angle_rad()) : 0;
      add(*f, "level angle at the horizon, at least", angle, *f->value, angle >= *f->value);
    }
    if (const RuleFigure* f = figure("road_begins_max")) {
      const double begins = e_.road_begins_mm ? *e_.road_begins_mm / 1000 : optics::kInfinity;
      add(*f, "the road is shown from here to the horizon, at most", begins, *f->value, begins <= *f->value);
    }
    if (const RuleFigure* f = figure("on_driver_side"); f && e_.vehicle.driver_left) {
      const bool on_it = *e_.vehicle.driver_left == e_.vehicle.mirror_left;
      add(*f, "the mirror is on the driver's side (1) or the passenger's (0)", on_it, *f->value,
          on_it == (*f->value != 0));
    }
  }

  const RuleFile& rule_;
  const MirrorEvaluation& e_;
  std::vector<MirrorClause> clauses_;
};

}  // namespace

std::vector<MirrorClause> judge_mirror(const RuleFile& rule, const MirrorEvaluation& evaluation) {
  return Judge(rule, evaluation).run();
}

}  // namespace catoptra::app
