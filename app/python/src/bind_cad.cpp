// CAD files: bodies, faces, and their exact surfaces evaluated at arrays of parameters.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>

#include "app/python/src/arrays.h"
#include "app/python/src/bindings.h"
#include "app/src/file_report.h"
#include "cad_import/import.h"

namespace catoptra::python {
namespace {

using cad_import::CadModel;
using cad_import::Face;

/// What is wanted of a face's surface at rows of (u, v).
template <typename Value>
py::array_t<double> at_parameters(const Face& face, const Doubles& uv, Value value) {
  const auto rows = rows_of_two(uv, "uv");
  std::vector<glm::dvec3> results(rows.size());
  {
    const py::gil_scoped_release release;
    for (std::size_t i = 0; i < rows.size(); ++i) results[i] = value(*face.surface, rows[i]);
  }
  return rows_of_three(results);
}

py::array_t<double> curvatures(const Face& face, const Doubles& uv) {
  const auto rows = rows_of_two(uv, "uv");
  py::array_t<double> result({static_cast<py::ssize_t>(rows.size()), py::ssize_t(2)});
  double* to = result.mutable_data();
  const py::gil_scoped_release release;
  for (const glm::dvec2& p : rows) {
    const auto k = face.surface->principal_curvatures(p.x, p.y);
    *to++ = k.k1;
    *to++ = k.k2;
  }
  return result;
}

void bind_face(py::module_& module) {
  py::class_<Face>(module, "Face", "A trimmed face and its exact surface. Lengths in mm, curvatures in 1/mm.")
      .def_readonly("id", &Face::id)
      .def_readonly("index", &Face::index)
      .def_readonly("name", &Face::name)
      .def_readonly("body", &Face::body)
      .def_readonly("area_mm2", &Face::area_mm2)
      .def_readonly("planar", &Face::planar)
      .def_property_readonly(
          "domain",
          [](const Face& face) {
            const auto d = face.surface->domain();
            return py::make_tuple(d.u_min, d.u_max, d.v_min, d.v_max);
          },
          "(u_min, u_max, v_min, v_max)")
      .def(
          "points",
          [](const Face& face, const Doubles& uv) {
            return at_parameters(face, uv, [](const auto& s, glm::dvec2 p) { return s.point(p.x, p.y); });
          },
          py::arg("uv"), "Points at parameters of shape (N, 2); shape (N, 3), mm.")
      .def(
          "normals",
          [](const Face& face, const Doubles& uv) {
            return at_parameters(face, uv,
                                 [](const auto& s, glm::dvec2 p) { return s.unit_normal(p.x, p.y); });
          },
          py::arg("uv"), "Unit normals out of the material; shape (N, 3).")
      .def("curvatures", &curvatures, py::arg("uv"),
           "Principal curvatures k1 >= k2, positive where convex as seen from outside; shape (N, 2), 1/mm.")
      .def(
          "contains",
          [](const Face& face, double u, double v) { return !face.trim || face.trim->contains(u, v); },
          py::arg("u"), py::arg("v"), "Whether (u, v) lies in the trimmed face.");
}

}  // namespace

void bind_cad(py::module_& module) {
  bind_face(module);
  py::class_<CadModel, std::shared_ptr<CadModel>>(module, "CadModel", "An imported CAD file, in mm.")
      .def_readonly("file", &CadModel::file)
      .def_readonly("format", &CadModel::format)
      .def_readonly("unit", &CadModel::unit)
      .def_readonly("warnings", &CadModel::warnings)
      .def_property_readonly("faces", [](const CadModel& model) { return model.faces; })
      .def_property_readonly(
          "bodies",
          [](const CadModel& model) {
            py::list bodies;
            for (const auto& body : model.bodies) {
              py::dict entry;
              entry["name"] = body.name;
              entry["solid"] = body.solid;
              entry["faces"] = body.faces;
              bodies.append(entry);
            }
            return bodies;
          },
          "Dictionaries with name, solid and faces (indices).")
      .def_property_readonly("bounding_box_mm", [](const CadModel& model) {
        return py::make_tuple(tuple_of(model.bounds.min), tuple_of(model.bounds.max));
      });
  module.def(
      "load_cad",
      [](const std::filesystem::path& file, const std::optional<std::string>& unit, double scale) {
        const py::gil_scoped_release release;
        cad_import::ImportOptions options;
        options.unit = unit;
        options.scale = scale;
        return std::make_shared<CadModel>(cad_import::import_cad(file, options));
      },
      py::arg("file"), py::kw_only(), py::arg("unit") = py::none(), py::arg("scale") = 1.0,
      "Reads STEP, IGES, BREP or a FreeCAD document. Raises ImportError.");
}

}  // namespace catoptra::python
