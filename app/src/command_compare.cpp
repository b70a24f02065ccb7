// catoptra compare SCENE -o DIR
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include "app/src/error_picture.h"
#include "app/src/frame_timing.h"
#include "app/src/output_file.h"
#include "app/src/report.h"
#include "app/src/session.h"
#include "render/comparison.h"

namespace catoptra::app {
namespace {

struct CompareOptions {
  DrawingOptions drawing;
  std::string output;
  std::vector<std::string> modes{"pvrr", "hybrid", "cubemap"};
  std::optional<double> max_error_arcmin;
  int frames = 3;
};

struct ModeResult {
  render::Mode mode;
  render::Comparison comparison;
  std::vector<std::size_t> vertices;  ///< of each optic's mesh as drawn
  std::vector<double> retraced;       ///< fraction of each optic's pixels
  FrameTiming timing;
  nlohmann::ordered_json json;
};

FrameTiming time_mode(Session& session, render::Mode mode, int frames) {
  return time_frames(session.renderer(), mode, session.scene().camera, session.frame, frames,
                     session.progress);
}

std::vector<std::size_t> drawn_vertices(const render::Scene& scene, const render::FrameStats& stats) {
  std::vector<std::size_t> vertices;
  for (std::size_t i = 0; i < scene.optics.size(); ++i) {
    const bool told = i < stats.optics.size() && stats.optics[i].vertices > 0;
    vertices.push_back(told ? stats.optics[i].vertices : scene.optics[i].mesh.vertices.size());
  }
  return vertices;
}

std::vector<double> retraced_fractions(const render::Scene& scene, render::Mode mode,
                                       const render::FrameStats& stats) {
  std::vector<double> fractions;
  for (std::size_t i = 0; i < scene.optics.size(); ++i)
    fractions.push_back(
        retraced_fraction(mode, i < stats.optics.size() ? stats.optics[i] : render::OpticStats{}));
  return fractions;
}

ModeResult compare_mode(Session& session, render::Mode mode, const render::Frame& reference,
                        const CompareOptions& options) {
  render::FrameOptions frame_options = session.frame;
  frame_options.geometry = true;
  const render::RenderResult result = session.render(mode, frame_options);
  ModeResult compared{mode,
                      render::compare(reference, result.frame, session.scene()),
                      drawn_vertices(session.scene(), result.stats),
                      retraced_fractions(session.scene(), drawn_mode(mode, result), result.stats),
                      time_mode(session, mode, options.frames),
                      {}};
  const std::string name(render::mode_name(mode));
  const std::filesystem::path folder = options.output;
  write_picture(result.frame, folder / (name + ".png"), false);
  write_picture(error_picture(reference, render::error_map_arcmin(reference, result.frame)),
                folder / ("error_" + name + ".png"), false);
  compared.json = {{"optics", optics_json(session.scene(), drawn_mode(mode, result), result.stats,
                                          &compared.comparison.optics)},
                   {"maps", maps_json(result.stats)},
                   {"image", image_json(compared.comparison.image)},
                   {"time_ms", time_json(compared.timing)}};
  if (result.choice) compared.json["choice"] = choice_json(*result.choice);
  if (!result.warnings.empty()) compared.json["warnings"] = result.warnings;
  return compared;
}

void print_row(const char* mode, const std::string& optic, std::size_t vertices,
               const render::OpticError* error, const double* retraced, const render::ImageError* image,
               double ms) {
  std::printf("%-9s %-20.20s", mode, optic.c_str());
  if (vertices > 0)
    std::printf(" %8zu", vertices);
  else
    std::printf(" %8s", "-");
  if (error)
    std::printf(" %8zu %9.4g %9.4g %9.4g %9.4g %8.3g", error->pixels, error->arcmin.median, error->arcmin.p99,
                error->arcmin.p999, error->arcmin.max, error->screen_px.p99);
  else
    std::printf(" %8s %9s %9s %9s %9s %8s", "-", "-", "-", "-", "-", "-");
  if (retraced)
    std::printf(" %9.2f", 100 * *retraced);
  else
    std::printf(" %9s", "-");
  if (image)
    std::printf(" %7.2f %7.4f", std::min(image->psnr_db, kIdenticalPsnr_db), image->flip_mean);
  else
    std::printf(" %7s %7s", "-", "-");
  std::printf(" %9.2f\n", ms);
}

void print_table(const Session& session, const std::vector<ModeResult>& results, double raytrace_ms) {
  std::printf("%-9s %-20s %8s %8s %9s %9s %9s %9s %8s %9s %7s %7s %9s\n", "mode", "optic", "vertices",
              "pixels", "median'", "p99'", "p999'", "max'", "p99 px", "retr. %", "PSNR dB", "FLIP",
              "frame ms");
  for (const ModeResult& result : results) {
    const std::string name(render::mode_name(result.mode));
    const auto& optics = result.comparison.optics;
    if (optics.empty())
      print_row(name.c_str(), "", 0, nullptr, nullptr, &result.comparison.image, result.timing.median_ms());
    for (std::size_t i = 0; i < optics.size(); ++i)
      print_row(name.c_str(), session.scene().optics[i].name, result.vertices[i], &optics[i],
                &result.retraced[i], &result.comparison.image, result.timing.median_ms());
  }
  print_row("raytrace", "(the reference)", 0, nullptr, nullptr, nullptr, raytrace_ms);
  std::printf(
      "(' = arcmin at the optic between the exact direction and what is shown; retr.: share of the optic's "
      "pixels that are traced)\n");
}

/// Optics of which the reference shows no pixel, so that their errors are those of nothing.
std::vector<std::string> unseen_optics(const render::Frame& reference, const render::Scene& scene) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < scene.optics.size(); ++i)
    if (std::find(reference.optic_id.begin(), reference.optic_id.end(), std::int32_t(i)) ==
        reference.optic_id.end())
      warnings.push_back("optic '" + scene.optics[i].name +
                         "' shows in no pixel: its zeros in the table say nothing (see camera.eye, "
                         "camera.target and what stands before it)");
  if (scene.optics.empty()) warnings.push_back("the scene has no optic: only the pictures are compared");
  return warnings;
}

