// The form of lens_report.h for people.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <iterator>
#include <numbers>

#include "app/src/lens_report_writers.h"

namespace catoptra::app {
namespace {

using optics::LensPathEnd;

constexpr double kDegrees = 180 / std::numbers::pi;

/// More points than this are shown by the two lines through the middle only.
constexpr std::size_t kAllPoints = 60;

/// A cylinder below this is shown as none.
constexpr double kShownCylinder_d = 0.005;

/// Prism below this is shown without a base: no instrument tells its direction.
constexpr double kShownPrism = 0.005;

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

/// Without the sign of a zero that rounding makes.
double shown(double value, int decimals) {
  return std::abs(value) < 0.5 * std::pow(10.0, -decimals) ? 0.0 : value;
}

/// TABO writes 180 for 0; a power without cylinder has no axis to show.
std::string axis_text(const optics::SphereCylinder& power) {
  if (std::abs(power.cylinder_d) < kShownCylinder_d) return "-";
  const double axis = power.axis_rad * kDegrees;
  return format("%.1f", axis < 0.05 ? 180.0 : axis);
}

std::string power_text(const optics::SphereCylinder& power) {
  const std::string axis = axis_text(power);
  const std::string text = format("%+.3f", shown(power.sphere_d, 3));
  return axis == "-" ? text + " sph" : text + format(" / %+.3f x ", power.cylinder_d) + axis;
}

std::string prism_text(const glm::dvec2& prism) {
  const PrismBase base = prism_base(prism);
  if (base.prism < kShownPrism) return "0";
  return format("%.3f base %.1f", base.prism, base.base_rad * kDegrees);
}

std::string head_text(const LensReport& report) {
  const optics::EvaluationOptions& options = report.options.evaluation;
  const optics::WearingPosition& p = options.position;
  std::string text = report.lens + "\n";
  text += format("  material    %s (%.5g at %.2f nm%s)%s\n", report.material.c_str(), report.index,
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

/// One column of the table of points: two lines of heading, width and decimals.
struct Column {
  const char* top;
  const char* bottom;
  int width, decimals;
  double (*value)(const LensReportPoint&);
};

const Column kPlace[] = {
    {"gaze", "h deg", 7, 1, [](const LensReportPoint& p) { return p.measured.gaze_rad.x * kDegrees; }},
    {"", "v", 6, 1, [](const LensReportPoint& p) { return p.measured.gaze_rad.y * kDegrees; }},
    {"point", "x mm", 7, 1, [](const LensReportPoint& p) { return p.measured.point_mm.x; }},
    {"", "y", 6, 1, [](const LensReportPoint& p) { return p.measured.point_mm.y; }}};

const Column kPower[] = {{"sphere", "D", 8, 2, [](const LensReportPoint& p) { return p.power.sphere_d; }},
                         {"cyl", "D", 7, 2, [](const LensReportPoint& p) { return p.power.cylinder_d; }}};

double distortion_percent(const LensReportPoint& point) {
  return 100 * point.measured.distortion;
}

const Column kRest[] = {
    {"mean", "error D", 8, 2, [](const LensReportPoint& p) { return p.measured.mean_power_error_d; }},
    {"oblique", "ast. D", 8, 2, [](const LensReportPoint& p) { return p.measured.oblique_astigmatism_d; }},
    {"tang.", "D", 8, 2, [](const LensReportPoint& p) { return p.measured.tangential_d; }},
    {"sag.", "D", 8, 2, [](const LensReportPoint& p) { return p.measured.sagittal_d; }},
    {"prism", "h pd", 8, 2, [](const LensReportPoint& p) { return p.measured.prism.x; }},
    {"", "v", 7, 2, [](const LensReportPoint& p) { return p.measured.prism.y; }},
    {"object", "h deg", 8, 1, [](const LensReportPoint& p) { return p.measured.object_rad.x * kDegrees; }},
    {"", "v", 6, 1, [](const LensReportPoint& p) { return p.measured.object_rad.y * kDegrees; }},
    {"distort.", "%", 9, 2, distortion_percent},
    {"colour", "pd F-C", 8, 3, [](const LensReportPoint& p) { return p.measured.transverse_colour; }}};

constexpr int kAxisWidth = 7;

std::string header_text() {
  std::string top, bottom;
  const auto add = [&](const char* above, const char* below, int width) {
    top += format("%*s", width, above);
    bottom += format("%*s", width, below);
  };
  for (const Column& c : kPlace) add(c.top, c.bottom, c.width);
  for (const Column& c : kPower) add(c.top, c.bottom, c.width);
  add("axis", "deg", kAxisWidth);
  for (const Column& c : kRest) add(c.top, c.bottom, c.width);
  return top + "\n" + bottom + "\n";
}

/// Cells that are not known are dashes.
std::string cell_text(const Column& column, const LensReportPoint& point, bool known = true) {
  if (!known) return format("%*s", column.width, "-");
  return format("%*.*f", column.width, column.decimals, shown(column.value(point), column.decimals));
}

/// Distortion compares lines of sight: a focimeter has none.
bool defined(const Column& column, const LensReport& report) {
  return column.value != distortion_percent ||
         report.options.evaluation.mode == optics::EvaluationMode::as_worn;
}

std::string row_text(const LensReport& report, const LensReportPoint& point) {
  const LensPathEnd end = point.measured.end;
  const bool met = end != LensPathEnd::missed;
  std::string text;
  for (std::size_t i = 0; i < std::size(kPlace); ++i)
    text += cell_text(kPlace[i], point, met || point.asked_by_gaze == (i < 2));
  if (end == LensPathEnd::missed) return text + "  off the lens\n";
  if (end == LensPathEnd::total_reflection) return text + "  total reflection\n";
  if (end == LensPathEnd::rim) return text + "  through the rim\n";
  for (const Column& column : kPower) text += cell_text(column, point);
  text += format("%*s", kAxisWidth, axis_text(point.power).c_str());
  for (const Column& column : kRest) text += cell_text(column, point, defined(column, report));
  return text + "\n";
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
  text += header_text();
  for (const LensReportPoint& point : report.points)
    if (all || on_middle_lines(point)) text += row_text(report, point);
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
