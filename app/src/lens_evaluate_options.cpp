#include "app/src/lens_evaluate_options.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "app/src/commands.h"
#include "app/src/lens_material.h"
#include "app/src/nearest_name.h"
#include "cad_import/import.h"

namespace catoptra::app {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

/// Where neither gaze nor place is asked for, degrees.
constexpr double kDefaultGazeMax_deg = 30, kDefaultGazeStep_deg = 10;

/// No lens reaches farther than this, mm (or, of gaze, degrees: checked more closely after that).
constexpr double kFarthest_mm = 10000;

/// Beyond it a line of sight does not meet any spectacle lens.
constexpr double kMostGaze_deg = 80;

/// `value` of `option` within [min, max]. Throws UsageError.
double checked(const std::string& option, double value, double min, double max) {
  if (std::isfinite(value) && value >= min && value <= max) return value;
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "%s %g is out of range", option.c_str(), value);
  std::array<char, 80> hint{};
  std::snprintf(hint.data(), hint.size(), "%g to %g", min, max);
  throw UsageError(text.data(), hint.data());
}

/// A number that is the whole of `text`. Throws UsageError.
double number_of(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    throw UsageError(option + " '" + text + "' is not a number");
  return value;
}

/// "X,Y" or "X,Y,Z". Throws UsageError.
std::vector<double> numbers_of(const std::string& option, const std::string& text, std::size_t count) {
  std::vector<double> values;
  std::size_t begin = 0;
  for (std::size_t comma = 0; comma != std::string::npos; begin = comma + 1) {
    comma = text.find(',', begin);
    values.push_back(
        number_of(option, text.substr(begin, comma == std::string::npos ? comma : comma - begin)));
  }
  if (values.size() != count)
    throw UsageError(option + " '" + text + "' has " + std::to_string(values.size()) + " numbers",
                     std::to_string(count) + " are needed, with commas between them");
  return values;
}

glm::dvec2 point_of(const std::string& option, const std::string& text) {
  const auto values = numbers_of(option, text, 2);
  return {checked(option, values[0], -kFarthest_mm, kFarthest_mm),
          checked(option, values[1], -kFarthest_mm, kFarthest_mm)};
}

std::optional<optics::Medium> medium_of(const LensEvaluateOptions& options) {
  if (options.index && !options.material.empty()) throw UsageError("--index excludes --material");
  if (options.abbe && !options.index) throw UsageError("--abbe belongs to --index");
  if (!options.catalogue.empty() && options.material.empty())
    throw UsageError("--catalogue belongs to --material");
  if (options.index) {
    const double n = checked("--index", *options.index, 1.0001, 5);
    if (options.abbe) return optics::abbe_medium(n, checked("--abbe", *options.abbe, 1, 1000));
    optics::Medium medium = optics::constant_medium(n);
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "index %.6g", n);
    medium.name = name.data();
    return medium;
  }
  if (options.material.empty()) return std::nullopt;
  const auto media = lens_media(options.catalogue);
  try {
    return media.find(options.material);
  } catch (const Error& error) {
    throw UsageError("--material: " + error.entity() + " " + error.reason(), error.hint());
  }
}

/// By name, or by index where it is a number.
std::vector<FaceSelector> selectors_of(const std::vector<std::string>& names) {
  std::vector<FaceSelector> selectors;
  for (const std::string& name : names) {
    const bool index =
        !name.empty() && name.find_first_not_of("0123456789") == std::string::npos && name.size() < 9;
    selectors.push_back(index ? FaceSelector(std::stoi(name)) : FaceSelector(name));
  }
  return selectors;
}

