// catoptra lens evaluate
#include <spdlog/spdlog.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>

#include "app/src/commands.h"
#include "app/src/lens_material.h"
#include "app/src/lens_report_writers.h"
#include "app/src/nearest_name.h"
#include "app/src/output_file.h"
#include "app/src/report.h"
#include "cad_import/import.h"

namespace catoptra::app {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

/// Where neither gaze nor place is asked for, degrees.
constexpr double kDefaultGazeMax_deg = 30, kDefaultGazeStep_deg = 10;

/// Beyond it a line of sight does not meet any spectacle lens.
constexpr double kMostGaze_deg = 80;

struct EvaluateOptions {
  std::string file, lens, material, catalogue, unit;
  std::optional<double> index, abbe;
  std::vector<std::string> front_faces, back_faces;
  std::string up;

  std::string mode = "lensmeter", eye = "right", cylinder = "minus", object_distance = "infinity";
  double rotation_centre = 25, vertex_distance = 12, panto = 0, wrap = 0;
  std::optional<double> gaze_max, gaze_step, map_step, wavelength;
  std::vector<std::string> gaze, points;
  std::string distance_point, near_point, addition_side = "front";
  int threads = 0;

  std::string rule, lens_type;
  std::optional<double> sphere, cyl, axis, prism, base, add, front_curve, thickness;
  bool strict = false;

  std::string json, csv;
};

/// `value` of `option` within [min, max]. Throws UsageError.
double checked(const char* option, double value, double min, double max) {
  if (std::isfinite(value) && value >= min && value <= max) return value;
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "%s %g is out of range", option, value);
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
  return {values[0], values[1]};
}

