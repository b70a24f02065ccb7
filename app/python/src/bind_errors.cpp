// catoptra::Error and its kinds as Python exceptions that carry file, entity, reason and hint.
#include "app/python/src/bindings.h"
#include "cad_import/error.h"

namespace catoptra::python {
namespace py = pybind11;
namespace {

void raise(const py::object& type, const Error& error) {
  py::object exception = type(error.what());
  exception.attr("file") = error.file();
  exception.attr("entity") = error.entity();
  exception.attr("reason") = error.reason();
  exception.attr("hint") = error.hint();
  PyErr_SetObject(type.ptr(), exception.ptr());
}

}  // namespace

void bind_errors(py::module_& module) {
  const auto make = [&](const char* name, const char* doc, const py::handle& base) {
    py::object type = py::reinterpret_steal<py::object>(
        PyErr_NewExceptionWithDoc((std::string("catoptra.") + name).c_str(), doc, base.ptr(), nullptr));
    module.attr(name) = type;
    return type;
  };
  static py::object* const error = new py::object(
      make("Error",
           "Bad input or a failed operation. Attributes: file, entity, reason, hint (strings, may be empty).",
           PyExc_RuntimeError));
  static py::object* const import_error = new py::object(make(
      "ImportError", "A CAD or mesh file that cannot be read, or does not hold what was asked for.", *error));
  static py::object* const cancelled = new py::object(make("Cancelled", "Somebody asked to stop.", *error));
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const cad_import::ImportError& e) {
      raise(*import_error, e);
    } catch (const Cancelled& e) {
      raise(*cancelled, e);
    } catch (const Error& e) {
      raise(*error, e);
    }
  });
}

}  // namespace catoptra::python
