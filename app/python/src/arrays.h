// NumPy arrays from and to the values of the libraries.
#pragma once

#include <pybind11/numpy.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace catoptra::python {

namespace py = pybind11;
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Rows of two numbers: shape (N, 2), or (2,) for one. Throws a Python ValueError for another shape.
inline std::vector<glm::dvec2> rows_of_two(const Doubles& array, const char* name) {
  const bool one = array.ndim() == 1 && array.shape(0) == 2;
  if (!one && !(array.ndim() == 2 && array.shape(1) == 2))
    throw py::value_error(std::string(name) + " must have the shape (N, 2)");
  std::vector<glm::dvec2> rows(one ? 1 : std::size_t(array.shape(0)));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = {array.data()[2 * i], array.data()[2 * i + 1]};
  return rows;
}

/// One number per item.
template <typename Items, typename Value>
py::array_t<double> column(const Items& items, Value value) {
  py::array_t<double> array(static_cast<py::ssize_t>(items.size()));
  double* to = array.mutable_data();
  for (const auto& item : items) *to++ = value(item);
  return array;
}

/// Shape (N, 3).
inline py::array_t<double> rows_of_three(std::span<const glm::dvec3> rows) {
  py::array_t<double> array({static_cast<py::ssize_t>(rows.size()), py::ssize_t(3)});
  double* to = array.mutable_data();
  for (const glm::dvec3& row : rows)
    for (int k = 0; k < 3; ++k) *to++ = row[k];
  return array;
}

inline py::tuple tuple_of(const glm::dvec3& v) {
  return py::make_tuple(v.x, v.y, v.z);
}

}  // namespace catoptra::python
