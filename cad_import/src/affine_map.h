// Placement of kernel geometry: linear part and shift, applied after evaluation so that (u, v) and t stay the
// file's.
#pragma once

#include <TopLoc_Location.hxx>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <gp_Trsf.hxx>
#include <gp_XYZ.hxx>

namespace catoptra::cad_import {

inline glm::dvec3 to_glm(const gp_XYZ& p) {
  return {p.X(), p.Y(), p.Z()};
}

inline glm::dmat4 to_glm(const gp_Trsf& t) {
  glm::dmat4 m(1);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) m[column][row] = t.Value(row + 1, column + 1);
  return m;
}

struct AffineMap {
  glm::dmat3 linear{1};
  glm::dvec3 shift{0};

  AffineMap() = default;
  explicit AffineMap(const glm::dmat4& m) : linear(m), shift(m[3]) {}

  [[nodiscard]] glm::dvec3 point(const gp_XYZ& p) const { return linear * to_glm(p) + shift; }
  [[nodiscard]] glm::dvec3 vector(const gp_XYZ& d) const { return linear * to_glm(d); }
  /// Below 0 where the map mirrors.
  [[nodiscard]] double determinant() const { return glm::determinant(linear); }
  /// Factor on lengths (of a similarity).
  [[nodiscard]] double scale() const { return std::cbrt(std::abs(determinant())); }
};

}  // namespace catoptra::cad_import
