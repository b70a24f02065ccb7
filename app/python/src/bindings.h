// What the Python module is made of: one function per part of the interface, each adding its classes and
// functions.
#pragma once

#include <pybind11/pybind11.h>

namespace catoptra::python {

void bind_errors(pybind11::module_& module);  ///< first: the others throw them
void bind_cad(pybind11::module_& module);     ///< CadModel, Face, load_cad
void bind_lens(pybind11::module_& module);    ///< Lens, make_lens, load_lens, evaluate
void bind_mirror(pybind11::module_& module);  ///< make_mirror, evaluate_mirror
void bind_render(pybind11::module_& module);  ///< Scene, Picture
void bind_batch(pybind11::module_& module);   ///< plans, cases, stores

/// JSON as Python's own dictionaries and lists.
[[nodiscard]] pybind11::object python_object(const std::string& json);

}  // namespace catoptra::python