optics::EvaluationOptions evaluation_options(const LensEvaluateOptions& options) {
  optics::EvaluationOptions result;
  result.mode =
      options.mode == "as-worn" ? optics::EvaluationMode::as_worn : optics::EvaluationMode::lensmeter;
  optics::WearingPosition& p = result.position;
  p.rotation_centre_mm = checked("--rotation-centre", options.rotation_centre, 1, 1000);
  p.vertex_distance_mm = checked("--vertex-distance", options.vertex_distance, 0.1, 1000);
  p.pantoscopic_rad = checked("--panto-deg", options.panto, -45, 45) * kRadians;
  p.wrap_rad = checked("--wrap-deg", options.wrap, -45, 45) * kRadians;
  p.eye = options.eye == "left" ? optics::Eye::left : optics::Eye::right;
  const bool far = options.object_distance == "infinity" || options.object_distance == "inf";
  if (!far && options.mode != "as-worn")
    throw UsageError("--object-distance belongs to --mode as-worn",
                     "a focimeter's light comes from infinity");
  if (!far)
    result.object_distance_mm =
        checked("--object-distance", number_of("--object-distance", options.object_distance), 1, 1e9);
  if (options.wavelength) result.wavelength_nm = checked("--wavelength", *options.wavelength, 380, 780);
  result.threads = std::size_t(options.threads);
  return result;
}

std::vector<glm::dvec2> gaze_directions(const LensEvaluateOptions& options) {
  const bool grid = options.gaze_max || options.gaze_step;
  if (grid && !options.gaze.empty()) throw UsageError("--gaze excludes --gaze-max and --gaze-step");
  if (!grid && options.gaze.empty() && (!options.points.empty() || options.map_step)) return {};
  std::vector<glm::dvec2> directions;
  for (const std::string& text : options.gaze) {
    const glm::dvec2 gaze = point_of("--gaze", text);
    for (const double angle : {gaze.x, gaze.y}) (void)checked("--gaze", angle, -kMostGaze_deg, kMostGaze_deg);
    directions.push_back(kRadians * gaze);
  }
  if (!directions.empty()) return directions;
  const double max = checked("--gaze-max", options.gaze_max.value_or(kDefaultGazeMax_deg), 0, kMostGaze_deg);
  const double step =
      checked("--gaze-step", options.gaze_step.value_or(kDefaultGazeStep_deg), 0.05, kMostGaze_deg);
  return optics::gaze_grid(max * kRadians, step * kRadians);
}

std::optional<AdditionPoints> addition_points(const LensEvaluateOptions& options, bool ordered) {
  if (!ordered && options.near_point.empty()) {
    if (!options.distance_point.empty()) throw UsageError("--distance-point belongs to --near-point");
    return std::nullopt;
  }
  AdditionPoints points;
  if (!options.distance_point.empty())
    points.distance_mm = point_of("--distance-point", options.distance_point);
  if (!options.near_point.empty()) points.near_mm = point_of("--near-point", options.near_point);
  points.on_front = options.addition_side == "front";
  return points;
}

LensType lens_type(const LensEvaluateOptions& options) {
  if (options.lens_type == "single-vision") return LensType::single_vision;
  if (options.lens_type == "multifocal") return LensType::multifocal;
  if (options.lens_type == "progressive" || options.add.value_or(0) > 0) return LensType::progressive;
  return LensType::single_vision;
}

bool has_order(const LensEvaluateOptions& o) {
  return o.sphere || o.cyl || o.axis || o.prism || o.base || o.add || o.front_curve || o.thickness ||
         !o.lens_type.empty();
}

