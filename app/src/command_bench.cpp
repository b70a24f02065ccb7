// catoptra bench SCENE
#include <algorithm>
#include <cstdio>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <optional>

#include "app/src/bench_ratios.h"
#include "app/src/frame_timing.h"
#include "app/src/output_file.h"
#include "app/src/report.h"
#include "app/src/session.h"

namespace catoptra::app {
namespace {

/// Readings of the bare packets, of which the median counts: enough to pass over a disturbed one.
constexpr int kBareRepetitions = 5;

struct BenchOptions {
  DrawingOptions drawing;
  std::vector<std::string> modes{"pvrr", "hybrid", "exact", "raytrace", "cubemap", "auto"};
  int frames = 20, multisample = 1;
  bool no_visibility_checks = false, json = false;
};

struct ModeTiming {
  std::string name;  ///< of the mode, or kRiding, kStatic
  FrameTiming timing;
};

// Mode pvrr besides with everything anew: eye and optics moving together through the scene, and all at rest.
constexpr const char* kRiding = "pvrr_riding";
constexpr const char* kStatic = "pvrr_static";

using nlohmann::ordered_json;

/// The tracer is the measure of every speed-up, so it always runs.
std::vector<render::Mode> modes_with_reference(const BenchOptions& options) {
  auto modes = parse_modes(options.modes);
  if (std::find(modes.begin(), modes.end(), render::Mode::raytrace) == modes.end())
    modes.push_back(render::Mode::raytrace);
  return modes;
}

const FrameTiming* timing_of(const std::vector<ModeTiming>& timings, std::string_view name) {
  const auto found =
      std::find_if(timings.begin(), timings.end(), [&](const ModeTiming& t) { return t.name == name; });
  return found == timings.end() ? nullptr : &found->timing;
}

/// Median over the frames of the whole frame over its two raster passes: frame by frame, so that a slow spell
/// of the machine weighs on both sides. Nullopt where the mode has no such passes.
std::optional<double> frame_over_raster_passes(const FrameTiming& timing) {
  const auto pass1 = timing.pass_ms.find("pass1"), pass2 = timing.pass_ms.find("pass2");
  if (pass1 == timing.pass_ms.end() || pass2 == timing.pass_ms.end()) return std::nullopt;
  std::vector<double> ratios;
  const std::size_t frames = std::min({timing.frame_ms.size(), pass1->second.size(), pass2->second.size()});
  for (std::size_t i = 0; i < frames; ++i)
    ratios.push_back(timing.frame_ms[i] / (pass1->second[i] + pass2->second[i]));
  if (ratios.empty()) return std::nullopt;
  return median(std::move(ratios));
}

ordered_json mode_json(const FrameTiming& timing, double raytrace_ms) {
  const auto [least, most] = std::minmax_element(timing.frame_ms.begin(), timing.frame_ms.end());
  return {{"frames", timing.frames},
          {"frame_ms", {{"min", *least}, {"median", timing.median_ms()}, {"max", *most}}},
          {"rays_per_frame", timing.rays_per_frame},
          {"vertices", timing.vertices},
          {"maps", timing.maps},
          {"maps_pruned", timing.maps_pruned},
          {"shadows", timing.shadows},
          {"speedup_vs_raytrace", raytrace_ms / timing.median_ms()},
          {"time_ms", pass_json(timing)}};
}

std::size_t triangle_count(const render::Scene& scene) {
  std::size_t count = 0;
  for (const auto& mesh : scene.surroundings) count += mesh.triangles.size();
  for (const auto& optic : scene.optics)
    count += optic.mesh.triangles.size() + optic.back.mesh.triangles.size();
  return count;
}

/// The fastest of the modes that mode auto says to meet the error; where it weighed nothing, its own.
render::Mode best_mode(const std::vector<ModeTiming>& timings) {
  const render::ModeChoice& choice = *timing_of(timings, "auto")->choice;
  render::Mode best = choice.mode;
  double least_ms = std::numeric_limits<double>::infinity();
  for (const render::ModeCost& cost : choice.costs) {
    const FrameTiming* timing = timing_of(timings, render::mode_name(cost.mode));
    if (!timing || !cost.meets_error || timing->median_ms() >= least_ms) continue;
    least_ms = timing->median_ms();
    best = cost.mode;
  }
  return best;
}

/// Median frame of mode auto over that of the best mode. Both draw in turns, so that a slow spell of the
/// machine weighs on both.
double auto_over_best(Session& session, const std::vector<ModeTiming>& timings, int frames) {
  render::FrameOptions frame = session.frame;
  frame.read_back = frame.reuse_static = false;
  const render::Mode best = best_mode(timings);
  std::vector<double> auto_ms, best_ms;
  for (int i = 0; i < frames; ++i) {
    auto_ms.push_back(time_frames(session.renderer(), render::Mode::automatic, session.scene().camera, frame,
                                  1, session.progress)
                          .median_ms());
    best_ms.push_back(
        time_frames(session.renderer(), best, session.scene().camera, frame, 1, session.progress)
            .median_ms());
  }
  return median(std::move(auto_ms)) / median(std::move(best_ms));
}

/// The ratios that do not follow from the frame times alone.
void add_ratios(Session& session, const std::vector<ModeTiming>& timings, int frames, ordered_json& report) {
  for (const std::string name : {"pvrr", kRiding, kStatic})
    if (const FrameTiming* pvrr = timing_of(timings, name))
      if (const auto ratio = frame_over_raster_passes(*pvrr)) report[name + "_over_raster_passes"] = *ratio;
  if (const FrameTiming* exact = timing_of(timings, "exact"), *pvrr = timing_of(timings, "pvrr");
      exact && pvrr)
    report["exact_over_pvrr"] = exact->median_ms() / pvrr->median_ms();
  if (timing_of(timings, "auto")) report["auto_over_best"] = auto_over_best(session, timings, frames);
  std::vector<double> bare;
  for (int i = 0; i < kBareRepetitions; ++i)
    bare.push_back(session.renderer().bare_packet_ms(session.scene().camera, session.frame));
  const double bare_ms = median(bare);
  report["bare_packet_ms"] = bare_ms;
  report["raytrace_over_bare_packets"] = timing_of(timings, "raytrace")->median_ms() / bare_ms;
  if (session.scene().optics.empty()) return;
  session.progress.show(-1, "timing commits of the ray scene");
  const CommitTimes commits = time_commits(session.scene());
  report["optic_commit_over_full_build"] = commits.optic_commit_ms / commits.full_build_ms;
  report["ray_scene_ms"] = {{"full_build", commits.full_build_ms}, {"optic_commit", commits.optic_commit_ms}};
  session.progress.show(-1, "timing tessellation");
  const MeshingTimes meshing = time_meshing(session.file);
  report["tessellate_over_brepmesh"] = meshing.kernel_ms / meshing.tessellate_ms;
  report["tessellation"] = {{"chord_mm", session.scene().settings.chord_mm},
                            {"tessellate_ms", meshing.tessellate_ms},
                            {"tessellate_triangles", meshing.tessellate_triangles},
                            {"brepmesh_ms", meshing.kernel_ms},
                            {"brepmesh_triangles", meshing.kernel_triangles}};
  session.progress.clear();
}

void print_ratio(const ordered_json& report, const char* key, const char* meaning) {
  if (report.contains(key)) std::printf("%-34s %10.4g  %s\n", key, report[key].get<double>(), meaning);
}

void print_table(const ordered_json& report) {
  std::printf("%s: %d x %d, %zu triangles\n", report["scene"].get<std::string>().c_str(),
              report["resolution"][0].get<int>(), report["resolution"][1].get<int>(),
              report["triangles"].get<std::size_t>());
  std::printf("%-11s %7s %9s %9s %9s %11s %8s %8s  %s\n", "mode", "frames", "min ms", "median", "max", "rays",
              "vertices", "speed-up", "passes (median ms)");
  for (const auto& [name, mode] : report["modes"].items()) {
    const auto& frame = mode["frame_ms"];
    std::printf("%-11s %7d %9.2f %9.2f %9.2f %11zu %8zu %8.2f ", name.c_str(), mode["frames"].get<int>(),
                frame["min"].get<double>(), frame["median"].get<double>(), frame["max"].get<double>(),
                mode["rays_per_frame"].get<std::size_t>(), mode["vertices"].get<std::size_t>(),
                mode["speedup_vs_raytrace"].get<double>());
    for (const auto& [pass_name, ms] : mode["time_ms"].items())
      std::printf(" %s %.3g", pass_name.c_str(), ms.get<double>());
    std::printf("\n");
    if (mode.contains("choice"))
      std::printf("%-11s drew by %s: %s\n", name.c_str(), mode["choice"]["mode"].get<std::string>().c_str(),
                  mode["choice"]["reason"].get<std::string>().c_str());
  }
  print_ratio(report, "pvrr_over_raster_passes", "pvrr frame / its own two raster passes");
  print_ratio(report, "pvrr_riding_over_raster_passes", "... with eye and optics moving together");
  print_ratio(report, "pvrr_static_over_raster_passes", "... with eye and optics at rest");
  print_ratio(report, "pvrr_colors_over_one_color", "pvrr frame with the lenses' wavelengths / with one");
  print_ratio(report, "pvrr_riding_colors_over_one_color", "... with eye and optics moving together");
  print_ratio(report, "pvrr_static_colors_over_one_color", "... with eye and optics at rest");
  print_ratio(report, "exact_over_pvrr", "exact frame / pvrr frame, everything anew");
  print_ratio(report, "auto_over_best", "auto frame / frame of the best mode that keeps the error asked for");
  print_ratio(report, "raytrace_over_bare_packets", "raytrace frame / bare ray packets for the same rays");
  print_ratio(report, "optic_commit_over_full_build", "moving an optic / building the ray scene");
  print_ratio(report, "tessellate_over_brepmesh", "times faster than the CAD kernel's mesher");
}

/// A head that turns and steps to and fro about the scene's camera, by as little as leaves the picture what
/// it is, and takes all optics along.
MoveScene ride(const render::Scene& scene) {
  return [&scene](int frame, render::Renderer& renderer, render::Camera& camera) {
    constexpr double kTurn_rad = 1e-3, kStep_mm = 0.2;
    const double phase = frame % 2 ? 1 + 0.001 * frame : -1 - 0.001 * frame;  // no place twice
    const glm::dvec3 eye = scene.camera.eye_mm;
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), phase * kTurn_rad, glm::normalize(scene.camera.up));
    const glm::dmat4 motion = glm::translate(glm::dmat4(1), eye + glm::dvec3(phase * kStep_mm)) * turned *
                              glm::translate(glm::dmat4(1), -eye);
    camera.eye_mm = glm::dvec3(motion * glm::dvec4(eye, 1));
    camera.target_mm = glm::dvec3(motion * glm::dvec4(scene.camera.target_mm, 1));
    camera.up = glm::dvec3(motion * glm::dvec4(scene.camera.up, 0));
    for (std::size_t i = 0; i < scene.optics.size(); ++i) renderer.place_optic(i, motion);
  };
}