/// The check of --max-error-arcmin: every compared pixel of every optic in every mode. Where no pixel of any
/// optic was compared nothing was shown to hold, so the check does not pass.
int check_errors(const Session& session, const std::vector<ModeResult>& results, double allowed_arcmin) {
  int code = kExitDone;
  for (const ModeResult& result : results) {
    std::size_t pixels = 0;
    const std::string mode(render::mode_name(result.mode));
    for (std::size_t i = 0; i < result.comparison.optics.size(); ++i) {
      const render::OpticError& error = result.comparison.optics[i];
      pixels += error.pixels;
      if (error.pixels == 0 || error.arcmin.max <= allowed_arcmin) continue;
      std::fprintf(stderr, "catoptra: %s: mode %s, optic '%s': largest error %.4g arcmin, allowed %.4g\n",
                   session.scene().file.c_str(), mode.c_str(), session.scene().optics[i].name.c_str(),
                   error.arcmin.max, allowed_arcmin);
      code = kExitCheckFailed;
    }
    if (pixels > 0) continue;
    std::fprintf(stderr, "catoptra: %s: mode %s: no optic shows, so there is no error to check\n",
                 session.scene().file.c_str(), mode.c_str());
    code = kExitCheckFailed;
  }
  return code;
}

int run_compare(const CompareOptions& options, const CommonOptions& common) {
  const auto modes = parse_modes(options.modes);
  if (std::find(modes.begin(), modes.end(), render::Mode::raytrace) != modes.end())
    throw UsageError("mode 'raytrace' is the reference of every comparison", "leave it out of --modes");
  Session session(options.drawing, common);
  make_folder(options.output);
  const std::filesystem::path folder = options.output;

  render::FrameOptions frame_options = session.frame;
  frame_options.geometry = true;
  const render::RenderResult reference = session.render(render::Mode::raytrace, frame_options);
  write_picture(reference.frame, folder / "raytrace.png", false);
  for (std::string& warning : unseen_optics(reference.frame, session.scene())) {
    spdlog::warn(warning);
    session.file.scene.warnings.push_back(std::move(warning));
  }
  const FrameTiming reference_timing = time_mode(session, render::Mode::raytrace, options.frames);

  std::vector<ModeResult> results;
  nlohmann::ordered_json modes_json = nlohmann::ordered_json::object();
  for (const render::Mode mode : modes) {
    results.push_back(compare_mode(session, mode, reference.frame, options));
    modes_json[std::string(render::mode_name(mode))] = results.back().json;
  }
  const nlohmann::ordered_json report{
      {"scene", session.scene().file},
      {"resolution", {session.frame.width, session.frame.height}},
      {"modes", modes_json},
      {"raytrace", {{"time_ms", time_json(reference_timing)}, {"rays", reference_timing.rays_per_frame}}},
      {"warnings", session.scene().warnings},
      {"versions", versions_json()}};
  write_text(folder / "report.json", json_text(report));
  print_table(session, results, reference_timing.median_ms());
  if (std::fflush(stdout) != 0) throw Error("standard output", "", "cannot be written");
  return options.max_error_arcmin ? check_errors(session, results, *options.max_error_arcmin) : kExitDone;
}

}  // namespace

Command add_compare_command(CLI::App& root, CommonOptions& common) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* app =
      add_subcommand(root, common, "compare", "Measure how far each mode is from exact ray tracing");
  add_drawing_options(*app, options->drawing);
  app->add_option("-o,--output", options->output, "Folder for pictures, error pictures and report.json")
      ->required()
      ->option_text("DIR");
  app->add_option("--modes", options->modes, "Modes to compare (default pvrr,hybrid,cubemap)")
      ->delimiter(',')
      ->option_text("MODE,...");
  app->add_option("--max-error-arcmin", options->max_error_arcmin,
                  "Exit code 3 where a pixel's error exceeds it")
      ->check(at_least(0))
      ->option_text("A");
  app->add_option("--frames", options->frames, "Frames to time per mode (default 3)")
      ->check(CLI::Range(1, 100000))
      ->option_text("N");
  return {app, [options, &common] { return run_compare(*options, common); }};
}

}  // namespace catoptra::app