LensOrder order_of(const LensEvaluateOptions& options) {
  if (!options.sphere)
    throw UsageError("--rule compares with an order", "give --ordered-sph and what else was ordered");
  if (options.cyl.value_or(0) != 0 && !options.axis) throw UsageError("--ordered-cyl needs --ordered-axis");
  if (options.prism.value_or(0) != 0 && !options.base)
    throw UsageError("--ordered-prism needs --ordered-base-deg");
  LensOrder order;
  order.type = lens_type(options);
  order.power = {checked("--ordered-sph", *options.sphere, -100, 100),
                 checked("--ordered-cyl", options.cyl.value_or(0), -100, 100),
                 checked("--ordered-axis", options.axis.value_or(180), 0, 180) * kRadians};
  const double prism = checked("--ordered-prism", options.prism.value_or(0), 0, 100);
  const double base = checked("--ordered-base-deg", options.base.value_or(0), 0, 360) * kRadians;
  // Rounded, so that a base straight up has nothing to the side.
  const auto component = [&](double share) { return std::round(prism * share * 1e12) / 1e12 + 0.0; };
  order.prism = {component(std::cos(base)), component(std::sin(base))};
  order.addition_d = checked("--ordered-add", options.add.value_or(0), 0, 20);
  if (options.front_curve)
    order.front_curve_d = checked("--ordered-front-curve", *options.front_curve, -100, 100);
  if (options.thickness)
    order.center_thickness_mm = checked("--ordered-thickness", *options.thickness, 0.01, 100);
  return order;
}

void set_rule(const LensEvaluateOptions& options, LensReportOptions& report) {
  if (options.rule.empty()) {
    if (has_order(options))
      throw UsageError("--ordered-... and --lens-type need a --rule to be judged by",
                       "one of " + list_of_names(built_in_rules("lens")) + ", or a file");
    if (options.strict) throw UsageError("--strict needs a --rule");
    return;
  }
  try {  // a name that is no rule is what there is to mend first
    report.rule = find_rule(options.rule, lens_rule_words());
  } catch (const UnknownRule& error) {
    throw UsageError("--rule: " + error.reason(), error.hint());
  }
  report.order = order_of(options);
}

}  // namespace

LensSourceOptions source_options(const LensEvaluateOptions& options) {
  LensSourceOptions source;
  source.medium = medium_of(options);
  source.name = options.lens;
  if (is_scene_file(options.file)) {
    if (!options.unit.empty() || !options.front_faces.empty() || !options.back_faces.empty())
      throw UsageError("--unit, --front-faces and --back-faces belong to CAD files",
                       "a scene says them itself");
  } else if (!source.medium) {
    throw UsageError("a CAD file does not say what the lens is made of",
                     "give --index N or --material NAME, such as --material CR-39");
  }
  if (!options.unit.empty()) {
    if (!cad_import::unit_in_mm(options.unit))
      throw UsageError("unknown unit '" + options.unit + "'", "known: mm, cm, m, in");
    source.unit = options.unit;
  }
  source.front_faces = selectors_of(options.front_faces);
  source.back_faces = selectors_of(options.back_faces);
  if (!options.lens.empty() && (!source.front_faces.empty() || !source.back_faces.empty()))
    throw UsageError("--lens excludes --front-faces and --back-faces");
  if (!options.up.empty()) {
    const auto up = numbers_of("--up", options.up, 3);
    source.up = glm::dvec3(up[0], up[1], up[2]);
    if (*source.up == glm::dvec3(0)) throw UsageError("--up has no direction");
  }
  return source;
}

LensReportOptions report_options(const LensEvaluateOptions& options) {
  if ((options.json == "-") + (options.csv == "-") + (options.html == "-") > 1)
    throw UsageError("only one of --json, --csv and --html can go to standard output");
  if (options.map_step && !options.points.empty()) throw UsageError("--map-step excludes --points");
  LensReportOptions report;
  report.evaluation = evaluation_options(options);
  report.cylinder = options.cylinder == "plus" ? optics::CylinderForm::plus : optics::CylinderForm::minus;
  report.gaze_rad = gaze_directions(options);
  for (const std::string& text : options.points) report.points_mm.push_back(point_of("--points", text));
  if (options.map_step) (void)checked("--map-step", *options.map_step, 0.01, 1000);
  report.drop_missed = options.map_step.has_value();
  set_rule(options, report);
  report.addition = addition_points(options, report.order && report.order->addition_d > 0);
  return report;
}

}  // namespace catoptra::app
