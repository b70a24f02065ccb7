// catoptra mirror make
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/src/commands.h"
#include "cad_import/mirror_blank.h"

namespace catoptra::app {
namespace {

struct MakeOptions {
  std::optional<double> radius, radius_h, radius_v;
  bool aspheric = false, towards_minus_x = false;
  std::optional<double> aspheric_boundary, aspheric_edge_radius;
  double width = 170, height = 110, thickness = 2, corner_radius = 20;
  std::string outline = "rect", output;
};

void set_radii(const MakeOptions& options, cad_import::MirrorBlank& blank) {
  if (options.radius && (options.radius_h || options.radius_v))
    throw UsageError("--radius excludes --radius-h and --radius-v");
  if (options.radius_h.has_value() != options.radius_v.has_value())
    throw UsageError("--radius-h and --radius-v belong together");
  const double radius = options.radius.value_or(1200);
  blank.radius_h_mm = options.radius_h.value_or(radius);
  blank.radius_v_mm = options.radius_v.value_or(radius);
}

void set_aspheric_part(const MakeOptions& options, cad_import::MirrorBlank& blank) {
  if (!options.aspheric && !options.aspheric_boundary && !options.aspheric_edge_radius &&
      !options.towards_minus_x)
    return;
  cad_import::AsphericPart part;
  part.boundary_mm = options.aspheric_boundary.value_or(part.boundary_mm);
  part.edge_radius_mm = options.aspheric_edge_radius.value_or(part.edge_radius_mm);
  part.towards_minus_x = options.towards_minus_x;
  blank.aspheric = part;
}

void set_outline(const MakeOptions& options, cad_import::MirrorBlank& blank) {
  if (options.outline == "rect") {
    blank.outline = cad_import::MirrorOutline::rectangle;
  } else if (options.outline == "rounded") {
    blank.outline = cad_import::MirrorOutline::rounded;
  } else {
    blank.outline = cad_import::MirrorOutline::polygon;
    blank.polygon = outline_corners(options.outline, {"rect", "rounded"});
  }
}

int run_make(const MakeOptions& options) {
  check_step_path(options.output);
  cad_import::MirrorBlank blank;
  set_radii(options, blank);
  set_aspheric_part(options, blank);
  set_outline(options, blank);
  blank.width_mm = options.width;
  blank.height_mm = options.height;
  blank.thickness_mm = options.thickness;
  blank.corner_radius_mm = options.corner_radius;
  cad_import::write_mirror_blank(blank, options.output);
  return kExitDone;
}

void add_make_options(CLI::App& app, MakeOptions& options) {
  app.add_option("--radius", options.radius,
                 "Radius of curvature in mm; negative: concave; 0: plane (default 1200)")
      ->check(finite())
      ->option_text("R");
  app.add_option("--radius-h", options.radius_h, "Radius of the horizontal section in mm, with --radius-v")
      ->check(finite())
      ->option_text("RH");
  app.add_option("--radius-v", options.radius_v, "Radius of the vertical section in mm")
      ->check(finite())
      ->option_text("RV");
  app.add_flag("--aspheric", options.aspheric,
               "Outer strip whose curvature grows towards the edge (door mirrors)");
  app.add_option("--aspheric-boundary", options.aspheric_boundary,
                 "Where the strip begins, mm from the pole (default 40)")
      ->check(at_least(0))
      ->option_text("X");
  app.add_option("--aspheric-edge-radius", options.aspheric_edge_radius,
                 "Radius at the strip's outer edge in mm (default 300)")
      ->check(above(0))
      ->option_text("R");
  app.add_flag("--aspheric-minus-x", options.towards_minus_x, "The strip lies on the -x side");
  app.add_option("--width", options.width, "Width in mm, along x (default 170)")
      ->check(above(0))
      ->option_text("W");
  app.add_option("--height", options.height, "Height in mm, along y (default 110)")
      ->check(above(0))
      ->option_text("H");
  app.add_option("--thickness", options.thickness, "Thickness in mm (default 2)")
      ->check(above(0))
      ->option_text("T");
  app.add_option("--outline", options.outline,
                 "rect, rounded, or a file with one corner \"x y\" in mm per line")
      ->option_text("rect|rounded|FILE");
  app.add_option("--corner-radius", options.corner_radius, "Of a rounded outline, mm (default 20)")
      ->check(above(0))
      ->option_text("R");
  app.add_option("-o,--output", options.output, "STEP file to write, .step or .stp")
      ->required()
      ->option_text("MIRROR.step");
}

}  // namespace

std::vector<Command> add_mirror_commands(CLI::App& root, CommonOptions& common) {
  CLI::App* mirror = add_subcommand(root, common, "mirror", "Make and evaluate mirrors");
  mirror->require_subcommand(0, 1);
  auto options = std::make_shared<MakeOptions>();
  CLI::App* make = add_subcommand(*mirror, common, "make",
                                  "Write a mirror glass as a STEP solid with the faces Glass, Back and Edge");
  add_make_options(*make, *options);
  return {{make, [options] { return run_make(*options); }}, add_mirror_evaluate_command(*mirror, common)};
}

}  // namespace catoptra::app
