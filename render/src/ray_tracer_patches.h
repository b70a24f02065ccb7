// A mirror's exact surface as polynomial heights over flat cells, for intersecting many rays at once.
//
// Newton iteration on a CAD surface costs several evaluations of it per ray. Here the surface is evaluated
// when the optic is set up: over a cell of its (u, v) the exact height above a plane through three of the
// cell's corners is interpolated by a polynomial of degree 5 and compared with the surface at other points,
// the cell's border and a little beyond included. Cells that disagree are split, at the knots of a B-spline
// where there are any; those that never agree (a crease, a pole) are left to Newton iteration. A picture in
// single precision cannot tell the polynomials from the surface.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "cad_import/cad_model.h"
#include "cad_import/exact_surface.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::render {

inline constexpr double kHeightTolerance =
    1e-8;  ///< mm; 1/1000 of what a float holds of a coordinate of 100 mm
inline constexpr double kSlopeTolerance = 1e-9;  ///< rad; 1/60 of what a float holds of a unit direction

/// point = corner + b1 e1 + b2 e2 + height(b1, b2) normal, with e1 and e2 along the cell's sides.
struct alignas(64) SurfacePatch {
  static constexpr int kDegree = 5, kCoefficients = (kDegree + 1) * (kDegree + 2) / 2;

  glm::dvec3 corner{0};
  glm::dvec3 g1{0}, g2{0}, normal{0};  ///< dual basis of (e1, e2, normal): b1 = g1 . (point - corner), ...
  double c[kCoefficients] = {};        ///< of b1^i b2^j by j, then i: 6, 5, 4, 3, 2, 1 of them
  bool valid = false;                  ///< agrees with the surface over its cell
};

/// Value and slopes of a patch's height.
struct PatchHeight {
  double value, dx, dy;
};

/// By Horner's scheme in both variables, without loops, so that the compiler can run it for several rays at
/// once.
[[gnu::always_inline]] inline PatchHeight patch_height(const double* c, double x, double y) {
  const double p4 = c[18] + x * c[19];
  const double p3 = c[15] + x * (c[16] + x * c[17]), p3x = c[16] + x * (2 * c[17]);
  const double p2 = c[11] + x * (c[12] + x * (c[13] + x * c[14])),
               p2x = c[12] + x * (2 * c[13] + x * (3 * c[14]));
  const double p1 = c[6] + x * (c[7] + x * (c[8] + x * (c[9] + x * c[10])));
  const double p1x = c[7] + x * (2 * c[8] + x * (3 * c[9] + x * (4 * c[10])));
  const double p0 = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
  const double p0x = c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * (5 * c[5]))));
  return {p0 + y * (p1 + y * (p2 + y * (p3 + y * (p4 + y * c[20])))),
          p0x + y * (p1x + y * (p2x + y * (p3x + y * c[19]))),
          p1 + y * (2 * p2 + y * (3 * p3 + y * (4 * p4 + y * (5 * c[20]))))};
}

/// The height alone.
[[gnu::always_inline]] inline double patch_value(const double* c, double x, double y) {
  const double p4 = c[18] + x * c[19], p3 = c[15] + x * (c[16] + x * c[17]);
  const double p2 = c[11] + x * (c[12] + x * (c[13] + x * c[14]));
  const double p1 = c[6] + x * (c[7] + x * (c[8] + x * (c[9] + x * c[10])));
  const double p0 = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
  return p0 + y * (p1 + y * (p2 + y * (p3 + y * (p4 + y * c[20]))));
}

/// Height and slopes without the terms above degree 3, for a first step.
[[gnu::always_inline]] inline PatchHeight patch_height_cubic(const double* c, double x, double y) {
  const double p2 = c[11] + x * c[12], p1 = c[6] + x * (c[7] + x * c[8]), p1x = c[7] + x * (2 * c[8]);
  const double p0 = c[0] + x * (c[1] + x * (c[2] + x * c[3])), p0x = c[1] + x * (2 * c[2] + x * (3 * c[3]));
  return {p0 + y * (p1 + y * (p2 + y * c[15])), p0x + y * (p1x + y * c[12]),
          p1 + y * (2 * p2 + y * (3 * c[15]))};
}

struct Bend {
  double xx, xy, yy;
};

/// Second derivatives of a patch's height: a level of detail needs no more than their leading terms, up to
/// cubic ones.
[[gnu::always_inline]] inline Bend patch_bend(const double* c, double x, double y) {
  return {
      2 * c[2] + x * (6 * c[3] + x * (12 * c[4])) + y * (2 * c[8] + x * (6 * c[9]) + y * (2 * c[13])),
      c[7] + x * (2 * c[8] + x * (3 * c[9])) + y * (2 * c[12] + x * (4 * c[13]) + y * (3 * c[16])),
      2 * c[11] + x * (2 * c[12] + x * (2 * c[13])) + y * (6 * c[15] + x * (6 * c[16]) + y * (12 * c[18]))};
}

/// A rectangle of (u, v).
struct UvBox {
  glm::dvec2 low{0}, high{0};
};

/// The patches of one face: a tree of cells over its parameters.
class FacePatches {
 public:
  /// Covers `used`, the parameter boxes of the mesh's triangles on the face; cells that meet none are left
  /// out. Runs on all threads. Copies what it needs of `surface`.
  FacePatches(const cad_import::ExactSurface& surface, std::span<const UvBox> used);

  /// Index in patches() of the one for (u, v); parameters outside the domain are brought into it.
  [[nodiscard]] int find(glm::dvec2 uv) const;

  [[nodiscard]] std::span<const SurfacePatch> patches() const { return patches_; }

 private:
  struct Cell {
    UvBox box;
    glm::dvec2 split{0};
    int first_child = -1;  ///< of four: low-low, high-low, low-high, high-high; -1: a leaf
    int patch = 0;
    int depth = 0;
  };

  void split(std::size_t cell, const cad_import::ExactSurface& surface);

  cad_import::ParameterDomain domain_;
  std::vector<Cell> cells_;
  std::vector<SurfacePatch> patches_;
};

/// The patches of all faces of a mesh.
class MeshPatches {
 public:
  /// `mesh` must outlive this and stay as it is.
  MeshPatches(std::span<const cad_import::Face> faces, const tessellate::OpticArrays& mesh);

  /// The patch under a hit on the mesh; `u` and `v`: weights of the triangle's second and third vertex. It
  /// may be one that is not valid.
  [[nodiscard]] const SurfacePatch* patch_of(std::uint32_t triangle, double u, double v) const;

  /// Share of the mesh's triangles whose middle lies on a valid patch, and the number of patches.
  [[nodiscard]] double patched_share() const;
  [[nodiscard]] std::size_t patch_count() const;

 private:
  const tessellate::OpticArrays& mesh_;
  std::vector<FacePatches> faces_;
  std::vector<const SurfacePatch*> patch_of_triangle_;  ///< null: the triangle lies on several patches
};

}  // namespace catoptra::render
