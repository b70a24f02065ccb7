// Where a ray meets one side of a lens, found without its mesh: a grid over the side's plane knows nearly
// where, and Newton's iteration on the exact surface does the rest.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "optics/exact_hit.h"
#include "optics/optic.h"
#include "optics/ray_packet.h"

namespace catoptra::optics {

/// A grid over the plane across a side's mean normal. Each cell holds one face's height over the plane and
/// its parameters, expanded to second order at a point of the cell, so that Newton's iteration needs an
/// evaluation or two. Immutable, thread-safe.
class LensSideStart {
 public:
  /// `faces` must outlive this; `mesh` is theirs and has triangles.
  LensSideStart(std::span<const cad_import::Face> faces, const tessellate::OpticArrays& mesh);

  /// The only hit of `ray` on the side, trimming tested. Nullopt does not mean that there is none: the ray
  /// may be too flat to meet the side only once, or pass near its outline, or the iteration did not converge
  /// at once. A search in the mesh decides then.
  [[nodiscard]] std::optional<ExactHit> hit(const Ray& ray) const;

 private:
  struct Cell {
    double x = 0, y = 0;  // on the plane, of the point of expansion
    // a + b x + c y + d x^2 + e x y + f y^2, x and y from there: height over the plane and parameters.
    double height[6] = {}, u[6] = {}, v[6] = {};
    std::int32_t face = -1;   // -1: no start here
    std::int32_t other = -1;  // a cell near with another face
    bool near = true;         // on the mesh or beside it
    bool inside = false;      // no outline passes near: trimming need not be asked
  };
  struct SideFace {
    const cad_import::ExactSurface* surface;
    const cad_import::FaceTrim* trim;  // null: the whole surface
    cad_import::ParameterDomain domain;
    double orientation;
  };

  void set_plane(const tessellate::OpticArrays& mesh);
  void expand_cells(const tessellate::OpticArrays& mesh);
  void spread_to_empty_cells();
  void mark_outlines(const tessellate::OpticArrays& mesh);
  [[nodiscard]] glm::dvec2 on_plane(const glm::dvec3& point) const;
  [[nodiscard]] Cell expanded(std::int32_t face, const glm::dvec2& uv) const;
  [[nodiscard]] int cell_number(double x, double y) const;
  template <class Visit>
  void around(int at, int reach, const Visit& visit) const;
  [[nodiscard]] std::optional<ExactHit> hit_from(const Cell& cell, const Ray& ray, double x, double y) const;

  std::vector<SideFace> faces_;
  glm::dvec3 origin_{0}, axis_x_{1, 0, 0}, axis_y_{0, 1, 0}, normal_{0, 0, 1};
  double least_slope_ = 2;  // cosine of ray and normal from which on no ray meets the side twice
  int count_ = 1;           // cells a side
  double x_min_ = 0, y_min_ = 0, cells_per_mm_ = 1;
  std::vector<Cell> cells_;  // row by row
};

}  // namespace catoptra::optics
