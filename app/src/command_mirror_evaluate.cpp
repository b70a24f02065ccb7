// catoptra mirror evaluate
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>

#include <glm/trigonometric.hpp>
#include <memory>

#include "app/src/commands.h"
#include "app/src/mirror_evaluation_writers.h"
#include "app/src/mirror_page.h"
#include "app/src/output_file.h"
#include "app/src/report.h"

namespace catoptra::app {
namespace {

struct EvaluateOptions {
  std::string scene, mirror, rule, json, html;
  bool strict = false, aim = false;
  std::vector<double> eye, aim_limits_deg, aim_pivot;
  std::optional<double> far, object_distance_mm, base_mm;
  int threads = 0;
};

glm::dvec3 point_of(const std::vector<double>& numbers, double unit_mm) {
  return unit_mm * glm::dvec3(numbers[0], numbers[1], numbers[2]);
}

RuleFile rule_called(const std::string& name) {
  try {
    return find_rule(name, mirror_rule_words());
  } catch (const UnknownRule& error) {
    throw UsageError("--rule: " + error.reason(), error.hint());
  }
}

optics::AimOptions aim_options(const EvaluateOptions& options, double unit_mm) {
  optics::AimOptions aim;
  if (!options.aim_limits_deg.empty()) {
    if (options.aim_limits_deg[0] < 0 || options.aim_limits_deg[1] < 0)
      throw UsageError("--aim-limits must not be negative");
    aim.yaw_limit_rad = glm::radians(options.aim_limits_deg[0]);
    aim.pitch_limit_rad = glm::radians(options.aim_limits_deg[1]);
  }
  if (!options.aim_pivot.empty()) aim.pivot_mm = point_of(options.aim_pivot, unit_mm);
  return aim;
}

MirrorEvaluationOptions evaluation_options(const EvaluateOptions& options, double unit_mm) {
  MirrorEvaluationOptions result;
  result.mirror = options.mirror;
  if (!options.rule.empty()) result.rule = rule_called(options.rule);
  if (!options.eye.empty()) result.eye_mm = point_of(options.eye, unit_mm);
  if (options.far) result.far_mm = *options.far * unit_mm;
  result.object_distance_mm = options.object_distance_mm.value_or(optics::kInfinity);
  result.spherometer_base_mm = options.base_mm;
  if (options.aim || !options.aim_limits_deg.empty() || !options.aim_pivot.empty())
    result.aim = aim_options(options, unit_mm);
  return result;
}

int run_evaluate(const EvaluateOptions& options, const CommonOptions& common) {
  if (options.json == "-" && options.html == "-") throw UsageError("--json - excludes --html -");
  if (options.strict && options.rule.empty()) throw UsageError("--strict needs a rule", "give --rule");
  (void)evaluation_options(options, 1);  // wrong usage is told before minutes of import
  std::optional<tbb::global_control> limit;
  if (options.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(options.threads));
  Progress progress(!common.no_progress);
  SceneReadOptions reading;
  reading.progress = [&](double share, std::string_view what) { progress.show(share, what); };
  const SceneFile scene = read_scene(options.scene, reading);
  progress.clear();
  for (const std::string& warning : scene.scene.warnings) spdlog::warn(warning);
  progress.show(-1, "evaluating");
  const MirrorEvaluation evaluation = evaluate_mirror(scene, evaluation_options(options, scene.unit_mm));
  progress.clear();
  if (!options.json.empty()) write_text(options.json, json_text(mirror_json(evaluation)));
  if (!options.html.empty()) {
    progress.show(-1, "drawing");
    write_text(options.html, mirror_page(evaluation, scene));
    progress.clear();
  }
  if (options.json != "-" && options.html != "-") write_text("-", mirror_text(evaluation));
  return options.strict && !evaluation.passes() ? kExitCheckFailed : kExitDone;
}

void add_evaluate_options(CLI::App& app, EvaluateOptions& options) {
  app.add_option("SCENE", options.scene, "Scene file (TOML); - reads standard input")->required();
  app.add_option("--mirror", options.mirror, "Which mirror, where the scene has several")
      ->option_text("NAME");
  app.add_option(
         "--rule", options.rule,
         "R46-I, R46-II, R46-III, R46-IV, R46-V, FMVSS111-driver, FMVSS111-passenger, FMVSS111-inside, or a "
         "rule file; left out: measures only")
      ->option_text("RULE");
  app.add_flag("--strict", options.strict, "Exit with 3 where a clause of the rule fails");
  app.add_option("--json", options.json, "JSON report; - writes it to standard output")
      ->option_text("R.json");
  app.add_option("--html", options.html,
                 "Report as one page with the field on the road and maps of the glass, to open in a browser")
      ->option_text("R.html");
  app.add_option("--eye", options.eye,
                 "Midpoint of the ocular points, in the scene's units, in place of its own")
      ->delimiter(',')
      ->expected(3)
      ->option_text("X,Y,Z");
  app.add_option("--far", options.far, "Where the ground is cut for the horizon, in the scene's units")
      ->check(CLI::PositiveNumber)
      ->option_text("D");
  app.add_option(
         "--object-distance", options.object_distance_mm,
         "Of what is looked at from the mirror, mm, for magnification and astigmatism (default: infinite)")
      ->check(CLI::PositiveNumber)
      ->option_text("MM");
  app.add_option("--spherometer-base", options.base_mm,
                 "Distance of the spherometer's feet, mm (default: the rule's, else 38)")
      ->check(CLI::PositiveNumber)
      ->option_text("MM");
  app.add_flag("--aim", options.aim, "Turn the mirror for the best coverage of the rule's zone first");
  app.add_option(
         "--aim-limits", options.aim_limits_deg,
         "Stops of the mirror's drive about up and about its level axis, degrees either way (default 10,10)")
      ->delimiter(',')
      ->expected(2)
      ->option_text("YAW,PITCH");
  app.add_option("--aim-pivot", options.aim_pivot,
                 "Where it turns, in the scene's units (default: the glass's centre)")
      ->delimiter(',')
      ->expected(3)
      ->option_text("X,Y,Z");
  app.add_option("--threads", options.threads, "CPU threads; 0: all")
      ->check(CLI::Range(0, 4096))
      ->option_text("N");
}

}  // namespace

Command add_mirror_evaluate_command(CLI::App& mirror, CommonOptions& common) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* app = add_subcommand(mirror, common, "evaluate",
                                 "Measure a mirror and its field of view, and judge it by a rule");
  add_evaluate_options(*app, *options);
  return {app, [options, &common] { return run_evaluate(*options, common); }};
}

}  // namespace catoptra::app