/// One of the three states of mode pvrr. What moved goes back to its place afterwards.
FrameTiming time_pvrr(render::Renderer& renderer, const std::string& state, const render::Scene& scene,
                      render::FrameOptions frame, int frames, Progress& progress) {
  frame.reuse_static = state != "pvrr";
  const FrameTiming timing = time_frames(renderer, render::Mode::pvrr, scene.camera, frame, frames, progress,
                                         state == kRiding ? ride(scene) : MoveScene());
  for (std::size_t i = 0; i < scene.optics.size(); ++i) renderer.place_optic(i, glm::dmat4(1));
  return timing;
}

/// Every mode with everything anew in each frame, as where the eye moves; pvrr in its three states (paper,
/// section 5).
std::vector<ModeTiming> time_modes(Session& session, const BenchOptions& options,
                                   const std::vector<render::Mode>& modes) {
  render::FrameOptions frame = session.frame;
  frame.read_back = false;
  std::vector<ModeTiming> timings;
  frame.reuse_static = false;
  for (const render::Mode mode : modes) {
    if (mode == render::Mode::pvrr) {
      for (const std::string state : {"pvrr", kRiding, kStatic})
        timings.push_back({state, time_pvrr(session.renderer(), state, session.scene(), frame, options.frames,
                                            session.progress)});
      continue;
    }
    timings.push_back(
        {std::string(render::mode_name(mode)), time_frames(session.renderer(), mode, session.scene().camera,
                                                           frame, options.frames, session.progress)});
  }
  return timings;
}

