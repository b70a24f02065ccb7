// Mirrors: made to order, and evaluated in a scene.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <optional>

#include "app/python/src/bindings.h"
#include "app/python/src/scene_handle.h"
#include "app/src/mirror_evaluation_writers.h"
#include "app/src/report.h"
#include "cad_import/mirror_blank.h"

namespace catoptra::python {
namespace py = pybind11;
namespace {

void make(const std::filesystem::path& file, double radius_mm, const std::optional<double>& radius_h_mm,
          const std::optional<double>& radius_v_mm, double width_mm, double height_mm, double thickness_mm,
          const std::string& outline, double corner_radius_mm) {
  if (radius_h_mm.has_value() != radius_v_mm.has_value())
    throw py::value_error("radius_h_mm and radius_v_mm belong together");
  if (outline != "rect" && outline != "rounded")
    throw py::value_error("outline must be 'rect' or 'rounded', not '" + outline + "'");
  cad_import::MirrorBlank blank;
  blank.radius_h_mm = radius_h_mm.value_or(radius_mm);
  blank.radius_v_mm = radius_v_mm.value_or(radius_mm);
  blank.width_mm = width_mm;
  blank.height_mm = height_mm;
  blank.thickness_mm = thickness_mm;
  blank.outline =
      outline == "rect" ? cad_import::MirrorOutline::rectangle : cad_import::MirrorOutline::rounded;
  blank.corner_radius_mm = corner_radius_mm;
  const py::gil_scoped_release release;
  cad_import::write_mirror_blank(blank, file);
}

py::object evaluate(SceneHandle& scene, const std::string& mirror, const std::string& rule,
                    const std::optional<std::array<double, 3>>& eye_mm) {
  std::string json;
  {
    const py::gil_scoped_release release;
    app::MirrorEvaluationOptions options;
    options.mirror = mirror;
    if (!rule.empty()) options.rule = app::find_rule(rule, app::mirror_rule_words());
    if (eye_mm) options.eye_mm = glm::dvec3((*eye_mm)[0], (*eye_mm)[1], (*eye_mm)[2]);
    json = app::json_text(app::mirror_json(app::evaluate_mirror(scene.file, options)));
  }
  return python_object(json);
}

}  // namespace

void bind_mirror(py::module_& module) {
  module.def(
      "make_mirror", &make, py::arg("file"), py::kw_only(), py::arg("radius_mm") = 1200.0,
      py::arg("radius_h_mm") = py::none(), py::arg("radius_v_mm") = py::none(), py::arg("width_mm") = 170.0,
      py::arg("height_mm") = 110.0, py::arg("thickness_mm") = 2.0, py::arg("outline") = "rect",
      py::arg("corner_radius_mm") = 20.0,
      "Writes a mirror glass as a STEP solid; radii positive for convex, negative for concave, 0 for plane.");
  module.def(
      "evaluate_mirror", &evaluate, py::arg("scene"), py::kw_only(), py::arg("mirror") = "",
      py::arg("rule") = "", py::arg("eye_mm") = py::none(),
      "Radii, magnification, field of view and, with a rule such as 'R46-III', its verdicts: the JSON of "
      "`catoptra mirror evaluate` as dictionaries and lists.");
}

}  // namespace catoptra::python
