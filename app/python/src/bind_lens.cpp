// Lenses: made to a prescription or read from a file, and measured.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <glm/trigonometric.hpp>
#include <limits>
#include <memory>
#include <optional>

#include "app/python/src/arrays.h"
#include "app/python/src/bindings.h"
#include "app/src/lens_front.h"
#include "app/src/lens_picture.h"
#include "app/src/lens_report_writers.h"
#include "app/src/lens_source.h"
#include "app/src/report.h"
#include "cad_import/lens_blank.h"

namespace catoptra::python {
namespace {

/// A lens with its frame; made ones also know their blank.
struct LensHandle {
  app::LensSource source;
  std::optional<cad_import::LensShape> shape;
};

/// The medium that `material` (a name) or `index` says.
optics::Medium medium_of(const std::optional<std::string>& material, const std::optional<double>& index,
                         const std::optional<double>& abbe) {
  if (material.has_value() == index.has_value())
    throw py::value_error("give either material or index: there is no default");
  if (abbe && !index) throw py::value_error("abbe belongs to index: a material has its own dispersion");
  if (material) return optics::built_in_media().find(*material);
  return abbe ? optics::abbe_medium(*index, *abbe) : optics::constant_medium(*index);
}

std::shared_ptr<LensHandle> load(const std::filesystem::path& file,
                                 const std::optional<std::string>& material,
                                 const std::optional<double>& index, const std::optional<double>& abbe,
                                 const std::string& name, const std::optional<std::array<double, 3>>& up) {
  app::LensSourceOptions options;
  if (material || index || abbe || !app::is_scene_file(file))
    options.medium = medium_of(material, index, abbe);
  options.name = name;
  if (up) options.up = glm::dvec3((*up)[0], (*up)[1], (*up)[2]);
  const py::gil_scoped_release release;
  return std::make_shared<LensHandle>(LensHandle{app::load_lens(file, options), std::nullopt});
}

/// Left out, the form that the rest of `blank` needs, as in `lens make`.
cad_import::LensFrontForm front_form(const std::optional<std::string>& name,
                                     const cad_import::LensBlank& blank) {
  if (!name) return app::needed_front(blank);
  if (const auto form = app::front_from_name(*name)) return *form;
  throw py::value_error("front must be 'sphere', 'conic', 'asphere' or 'freeform', not '" + *name + "'");
}

std::shared_ptr<LensHandle> make(const cad_import::LensBlank& blank, const optics::Medium& medium) {
  const py::gil_scoped_release release;
  cad_import::LensShape shape(blank);
  app::LensSourceOptions options;
  options.medium = medium;
  auto handle = std::make_shared<LensHandle>(
      LensHandle{app::lens_of_model(cad_import::lens_model(shape), options), shape});
  handle->source.lens.name = "lens";
  return handle;
}

app::LensReportOptions report_options(const std::string& mode, const std::optional<Doubles>& gaze_deg,
                                      const std::optional<Doubles>& points_mm, double gaze_max_deg,
                                      double gaze_step_deg, const optics::WearingPosition& position,
                                      double object_distance_mm, double wavelength_nm,
                                      const std::string& cylinder, std::size_t threads) {
  app::LensReportOptions options;
  if (mode != "lensmeter" && mode != "as-worn")
    throw py::value_error("mode must be 'lensmeter' or 'as-worn', not '" + mode + "'");
  if (cylinder != "minus" && cylinder != "plus")
    throw py::value_error("cylinder must be 'minus' or 'plus', not '" + cylinder + "'");
  options.evaluation.mode =
      mode == "as-worn" ? optics::EvaluationMode::as_worn : optics::EvaluationMode::lensmeter;
  options.evaluation.position = position;
  options.evaluation.object_distance_mm = object_distance_mm;
  options.evaluation.wavelength_nm = wavelength_nm;
  options.evaluation.threads = threads;
  options.cylinder = cylinder == "plus" ? optics::CylinderForm::plus : optics::CylinderForm::minus;
  if (points_mm) options.points_mm = rows_of_two(*points_mm, "points_mm");
  if (gaze_deg) {
    options.gaze_rad = rows_of_two(*gaze_deg, "gaze_deg");
    for (glm::dvec2& gaze : options.gaze_rad) gaze = glm::radians(gaze);
  } else if (!points_mm) {
    options.gaze_rad = optics::gaze_grid(glm::radians(gaze_max_deg), glm::radians(gaze_step_deg));
  }
  return options;
}

/// The points as columns: what did not get through is NaN.
py::dict columns(const app::LensReport& report) {
  const auto& points = report.points;
  const auto of = [&](auto value) {
    return column(points, [&](const app::LensReportPoint& p) {
      return p.measured.end == optics::LensPathEnd::passed ? value(p) : std::nan("");
    });
  };
  py::dict result;
  result["gaze_h_deg"] = column(points, [](const auto& p) { return glm::degrees(p.measured.gaze_rad.x); });
  result["gaze_v_deg"] = column(points, [](const auto& p) { return glm::degrees(p.measured.gaze_rad.y); });
  result["x_mm"] = column(points, [](const auto& p) { return p.measured.point_mm.x; });
  result["y_mm"] = column(points, [](const auto& p) { return p.measured.point_mm.y; });
  result["sphere_d"] = of([](const auto& p) { return p.power.sphere_d; });
  result["cylinder_d"] = of([](const auto& p) { return p.power.cylinder_d; });
  result["axis_deg"] = of([](const auto& p) { return glm::degrees(p.power.axis_rad); });
  result["mean_power_error_d"] = of([](const auto& p) { return p.measured.mean_power_error_d; });
  result["oblique_astigmatism_d"] = of([](const auto& p) { return p.measured.oblique_astigmatism_d; });
  result["tangential_d"] = of([](const auto& p) { return p.measured.tangential_d; });
  result["sagittal_d"] = of([](const auto& p) { return p.measured.sagittal_d; });
  result["prism_h"] = of([](const auto& p) { return p.measured.prism.x; });
  result["prism_v"] = of([](const auto& p) { return p.measured.prism.y; });
  result["base_out"] = of([](const auto& p) { return p.base_out; });
  result["object_h_deg"] = of([](const auto& p) { return glm::degrees(p.measured.object_rad.x); });
  result["object_v_deg"] = of([](const auto& p) { return glm::degrees(p.measured.object_rad.y); });
  result["distortion"] = of([](const auto& p) { return p.measured.distortion; });
  result["tca_d"] = of([](const auto& p) { return p.measured.transverse_colour; });
  return result;
}

void bind_evaluation(py::module_& module) {
  py::class_<app::LensReport>(module, "LensEvaluation", "What `catoptra lens evaluate` reports.")
      .def_property_readonly("points", &columns,
                             "Columns by name, one value per point; NaN where no light gets through.")
      .def_property_readonly(
          "reference",
          [](const app::LensReport& r) -> py::object {
            return python_object(app::json_text(app::lens_report_json(r)))["reference"];
          },
          "Power and prism by the focimeter at the back vertex.")
      .def_readonly("spectacle_magnification", &app::LensReport::spectacle_magnification)
      .def_readonly("warnings", &app::LensReport::warnings)
      .def(
          "to_dict",
          [](const app::LensReport& r) { return python_object(app::json_text(app::lens_report_json(r))); },
          "The JSON report as dictionaries and lists.")
      .def(
          "to_csv", [](const app::LensReport& r) { return app::lens_report_csv(r); },
          "The points as CSV text.");
}

void bind_handle(py::module_& module) {
  py::class_<LensHandle, std::shared_ptr<LensHandle>>(module, "Lens",
                                                      "A lens of known material, ready to be measured.")
      .def_property_readonly("name", [](const LensHandle& lens) { return lens.source.lens.name; })
      .def_property_readonly("material", [](const LensHandle& lens) { return lens.source.lens.medium.name; })
      .def_property_readonly("warnings", [](const LensHandle& lens) { return lens.source.warnings; })
      .def(
          "index", [](const LensHandle& lens, double nm) { return lens.source.lens.medium.index(nm); },
          py::arg("wavelength_nm") = optics::kLineD_nm, "Refractive index.")
      .def(
          "evaluate",
          [](const LensHandle& lens, const std::string& mode, const std::optional<Doubles>& gaze_deg,
             const std::optional<Doubles>& points_mm, double gaze_max_deg, double gaze_step_deg,
             double rotation_centre_mm, double vertex_distance_mm, double panto_deg, double wrap_deg,
             const std::string& eye, double object_distance_mm, const std::optional<double>& wavelength_nm,
             const std::string& cylinder, std::size_t threads) {
            if (eye != "right" && eye != "left")
              throw py::value_error("eye must be 'right' or 'left', not '" + eye + "'");
            optics::WearingPosition position{rotation_centre_mm, vertex_distance_mm, glm::radians(panto_deg),
                                             glm::radians(wrap_deg),
                                             eye == "left" ? optics::Eye::left : optics::Eye::right};
            const auto options = report_options(
                mode, gaze_deg, points_mm, gaze_max_deg, gaze_step_deg, position, object_distance_mm,
                wavelength_nm.value_or(optics::reference_line_nm(lens.source.lens.medium)), cylinder,
                threads);
            const py::gil_scoped_release release;
            return app::lens_report(lens.source, options);
          },
          py::kw_only(), py::arg("mode") = "lensmeter", py::arg("gaze_deg") = py::none(),
          py::arg("points_mm") = py::none(), py::arg("gaze_max_deg") = 30.0, py::arg("gaze_step_deg") = 10.0,
          py::arg("rotation_centre_mm") = 25.0, py::arg("vertex_distance_mm") = 12.0,
          py::arg("panto_deg") = 0.0, py::arg("wrap_deg") = 0.0, py::arg("eye") = "right",
          py::arg("object_distance_mm") = std::numeric_limits<double>::infinity(),
          py::arg("wavelength_nm") = py::none(), py::arg("cylinder") = "minus", py::arg("threads") = 0,
          "Measures the lens at gaze_deg or points_mm of shape (N, 2), else over a grid of gaze directions; "
          "at the material's "
          "reference line (d, or e where it is quoted for e alone) unless wavelength_nm says otherwise. "
          "Other threads run meanwhile.")
      .def(
          "picture_png",
          [](const LensHandle& lens, double vertex_distance_mm) {
            optics::WearingPosition position;
            position.vertex_distance_mm = vertex_distance_mm;
            std::string png;
            {
              const py::gil_scoped_release release;
              png = app::lens_picture_png(lens.source, position);
            }
            return py::bytes(png);
          },
          py::arg("vertex_distance_mm") = 12.0, "PNG bytes of a square grid as the wearer sees it.")
      .def(
          "write",
          [](const LensHandle& lens, const std::filesystem::path& file) {
            if (!lens.shape) throw py::value_error("only lenses from make_lens can be written");
            const py::gil_scoped_release release;
            cad_import::write_lens(*lens.shape, file);
          },
          py::arg("file"), "Writes a made lens as a STEP solid with the faces front, back and rim.");
}

}  // namespace

void bind_lens(py::module_& module) {
  bind_evaluation(module);
  bind_handle(module);
  module.def("load_lens", &load, py::arg("file"), py::kw_only(), py::arg("material") = py::none(),
             py::arg("index") = py::none(), py::arg("abbe") = py::none(), py::arg("name") = "",
             py::arg("up") = py::none(),
             "The lens in a CAD file (material or index needed) or in a scene file.");
  module.def(
      "make_lens",
      [](double sphere_d, double cylinder_d, double axis_deg, double prism_d, double prism_base_deg,
         double addition_d, double corridor_mm, const std::optional<std::string>& material,
         const std::optional<double>& index, const std::optional<double>& abbe,
         const std::optional<double>& front_curve_d, const std::optional<std::string>& front, double conic,
         const std::vector<double>& asphere_mm, double back_conic,
         const std::optional<double>& center_thickness_mm, const std::optional<double>& edge_thickness_mm,
         double diameter_mm) {
        const optics::Medium medium = medium_of(material, index, abbe);
        cad_import::LensBlank blank;
        blank.index = medium.index(optics::reference_line_nm(medium));
        blank.sphere_d = sphere_d;
        blank.cylinder_d = cylinder_d;
        blank.axis_deg = axis_deg;
        blank.prism_d = prism_d;
        blank.prism_base_deg = prism_base_deg;
        blank.addition_d = addition_d;
        blank.corridor_mm = corridor_mm;
        blank.front_curve_d = front_curve_d;
        blank.conic = conic;
        blank.asphere_mm = asphere_mm;
        blank.front = front_form(front, blank);
        blank.back_conic = back_conic;
        blank.center_thickness_mm = center_thickness_mm;
        blank.edge_thickness_mm = edge_thickness_mm;
        blank.diameter_mm = diameter_mm;
        return make(blank, medium);
      },
      py::kw_only(), py::arg("sphere_d") = 0.0, py::arg("cylinder_d") = 0.0, py::arg("axis_deg") = 0.0,
      py::arg("prism_d") = 0.0, py::arg("prism_base_deg") = 0.0, py::arg("addition_d") = 0.0,
      py::arg("corridor_mm") = 14.0, py::arg("material") = py::none(), py::arg("index") = py::none(),
      py::arg("abbe") = py::none(), py::arg("front_curve_d") = py::none(), py::arg("front") = py::none(),
      py::arg("conic") = 0.0, py::arg("asphere_mm") = std::vector<double>{}, py::arg("back_conic") = 0.0,
      py::arg("center_thickness_mm") = py::none(), py::arg("edge_thickness_mm") = py::none(),
      py::arg("diameter_mm") = 65.0,
      "A lens to a prescription, in memory; see `catoptra lens make --help` for what the arguments mean.");
}

}  // namespace catoptra::python