/// What dispersion costs: pvrr frames as they are over frames with one wavelength a lens, in the three
/// states. Nothing is added where no lens has more than one.
void add_color_ratios(Session& session, const BenchOptions& options, const std::vector<ModeTiming>& timings,
                      ordered_json& report) {
  render::Scene scene = session.scene();
  bool dispersed = false;
  for (auto& optic : scene.optics) {
    dispersed = dispersed || (optic.kind == optics::OpticKind::lens && optic.wavelengths > 1);
    optic.wavelengths = 1;
  }
  if (!dispersed || !timing_of(timings, "pvrr")) return;
  render::FrameOptions frame = session.frame;
  frame.read_back = false;
  render::Renderer renderer(scene);
  for (const std::string name : {"pvrr", kRiding, kStatic}) {
    const FrameTiming one = time_pvrr(renderer, name, scene, frame, options.frames, session.progress);
    report[name + "_colors_over_one_color"] = timing_of(timings, name)->median_ms() / one.median_ms();
  }
}

int run_bench(const BenchOptions& options, const CommonOptions& common) {
  const auto modes = modes_with_reference(options);
  Session session(options.drawing, common);
  session.frame.multisample = options.multisample;
  session.frame.check_visibility = !options.no_visibility_checks;
  const auto timings = time_modes(session, options, modes);

  const double raytrace_ms = timing_of(timings, "raytrace")->median_ms();
  ordered_json by_mode = ordered_json::object();
  for (const ModeTiming& t : timings) {
    by_mode[t.name] = mode_json(t.timing, raytrace_ms);
    if (t.timing.choice) by_mode[t.name]["choice"] = choice_json(*t.timing.choice);
  }
  ordered_json report{{"scene", session.scene().file},
                      {"resolution", {session.frame.width, session.frame.height}},
                      {"triangles", triangle_count(session.scene())},
                      {"frames", options.frames},
                      {"multisample", options.multisample},
                      {"visibility_checks", !options.no_visibility_checks},
                      {"modes", by_mode}};
  add_color_ratios(session, options, timings, report);
  add_ratios(session, timings, options.frames, report);
  report["versions"] = versions_json();
  if (options.json)
    write_text("-", json_text(report));
  else
    print_table(report);
  if (std::fflush(stdout) != 0) throw Error("standard output", "", "cannot be written");
  return kExitDone;
}

}  // namespace

Command add_bench_command(CLI::App& root, CommonOptions& common) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* app = add_subcommand(root, common, "bench",
                                 "Time the modes on the same scene, with the same shading, in one run");
  add_drawing_options(*app, options->drawing);
  app->add_option("--modes", options->modes, "Modes to time (default all; raytrace always runs)")
      ->delimiter(',')
      ->option_text("MODE,...");
  app->add_option("--frames", options->frames, "Frames per mode, after one to warm up (default 20)")
      ->check(CLI::Range(1, 1000000))
      ->option_text("N");
  app->add_option("--multisample", options->multisample,
                  "Hardware multisampling of outlines: 1, 2, 4 or 8; not in mode raytrace")
      ->check(CLI::IsMember({1, 2, 4, 8}))
      ->option_text("N");
  app->add_flag("--no-visibility-checks", options->no_visibility_checks,
                "Mode pvrr: maps of the whole view for all planar optics turned to the eye, seen or not");
  app->add_flag("--json", options->json, "Print JSON");
  return {app, [options, &common] { return run_bench(*options, common); }};
}

}  // namespace catoptra::app