std::optional<optics::Medium> medium_of(const EvaluateOptions& options) {
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

LensSourceOptions source_options(const EvaluateOptions& options) {
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

optics::EvaluationOptions evaluation_options(const EvaluateOptions& options) {
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

std::vector<glm::dvec2> gaze_directions(const EvaluateOptions& options) {
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

std::optional<AdditionPoints> addition_points(const EvaluateOptions& options, bool ordered) {
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

LensType lens_type(const EvaluateOptions& options) {
  if (options.lens_type == "single-vision") return LensType::single_vision;
  if (options.lens_type == "multifocal") return LensType::multifocal;
  if (options.lens_type == "progressive" || options.add.value_or(0) > 0) return LensType::progressive;
  return LensType::single_vision;
}

bool has_order(const EvaluateOptions& o) {
  return o.sphere || o.cyl || o.axis || o.prism || o.base || o.add || o.front_curve || o.thickness ||
         !o.lens_type.empty();
}

LensOrder order_of(const EvaluateOptions& options) {
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
  order.prism = prism * glm::dvec2(std::cos(base), std::sin(base));
  order.addition_d = checked("--ordered-add", options.add.value_or(0), 0, 20);
  if (options.front_curve)
    order.front_curve_d = checked("--ordered-front-curve", *options.front_curve, -100, 100);
  if (options.thickness)
    order.center_thickness_mm = checked("--ordered-thickness", *options.thickness, 0.01, 100);
  return order;
}

void set_rule(const EvaluateOptions& options, LensReportOptions& report) {
  if (options.rule.empty()) {
    if (has_order(options))
      throw UsageError("--ordered-... and --lens-type need a --rule to be judged by",
                       "one of " + list_of_names(built_in_rules("lens")) + ", or a file");
    if (options.strict) throw UsageError("--strict needs a --rule");
    return;
  }
  report.order = order_of(options);
  try {
    report.rule = find_rule(options.rule, lens_rule_words());
  } catch (const UnknownRule& error) {
    throw UsageError("--rule: " + error.reason(), error.hint());
  }
}

/// Everything that needs no lens, so that a slip is told before the file is read.
LensReportOptions report_options(const EvaluateOptions& options) {
  if (options.json == "-" && options.csv == "-") throw UsageError("--json - excludes --csv -");
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

/// The d line, or the e line for a material that is quoted for it alone.
double reference_line_nm(const optics::Medium& medium) {
  return medium.nd == 0 && medium.ne > 0 ? optics::kLineE_nm : optics::kLineD_nm;
}

void add_map(const EvaluateOptions& options, const LensSource& source, LensReportOptions& report) {
  if (!options.map_step) return;
  try {
    report.points_mm = lens_map_points(source.lens, source.frame, *options.map_step);
  } catch (const Error& error) {
    throw UsageError("--map-step: the map " + error.reason(), error.hint());
  }
}

void write_results(const LensReport& report, const EvaluateOptions& options) {
  if (!options.json.empty()) write_text(options.json, json_text(lens_report_json(report)));
  const std::string limits = lens_limits_csv(report);
  if (options.csv == "-") {
    write_text("-", lens_report_csv(report) + (limits.empty() ? "" : "\n" + limits));
  } else if (!options.csv.empty()) {
    write_text(options.csv, lens_report_csv(report));
    std::filesystem::path beside = options.csv;
    beside.replace_extension(".limits.csv");
    if (!limits.empty()) write_text(beside, limits);
  }
  if (options.json != "-" && options.csv != "-") write_text("-", lens_report_text(report));
}

int run_evaluate(const EvaluateOptions& options, const CommonOptions& common) {
  LensReportOptions asked = report_options(options);
  LensSourceOptions from = source_options(options);
  Progress progress(!common.no_progress);
  from.progress = [&](double share, std::string_view what) { progress.show(share, what); };
  const LensSource source = load_lens(options.file, from);
  add_map(options, source, asked);
  if (!options.wavelength) asked.evaluation.wavelength_nm = reference_line_nm(source.lens.medium);
  progress.show(-1, "measuring");
  const LensReport report = lens_report(source, asked);
  progress.clear();
  for (const std::string& warning : report.warnings) spdlog::warn(warning);
  write_results(report, options);
  if (options.strict && !report.verdict->passed()) return kExitCheckFailed;
  return kExitDone;
}

void add_source_options(CLI::App& app, EvaluateOptions& options) {
  const auto add = [&app](const char* name, auto& value, const char* text, const char* shown) {
    return app.add_option(name, value, text)->option_text(shown)->group("The lens");
  };
  app.add_option("FILE", options.file,
                 "Lens (STEP, IGES, BREP) or scene (TOML; - reads one from standard input)")
      ->required();
  add("--lens", options.lens, "Of the lenses in a scene, or body of a CAD file that is the lens", "NAME");
  add("--index", options.index, "Refractive index at the wavelength, in place of --material", "N");
  add("--abbe", options.abbe, "Abbe number V_d, with --index at the d line (default: no dispersion)", "V");
  add("--material", options.material, "Material by name, such as CR-39; in place of a scene's", "M");
  add("--catalogue", options.catalogue,
      "Glass catalogue (.agf) or refractiveindex.info file (.yml) for --material", "FILE");
  add("--front-faces", options.front_faces, "Faces of the front: names, ids or indices (default: recognised)",
      "F,...")
      ->delimiter(',');
  add("--back-faces", options.back_faces, "Faces of the back", "F,...")->delimiter(',');
  add("--up", options.up, "Direction of the model that is up (default: +y of the lens's file)", "X,Y,Z");
  add("--unit", options.unit, "Length unit of the file's numbers, in place of its own", "UNIT");
}

void add_measurement_options(CLI::App& app, EvaluateOptions& options) {
  const auto add = [&app](const char* name, auto& value, const char* text, const char* shown) {
    return app.add_option(name, value, text)->option_text(shown)->group("Measurement");
  };
  add("--mode", options.mode, "lensmeter (default) or as-worn", "MODE")
      ->check(CLI::IsMember({"lensmeter", "as-worn"}));
  add("--gaze-max", options.gaze_max,
      "Gaze directions up to so many degrees from straight ahead (default 30)", "DEG");
  add("--gaze-step", options.gaze_step, "and so far apart (default 10)", "DEG");
  add("--gaze", options.gaze, "One gaze direction, degrees towards +x and up; may be repeated", "H,V")
      ->allow_extra_args(false);
  add("--points", options.points, "One point of the back surface, mm; may be repeated", "X,Y")
      ->allow_extra_args(false);
  add("--map-step", options.map_step, "A map over the back surface, points so far apart", "MM");
  add("--rotation-centre", options.rotation_centre,
      "Eye's rotation centre behind the back vertex (default 25)", "MM");
  add("--vertex-distance", options.vertex_distance, "Back vertex to cornea (default 12)", "MM");
  add("--panto-deg", options.panto, "Pantoscopic angle, positive: lower rim towards the face (default 0)",
      "A");
  add("--wrap-deg", options.wrap, "Face-form angle, positive: temporal rim towards the face (default 0)",
      "A");
  add("--object-distance", options.object_distance, "As worn: object before the front, mm (default infinity)",
      "MM");
  add("--eye", options.eye, "right (default) or left: where temporal and base out are", "EYE")
      ->check(CLI::IsMember({"right", "left"}));
  add("--wavelength", options.wavelength,
      "nm (default: d, 587.56; e for a material that is quoted for e alone)", "NM");
  add("--cylinder", options.cylinder, "Form that powers are written in: minus (default) or plus", "SIGN")
      ->check(CLI::IsMember({"plus", "minus"}));
  add("--near-point", options.near_point, "Measure the addition there, mm (default 0,-14 with --ordered-add)",
      "X,Y");
  add("--distance-point", options.distance_point, "and against there (default 0,0)", "X,Y");
  add("--addition-side", options.addition_side, "Side against the focimeter for it: front (default) or back",
      "SIDE")
      ->check(CLI::IsMember({"front", "back"}));
  add("--threads", options.threads, "CPU threads; 0: all. Results do not depend on it", "N")
      ->check(CLI::Range(0, 4096));
}

void add_order_options(CLI::App& app, EvaluateOptions& options) {
  const auto add = [&app](const char* name, auto& value, const char* text, const char* shown) {
    return app.add_option(name, value, text)->option_text(shown)->group("Limits");
  };
  add("--rule", options.rule, "Tolerances: a standard by name, or a rule file", "NAME|FILE");
  add("--ordered-sph", options.sphere, "What was ordered: sphere, D", "S");
  add("--ordered-cyl", options.cyl, "cylinder, D, either sign (default 0)", "C");
  add("--ordered-axis", options.axis, "its axis, TABO, degrees", "A");
  add("--ordered-prism", options.prism, "prism, prism dioptre (default 0)", "P");
  add("--ordered-base-deg", options.base, "its base, TABO, 0 to 360 degrees", "B");
  add("--ordered-add", options.add, "addition, D (default 0)", "D");
  add("--ordered-front-curve", options.front_curve, "true power (n - 1)/R of the front, D", "F");
  add("--ordered-thickness", options.thickness, "thickness at the center, mm", "T");
  add("--lens-type", options.lens_type, "default: progressive with --ordered-add, else single-vision", "TYPE")
      ->check(CLI::IsMember({"single-vision", "multifocal", "progressive"}));
  app.add_flag("--strict", options.strict,
               "Exit with 3 where a tolerance is exceeded, or none could be judged")
      ->group("Limits");
}

}  // namespace

Command add_lens_evaluate_command(CLI::App& lens, CommonOptions& common) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* app =
      add_subcommand(lens, common, "evaluate",
                     "Measure a lens: power, prism, astigmatism, distortion and colour, by the focimeter or "
                     "as worn");
  add_source_options(*app, *options);
  add_measurement_options(*app, *options);
  add_order_options(*app, *options);
  app->add_option("--json", options->json, "Write the report as JSON; - : standard output")
      ->option_text("R.json");
  app->add_option("--csv", options->csv, "Write the points as a table, limits beside it as R.limits.csv")
      ->option_text("R.csv");
  return {app, [options, &common] { return run_evaluate(*options, common); }};
}

}  // namespace catoptra::app
