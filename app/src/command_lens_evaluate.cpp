// catoptra lens evaluate
#include <spdlog/spdlog.h>

#include <memory>

#include "app/src/commands.h"
#include "app/src/lens_evaluate_options.h"
#include "app/src/lens_page.h"
#include "app/src/lens_report_writers.h"
#include "app/src/output_file.h"
#include "app/src/report.h"

namespace catoptra::app {
namespace {

void add_map(const LensEvaluateOptions& options, const LensSource& source, LensReportOptions& report) {
  if (!options.map_step) return;
  try {
    report.points_mm = lens_map_points(source.lens, source.frame, *options.map_step);
  } catch (const Error& error) {
    throw UsageError("--map-step: the map " + error.reason(), error.hint());
  }
}

void write_results(const LensReport& report, const LensSource& source, const LensEvaluateOptions& options) {
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
  if (!options.html.empty()) write_text(options.html, lens_page(report, source));
  if (options.json != "-" && options.csv != "-" && options.html != "-")
    write_text("-", lens_report_text(report));
}

int run_evaluate(const LensEvaluateOptions& options, const CommonOptions& common) {
  LensReportOptions asked = report_options(options);
  LensSourceOptions from = source_options(options);
  Progress progress(!common.no_progress);
  from.progress = [&](double share, std::string_view what) { progress.show(share, what); };
  const LensSource source = load_lens(options.file, from);
  add_map(options, source, asked);
  if (!options.wavelength) asked.evaluation.wavelength_nm = optics::reference_line_nm(source.lens.medium);
  progress.show(-1, "measuring");
  const LensReport report = lens_report(source, asked);
  progress.clear();
  for (const std::string& warning : report.warnings) spdlog::warn(warning);
  write_results(report, source, options);
  if (options.strict && !report.verdict->passed()) return kExitCheckFailed;
  return kExitDone;
}

void add_source_options(CLI::App& app, LensEvaluateOptions& options) {
  const auto add = [&app](const char* name, auto& value, const char* text, const char* shown) {
    return app.add_option(name, value, text)->option_text(shown)->group("The lens");
  };
  app.add_option("FILE", options.file,
                 "Lens (STEP, IGES, BREP, FreeCAD) or scene (TOML; - reads one from standard input)")
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

void add_measurement_options(CLI::App& app, LensEvaluateOptions& options) {
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

void add_order_options(CLI::App& app, LensEvaluateOptions& options) {
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
  auto options = std::make_shared<LensEvaluateOptions>();
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
  app->add_option("--html", options->html, "Write the report as one page with maps, to open in a browser")
      ->option_text("R.html");
  return {app, [options, &common] { return run_evaluate(*options, common); }};
}

}  // namespace catoptra::app
