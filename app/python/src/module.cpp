// The entry of the Python module catoptra._core.
#include "app/python/src/bindings.h"
#include "app/version.h"

PYBIND11_MODULE(_core, module) {
  using namespace catoptra::python;
  module.doc() = "Catoptra's libraries as a Python module; see the package catoptra.";
  module.attr("__version__") = std::string(catoptra::app::version());
  bind_errors(module);
  bind_cad(module);
  bind_lens(module);
  bind_mirror(module);
  bind_render(module);
  bind_batch(module);
}

namespace catoptra::python {

pybind11::object python_object(const std::string& json) {
  return pybind11::module_::import("json").attr("loads")(json);
}

}  // namespace catoptra::python
