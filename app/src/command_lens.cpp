// catoptra lens make
#include <array>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/src/commands.h"
#include "app/src/lens_front.h"
#include "app/src/output_file.h"
#include "cad_import/lens_blank.h"
#include "optics/medium.h"

namespace catoptra::app {
namespace {

struct MakeOptions {
  cad_import::LensBlank blank;
  std::optional<double> index, front_curve, center_thickness, edge_thickness, diameter;
  std::string material, front, back, outline, output;
  std::vector<double> asphere;
};

/// At the d line, unless the material is quoted for e alone.
double index_of(const MakeOptions& options) {
  if (options.index && !options.material.empty()) throw UsageError("--index excludes --material");
  if (options.material.empty()) return options.index.value_or(1.5);
  const optics::Medium medium = [&options] {
    try {
      return optics::built_in_media().find(options.material);
    } catch (const Error& error) {
      throw UsageError("--material: " + error.entity() + " " + error.reason(), error.hint());
    }
  }();
  return medium.index(optics::reference_line_nm(medium));
}

/// Left out, the form that the other options need.
std::optional<cad_import::LensBackForm> back_form(const MakeOptions& options) {
  if (options.back.empty()) return std::nullopt;
  const bool biconic = options.back == "biconic";
  if (!biconic && options.blank.back_conic != 0)
    throw UsageError("--back toric excludes --back-conic", "the sections of a torus are circles");
  return biconic ? cad_import::LensBackForm::biconic : cad_import::LensBackForm::toric;
}

const char* back_word(const cad_import::LensBlankReport& report) {
  return report.back == cad_import::LensBackForm::biconic   ? "biconic"
         : report.back_radius1_mm == report.back_radius2_mm ? "spherical"
                                                            : "toric";
}

std::string summary(const cad_import::LensShape& shape) {
  const cad_import::LensBlankReport& report = shape.report();
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(),
                "index %.5g\n"
                "front curve %.4g D, radius %.6g mm\n"
                "back %s, radii %.6g and %.6g mm\n"
                "thickness %.4g mm at the center, %.4g to %.4g mm at the edge\n",
                shape.blank().index, report.front_curve_d, report.front_radius_mm, back_word(report),
                report.back_radius1_mm, report.back_radius2_mm, report.center_thickness_mm,
                report.edge_thickness_min_mm, report.edge_thickness_max_mm);
  return text.data();
}

int run_make(const MakeOptions& options) {
  if (options.diameter && !options.outline.empty()) throw UsageError("--diameter excludes --outline");
  check_step_path(options.output);
  cad_import::LensBlank blank = options.blank;
  blank.back = back_form(options);
  blank.index = index_of(options);
  blank.front_curve_d = options.front_curve;
  blank.asphere_mm = options.asphere;
  blank.front = front_from_name(options.front).value_or(needed_front(blank));
  blank.center_thickness_mm = options.center_thickness;
  blank.edge_thickness_mm = options.edge_thickness;
  blank.diameter_mm = options.diameter.value_or(blank.diameter_mm);
  if (!options.outline.empty()) blank.outline = outline_corners(options.outline, {});
  const cad_import::LensShape shape(blank);
  cad_import::write_lens(shape, options.output);
  write_text("-", summary(shape));
  return kExitDone;
}

void add_prescription(CLI::App& app, MakeOptions& options) {
  cad_import::LensBlank& blank = options.blank;
  const auto add = [&app](const char* name, auto& value, const char* text, const char* shown,
                          const CLI::Validator& allowed) {
    app.add_option(name, value, text)->option_text(shown)->group("Prescription")->check(allowed);
  };
  add("--sph", blank.sphere_d, "Sphere, back vertex power in dioptre (default 0)", "S", finite());
  add("--cyl", blank.cylinder_d, "Cylinder in dioptre, either sign (default 0)", "C", finite());
  add("--axis", blank.axis_deg, "Axis of the cylinder, TABO, 0 to 180 degrees (default 0)", "A",
      between(0, 180));
  add("--add", blank.addition_d, "Addition of a progressive front in dioptre (default 0)", "D", at_least(0));
  add("--corridor", blank.corridor_mm, "Length over which the addition grows, mm (default 14)", "L",
      above(0));
  add("--prism", blank.prism_d, "Prism in prism dioptre (default 0)", "P", between(0, 30));
  add("--base-deg", blank.prism_base_deg, "Base of the prism, TABO, 0 to 360 degrees (default 0)", "B",
      between(0, 360));
}

void add_form(CLI::App& app, MakeOptions& options) {
  const auto add = [&app](const char* name, auto& value, const char* text, const char* shown) {
    return app.add_option(name, value, text)->option_text(shown)->group("Material and form");
  };
  add("--index", options.index, "Refractive index at the d line (default 1.5)", "N")->check(above(1));
  add("--material", options.material, "Material by name, such as CR-39, in place of --index", "M");
  add("--front-curve", options.front_curve, "Front power (n - 1) / R in dioptre (default: Vogel's rule)", "F")
      ->check(finite());
  add("--front", options.front, "Form of the front (default: what the other options need, else sphere)",
      "sphere|conic|asphere|freeform")
      ->check(CLI::IsMember({"sphere", "conic", "asphere", "freeform"}));
  add("--conic", options.blank.conic, "Conic constant of a conic or aspheric front (default 0)", "K")
      ->check(finite());
  add("--asphere", options.asphere, "Coefficients of r^4, r^6, ... of an aspheric front, in mm", "A4,A6,...")
      ->delimiter(',')
      ->check(finite());
  add("--back", options.back, "Form of a back with cylinder (default: toric, or biconic with --back-conic)",
      "toric|biconic")
      ->check(CLI::IsMember({"toric", "biconic"}));
  add("--back-conic", options.blank.back_conic,
      "Conic constant of the principal sections of a biconic back: atoric (default 0)", "K")
      ->check(finite());
  add("--center-thickness", options.center_thickness,
      "Thickness at the vertex in mm (default: 2, more where the edge needs it)", "T")
      ->check(above(0));
  add("--edge-thickness", options.edge_thickness, "Least thickness of the edge in mm, in place of the center",
      "T")
      ->check(above(0));
  add("--diameter", options.diameter, "Of a round lens in mm (default 65)", "D")->check(above(0));
  add("--outline", options.outline, "File with one corner \"x y\" in mm per line, in place of --diameter",
      "FILE");
}

}  // namespace

std::vector<Command> add_lens_commands(CLI::App& root, CommonOptions& common) {
  CLI::App* lens = add_subcommand(root, common, "lens", "Make and measure spectacle lenses");
  lens->require_subcommand(0, 1);
  auto options = std::make_shared<MakeOptions>();
  CLI::App* make = add_subcommand(*lens, common, "make",
                                  "Write a lens to a prescription as a STEP solid with the faces front, back "
                                  "and rim");
  add_prescription(*make, *options);
  add_form(*make, *options);
  make->add_option("-o,--output", options->output, "STEP file to write, .step or .stp")
      ->required()
      ->option_text("LENS.step");
  return {{make, [options] { return run_make(*options); }}, add_lens_evaluate_command(*lens, common)};
}

}  // namespace catoptra::app
