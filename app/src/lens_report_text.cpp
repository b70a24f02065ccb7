#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <numbers>

#include "app/src/lens_report_writers.h"

namespace catoptra::app {
namespace {

using optics::LensPathEnd;

constexpr double kDegrees = 180 / std::numbers::pi;

/// More points than this are shown by the two lines through the middle only.
constexpr std::size_t kAllPoints = 60;

/// Prism below this is shown without a base: no instrument tells its direction.
constexpr double kShownPrism = 0.005;

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

std::string power_text(const optics::SphereCylinder& power) {
  return format("%+.3f / %+.3f x %.1f", power.sphere_d, power.cylinder_d, power.axis_rad * kDegrees);
}

std::string prism_text(const glm::dvec2& prism) {
  const PrismBase base = prism_base(prism);
  if (base.prism < kShownPrism) return format("%.3f", base.prism);
  return format("%.3f base %.1f", base.prism, base.base_rad * kDegrees);
}

std::string head_text(const LensReport& report) {
  const optics::EvaluationOptions& options = report.options.evaluation;
  const optics::WearingPosition& p = options.position;
  std::string text = report.lens + "\n";
  text += format("  material    %s, index %.5g at %.2f nm%s%s\n", report.material.c_str(), report.index,
                 options.wavelength_nm, report.dispersion ? "" : ", no dispersion known",
                 report.material_unverified ? " (unverified)" : "");
  text +=
      format("  form        %.3f mm thick at the center, curves front %+.3f %+.3f D, back %+.3f %+.3f D\n",
             report.center_thickness_mm, report.front_curve_d.x, report.front_curve_d.y,
             report.back_curve_d.x, report.back_curve_d.y);
  text += "  focimeter   " + power_text(report.reference) + " D, prism " +
          prism_text(report.reference_prism) +
          format(" at the back vertex; spectacle magnification %.4f\n", report.spectacle_magnification);
  if (report.addition)
    text += format("  addition    %+.3f D on the %s, from (%g, %g) to (%g, %g) mm\n",
                   report.addition->addition_d, report.addition->at.on_front ? "front" : "back",
                   report.addition->at.distance_mm.x, report.addition->at.distance_mm.y,
                   report.addition->at.near_mm.x, report.addition->at.near_mm.y);
  if (options.mode == optics::EvaluationMode::lensmeter) return text + "  mode        lensmeter\n";
  text += format(
      "  mode        as worn, %s eye: rotation centre %g mm, vertex distance %g mm, pantoscopic %g, wrap %g "
      "deg",
      p.eye == optics::Eye::right ? "right" : "left", p.rotation_centre_mm, p.vertex_distance_mm,
      p.pantoscopic_rad * kDegrees, p.wrap_rad * kDegrees);
  return text + (std::isfinite(options.object_distance_mm)
                     ? format(", object at %g mm\n", options.object_distance_mm)
                     : ", object at infinity\n");
}

constexpr char kHeader[] =
    "      gaze         point     sphere  cylinder   axis  mean pw  obl ast  tangen.  sagitt.    prism      "
    "dioptre   object        distort.  colour\n"
    "     h     v      x     y         D         D    deg  error D        D        D        D        h       "
    " v      h      v        %    pd F-C\n";

/// Cells that are not known are dashes.
std::string row_text(const LensReportPoint& point) {
  const optics::LensPoint& m = point.measured;
  const bool met = m.end != LensPathEnd::missed;
  std::string text = met || point.asked_by_gaze
                         ? format("%6.1f%6.1f", m.gaze_rad.x * kDegrees, m.gaze_rad.y * kDegrees)
                         : format("%6s%6s", "-", "-");
  text += met || !point.asked_by_gaze ? format(" %6.1f%6.1f", m.point_mm.x, m.point_mm.y)
                                      : format(" %6s%6s", "-", "-");
  if (m.end != LensPathEnd::passed) {
    const char* reason = m.end == LensPathEnd::missed             ? "off the lens"
                         : m.end == LensPathEnd::total_reflection ? "total reflection"
                                                                  : "through the rim";
    return text + "   " + reason + "\n";
  }
  text += format("  %+8.3f  %+8.3f %6.1f %+8.3f %+8.3f %+8.3f %+8.3f", point.power.sphere_d,
                 point.power.cylinder_d, point.power.axis_rad * kDegrees, m.mean_power_error_d,
                 m.oblique_astigmatism_d, m.tangential_d, m.sagittal_d);
  return text + format(" %+8.3f %+8.3f %6.2f %6.2f %+8.3f %9.3f\n", m.prism.x, m.prism.y,
                       m.object_rad.x * kDegrees, m.object_rad.y * kDegrees, 100 * m.distortion,
                       m.transverse_colour);
}

bool on_middle_lines(const LensReportPoint& point) {
  const glm::dvec2 at = point.asked_by_gaze ? point.measured.gaze_rad : point.measured.point_mm;
  return std::abs(at.x) < 1e-9 || std::abs(at.y) < 1e-9;
}

/// Largest of what users of a map ask first.
std::string extremes_text(const LensReport& report) {
  double error = 0, astigmatism = 0, prism = 0, colour = 0;
  std::size_t passed = 0;
  for (const LensReportPoint& point : report.points) {
    if (point.measured.end != LensPathEnd::passed) continue;
    ++passed;
    error = std::max(error, std::abs(point.measured.mean_power_error_d));
    astigmatism = std::max(astigmatism, std::abs(point.measured.oblique_astigmatism_d));
    prism = std::max(prism, glm::length(point.measured.prism));
    colour = std::max(colour, point.measured.transverse_colour);
  }
  return format(
      "  %zu of %zu points transmit; at most %.3f D mean power error, %.3f D oblique astigmatism, %.3f pd "
      "prism, "
      "%.3f pd colour\n",
      passed, report.points.size(), error, astigmatism, prism, colour);
}

std::string table_text(const LensReport& report) {
  if (report.points.empty()) return {};
  const bool all = report.points.size() <= kAllPoints;
  std::string text = "\n";
  text += kHeader;
  for (const LensReportPoint& point : report.points)
    if (all || on_middle_lines(point)) text += row_text(point);
  if (!all) text += "  (the middle row and column of the map; --csv and --json have all points)\n";
  return text + extremes_text(report);
}

std::string verdict_text(const LensReport& report) {
  if (!report.verdict) return {};
  const LensVerdict& verdict = *report.verdict;
  const RuleFile& rule = *report.options.rule;
  std::string text = "\n" + rule.edition + " (" + rule.id + "), " +
                     std::string(lens_type_name(report.options.order->type)) + ":\n";
  for (const LensLimit& limit : verdict.limits)
    text += format("  %s  %-62s  measured %+9.3f, off by %+.3f  [%s: %s]\n", limit.pass ? "pass" : "FAIL",
                   limit.requirement.c_str(), limit.measured, limit.deviation, limit.figure.clause.c_str(),
                   std::string(certainty_name(limit.figure.certainty)).c_str());
  for (const NotJudged& n : verdict.not_judged)
    text += "  ----  " + n.quantity + " is not judged: " + n.reason + "\n";
  text += verdict.limits.empty() ? "  nothing judged" : verdict.passed() ? "  passed" : "  FAILED";
  if (verdict.certainty() && *verdict.certainty() != Certainty::verified)
    text += ", resting on figures that are " + std::string(certainty_name(*verdict.certainty())) +
            ": confirm them in the standard";
  return text + "\n";
}

}  // namespace

std::string lens_report_text(const LensReport& report) {
  return head_text(report) + table_text(report) + verdict_text(report);
}

}  // namespace catoptra::app
