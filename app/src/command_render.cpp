// catoptra render SCENE -o IMAGE
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/src/error_picture.h"
#include "app/src/output_file.h"
#include "app/src/report.h"
#include "app/src/session.h"
#include "render/comparison.h"
#include "render/image_io.h"

namespace catoptra::app {
namespace {

/// Mean FLIP up to which two pictures pass as the same. Measured on the door mirror of the examples:
/// rasterised instead of traced surroundings 0.005, the view turned by less than a pixel 0.06.
constexpr double kDefaultReferenceThreshold = 0.01;

struct RenderOptions {
  DrawingOptions drawing;
  std::string output, mode, report, reference, overlay;
  double reference_threshold = kDefaultReferenceThreshold;
  int samples = 1, multisample = 1;
  std::optional<double> pupil_mm, focus_mm;
  bool aov = false;
};

void check_usage(const RenderOptions& options) {
  if (options.report == "-" && options.output == "-")
    throw UsageError("the picture and the report cannot both go to standard output");
  if (!options.report.empty() && options.report == options.output)
    throw UsageError("-o and --report name the same file");
}

/// The picture that --overlay error asks for: how far each pixel of the optics is from exact ray tracing.
render::Frame error_overlay(Session& session, render::FrameOptions options, const render::Frame& frame) {
  options.samples = 1;
  options.overlay_vertices = options.overlay_rays = false;
  const auto reference = session.render(render::Mode::raytrace, options);
  return error_picture(frame, render::error_map_arcmin(reference.frame, frame));
}

nlohmann::ordered_json report_json(const Session& session, render::Mode mode, const RenderOptions& options,
                                   const render::RenderResult& result) {
  nlohmann::ordered_json warnings = session.scene().warnings;
  for (const std::string& warning : result.warnings) warnings.push_back(warning);
  nlohmann::ordered_json json{{"scene", session.scene().file},
                              {"resolution", {session.frame.width, session.frame.height}},
                              {"mode", render::mode_name(mode)}};
  if (result.choice) json["choice"] = choice_json(*result.choice);
  json.update({{"samples", options.samples},
               {"multisample", options.samples > 1 ? 1 : options.multisample},
               {"optics", optics_json(session.scene(), drawn_mode(mode, result), result.stats, nullptr)},
               {"maps", maps_json(result.stats)},
               {"maps_pruned", result.stats.maps_pruned},
               {"shadows", shadows_json(result.stats)},
               {"rays", result.stats.rays},
               {"time_ms", result.stats.time_ms},
               {"warnings", warnings},
               {"versions", versions_json()}});
  return json;
}

struct ReferenceCheck {
  nlohmann::ordered_json json;
  bool passed = false;
};

/// The colours that a screen shows: 8-bit sRGB. A reference read from PNG is that already, and FLIP judges
/// displayed pictures: without this the rounding of a PNG alone counts as 0.01 in saturated colours.
render::Frame as_displayed(render::Frame frame) {
  const auto rounded = [](float linear) {
    const float encoded = render::linear_to_srgb(std::clamp(linear, 0.0f, 1.0f));
    return render::srgb_to_linear(std::round(encoded * 255) / 255);
  };
  for (glm::vec4& color : frame.color) color = {rounded(color.r), rounded(color.g), rounded(color.b), 1};
  return frame;
}

ReferenceCheck check_reference(const render::Frame& reference, const render::Frame& frame,
                               const RenderOptions& options) {
  const render::ImageError error = render::image_error(as_displayed(reference), as_displayed(frame));
  const bool passed = error.flip_mean <= options.reference_threshold;
  auto json = image_json(error);
  json["file"] = options.reference;
  json["threshold"] = options.reference_threshold;
  json["passed"] = passed;
  return {json, passed};
}

/// Read before the rendering: a missing reference is an error, and better told at once.
std::optional<render::Frame> read_reference(const RenderOptions& options, const render::FrameOptions& frame) {
  if (options.reference.empty()) return std::nullopt;
  render::Frame reference = render::read_image(options.reference);
  if (reference.width != frame.width || reference.height != frame.height)
    throw Error(options.reference, "",
                "is " + std::to_string(reference.width) + " x " + std::to_string(reference.height) +
                    " pixels, the picture " + std::to_string(frame.width) + " x " +
                    std::to_string(frame.height),
                "use --resolution, or render the reference again");
  return reference;
}

void check_overlay(const RenderOptions& options, render::Mode mode) {
  if (options.overlay == "retraced" && mode != render::Mode::exact)
    throw UsageError("overlay 'retraced' belongs to mode 'exact', and this is '" +
                         std::string(render::mode_name(mode)) + "'",
                     "add --mode exact");
  // Its optics show what exact rays meet, not what the vertices' rays do.
  if ((options.overlay == "vertices" || options.overlay == "rays") && mode == render::Mode::exact)
    throw UsageError("overlay '" + options.overlay + "' belongs to mode 'pvrr', and this is 'exact'",
                     "add --mode pvrr, or ask for --overlay retraced");
  if (options.overlay == "patches" && mode != render::Mode::pvrr)
    throw UsageError("overlay 'patches' belongs to mode 'pvrr', and this is '" +
                         std::string(render::mode_name(mode)) + "'",
                     "add --mode pvrr");
}

int run_render(const RenderOptions& options, const CommonOptions& common) {
  check_usage(options);
  std::optional<render::Mode> mode;
  if (!options.mode.empty()) mode = parse_mode(options.mode);
  check_picture_path(options.output);
  Session session(options.drawing, common);
  if (options.pupil_mm) session.file.scene.camera.pupil_mm = *options.pupil_mm;
  if (options.focus_mm) session.file.scene.camera.focus_mm = *options.focus_mm;
  if (!mode) mode = parse_mode(session.scene().settings.mode);
  check_overlay(options, *mode);
  const auto reference = read_reference(options, session.frame);

  render::FrameOptions frame_options = session.frame;
  frame_options.samples = options.samples;
  frame_options.multisample = options.multisample;
  frame_options.overlay_vertices = options.overlay == "vertices" || options.overlay == "rays";
  frame_options.overlay_rays = options.overlay == "rays";
  frame_options.overlay_patches = options.overlay == "patches";
  const bool layers = options.aov || !options.report.empty();
  frame_options.geometry = layers || options.overlay == "error";
  render::RenderResult result = session.render(*mode, frame_options);
  if (options.overlay == "error") {
    const render::Frame picture = error_overlay(session, frame_options, result.frame);
    result.frame.color = picture.color;
  }
  if (options.overlay == "retraced")
    result.frame.color = marked_picture(result.frame, result.frame.retraced).color;
  write_picture(result.frame, options.output, layers);

  auto report = report_json(session, *mode, options, result);
  ReferenceCheck check{{}, true};
  if (reference) {
    check = check_reference(*reference, result.frame, options);
    report["reference"] = check.json;
  }
  if (!options.report.empty()) write_text(options.report, json_text(report));
  if (!check.passed)
    std::fprintf(stderr, "catoptra: %s: differs from the reference %s: mean FLIP %.4g, allowed %.4g\n",
                 options.output.c_str(), options.reference.c_str(), check.json["flip_mean"].get<double>(),
                 options.reference_threshold);
  return check.passed ? kExitDone : kExitCheckFailed;
}

}  // namespace

Command add_render_command(CLI::App& root, CommonOptions& common) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* app = add_subcommand(root, common, "render", "Draw a scene");
  add_drawing_options(*app, options->drawing);
  app->add_option("-o,--output", options->output,
                  "Picture to write, .png or .exr; - writes PNG to standard output")
      ->required()
      ->option_text("IMAGE");
  app->add_option("--mode", options->mode,
                  "pvrr, hybrid, exact, raytrace, cubemap or auto, in place of the scene's")
      ->option_text("MODE");
  app->add_option("--samples", options->samples, "Samples per pixel")
      ->check(CLI::Range(1, 4096))
      ->option_text("N");
  app->add_option(
         "--multisample", options->multisample,
         "Hardware multisampling of outlines where --samples is 1: 1, 2, 4 or 8; not in mode raytrace")
      ->check(CLI::IsMember({1, 2, 4, 8}))
      ->option_text("N");
  app->add_option("--pupil-mm", options->pupil_mm,
                  "Diameter of the eye's pupil in mm, in place of the scene's; 0: a point. Needs --samples")
      ->check(CLI::Range(0.0, 1000.0))
      ->option_text("MM");
  app->add_option("--focus-mm", options->focus_mm,
                  "Distance that the eye focuses on, in mm, in place of the scene's; 0: that of the target")
      ->check(CLI::Range(0.0, 1e9))
      ->option_text("MM");
  app->add_option("--report", options->report, "JSON report to write; an .exr gets the geometry layers")
      ->option_text("R.json");
  app->add_flag("--aov", options->aov, "Geometry layers in an .exr");
  app->add_option(
         "--overlay", options->overlay,
         "Draw over the picture: vertices, rays, patches (mode pvrr), error, or retraced (mode exact)")
      ->check(CLI::IsMember({"vertices", "rays", "patches", "error", "retraced"}))
      ->option_text("WHAT");
  app->add_option("--reference", options->reference, "Picture to compare with; exit code 3 where it differs")
      ->option_text("IMAGE");
  app->add_option("--reference-threshold", options->reference_threshold,
                  "Largest mean FLIP difference allowed (default 0.01)")
      ->check(between(0, 1))
      ->option_text("X");
  return {app, [options, &common] { return run_render(*options, common); }};
}

}  // namespace catoptra::app
