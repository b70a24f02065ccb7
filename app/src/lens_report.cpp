#include "app/src/lens_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "cad_import/lens_faces.h"
#include "optics/spectrum.h"

namespace catoptra::app {
namespace {

using optics::LensPathEnd;

/// Prism below this has no base direction: rounding of a centred lens.
constexpr double kNoPrism = 1e-9;

constexpr double kMostMapPoints = 4e6;

/// The standards' reference wavelengths are the d and e lines (ISO 7944), nm.
bool is_reference_line(double nm) {
  return std::abs(nm - optics::kLineD_nm) < 0.1 || std::abs(nm - optics::kLineE_nm) < 0.1;
}

/// The lens with the front against the focimeter's support.
struct TurnedOver {
  optics::Optic lens;
  optics::LensFrame frame;
};

TurnedOver turned_over(const optics::Optic& lens, const optics::LensFrame& frame) {
  TurnedOver turned{lens, frame};
  std::swap(turned.lens.faces, turned.lens.back.faces);
  std::swap(turned.lens.mesh, turned.lens.back.mesh);
  std::swap(turned.frame.front_vertex_mm, turned.frame.back_vertex_mm);
  turned.frame.z = -frame.z;
  turned.frame.x = -frame.x;
  return turned;
}

/// Axis of a power that was read from the other side of the lens.
optics::SphereCylinder seen_from_front(optics::PowerMatrix power, optics::CylinderForm form) {
  power.xy = -power.xy;
  return optics::sphere_cylinder(power, form);
}

LensAddition measure_addition(const optics::Optic& lens, const optics::LensFrame& frame,
                              const LensReportOptions& options) {
  const AdditionPoints& at = *options.addition;
  optics::EvaluationOptions evaluation = options.evaluation;
  evaluation.mode = optics::EvaluationMode::lensmeter;
  evaluation.chromatic = false;
  const auto measure = [&](const optics::Optic& l, const optics::LensFrame& f, double x_sign) {
    const std::array<glm::dvec2, 2> points{glm::dvec2(x_sign * at.distance_mm.x, at.distance_mm.y),
                                           glm::dvec2(x_sign * at.near_mm.x, at.near_mm.y)};
    return optics::LensEvaluator(l, f).at_points(points, evaluation).points;
  };
  const TurnedOver turned = at.on_front ? turned_over(lens, frame) : TurnedOver{};
  const auto points = at.on_front ? measure(turned.lens, turned.frame, -1) : measure(lens, frame, 1);
  for (const std::size_t i : {0u, 1u})
    if (points[i].end != LensPathEnd::passed)
      throw Error("", i == 0 ? "distance reference point" : "near reference point",
                  "no light gets through the lens there", "choose a point on the lens");
  const auto power = [&](const optics::LensPoint& point) {
    return at.on_front ? seen_from_front(point.power, options.cylinder)
                       : optics::sphere_cylinder(point.power, options.cylinder);
  };
  return {at, power(points[0]), power(points[1]), points[1].power.mean() - points[0].power.mean()};
}

void measure_shape(const optics::Optic& lens, LensReport& report) {
  const auto geometry = cad_import::measure_lens(lens.faces, lens.back.faces, lens.name);
  const double per_curvature = 1000 * (report.index - report.index_around);
  report.center_thickness_mm = geometry.center_thickness_mm;
  report.front_curve_d = per_curvature * glm::dvec2(geometry.front_curvature.k1, geometry.front_curvature.k2);
  report.back_curve_d = per_curvature * glm::dvec2(geometry.back_curvature.k1, geometry.back_curvature.k2);
}

void measure_points(const optics::Optic& lens, const optics::LensFrame& frame, LensReport& report) {
  const LensReportOptions& options = report.options;
  const optics::LensEvaluator evaluator(lens, frame);
  const auto at_gaze = evaluator.at_gaze(options.gaze_rad, options.evaluation);
  report.reference = optics::transposed(at_gaze.reference, options.cylinder);
  report.reference_prism = at_gaze.reference_prism;
  report.spectacle_magnification = at_gaze.spectacle_magnification;
  const double out = options.evaluation.position.eye == optics::Eye::right ? -1 : 1;
  const auto add = [&](const std::vector<optics::LensPoint>& points, bool by_gaze) {
    for (const optics::LensPoint& point : points)
      if (by_gaze || !options.drop_missed || point.end != LensPathEnd::missed)
        report.points.push_back(
            {point, by_gaze, optics::sphere_cylinder(point.power, options.cylinder), out * point.prism.x});
  };
  add(at_gaze.points, true);
  if (!options.points_mm.empty())
    add(evaluator.at_points(options.points_mm, options.evaluation).points, false);
}

void judge(LensReport& report) {
  const LensReportOptions& options = report.options;
  if (!options.rule || !options.order) return;
  LensReading reading{report.reference, report.reference_prism, std::nullopt,
                      0.5 * (report.front_curve_d.x + report.front_curve_d.y), report.center_thickness_mm};
  if (report.addition) reading.addition_d = report.addition->addition_d;
  report.verdict = judge_lens(*options.rule, *options.order, reading);
  if (!is_reference_line(options.evaluation.wavelength_nm))
    report.warnings.push_back(
        "tolerances hold at the d or the e line (ISO 7944), and the lens was measured at another wavelength");
}

}  // namespace

LensReport lens_report(const optics::Optic& lens, const optics::LensFrame& frame,
                       const LensReportOptions& options) {
  LensReport report;
  report.options = options;
  report.lens = lens.name;
  report.material = lens.medium.name;
  report.material_unverified = lens.medium.certainty == optics::Certainty::unverified;
  const auto indices = optics::lens_indices(lens, options.evaluation.wavelength_nm);
  report.index = indices.lens;
  report.index_around = indices.around;
  report.dispersion = lens.medium.index(optics::kLineF_nm) != lens.medium.index(optics::kLineC_nm);
  measure_shape(lens, report);
  measure_points(lens, frame, report);
  if (options.addition) report.addition = measure_addition(lens, frame, options);
  if (report.material_unverified)
    report.warnings.push_back("the figures of " + report.material + " are unverified");
  judge(report);
  return report;
}

LensReport lens_report(const LensSource& source, const LensReportOptions& options) {
  LensReport report = lens_report(source.lens, source.frame, options);
  report.inputs = source.inputs;
  if (options.rule && !options.rule->path.empty()) {
    const auto rule = input_files({{options.rule->path}});
    report.inputs.insert(report.inputs.end(), rule.begin(), rule.end());
  }
  report.warnings.insert(report.warnings.begin(), source.warnings.begin(), source.warnings.end());
  return report;
}

std::vector<glm::dvec2> lens_map_points(const optics::Optic& lens, const optics::LensFrame& frame,
                                        double step_mm) {
  glm::dvec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (const auto& vertex : lens.back.mesh.vertices) {
    const glm::dvec3 from_vertex = vertex.position_mm - frame.back_vertex_mm;
    const glm::dvec2 at(glm::dot(from_vertex, frame.x), glm::dot(from_vertex, frame.y));
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  const auto from = glm::ceil(low / step_mm), to = glm::floor(high / step_mm);
  const double count = (to.x - from.x + 1) * (to.y - from.y + 1);
  if (count > kMostMapPoints)
    throw Error(lens.name, "map", "would have " + std::to_string(std::llround(count)) + " points",
                "give a larger step");
  std::vector<glm::dvec2> points;
  for (double row = to.y; row >= from.y; --row)
    for (double column = from.x; column <= to.x; ++column)
      points.push_back(step_mm * glm::dvec2(column, row));
  return points;
}

PrismBase prism_base(const glm::dvec2& prism) {
  const double size = glm::length(prism);
  if (size < kNoPrism) return {size, 0};
  const double angle = std::atan2(prism.y, prism.x);
  return {size, angle < 0 ? angle + 2 * std::numbers::pi : angle};
}

std::string_view path_end_name(LensPathEnd end) {
  switch (end) {
    case LensPathEnd::passed:
      return "passed";
    case LensPathEnd::total_reflection:
      return "total_reflection";
    case LensPathEnd::rim:
      return "rim";
    default:
      return "missed";
  }
}

}  // namespace catoptra::app
