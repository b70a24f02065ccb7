// Which faces of a CAD model are the front, the back and the rim of a lens, and what they measure.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cad_import/cad_model.h"
#include "cad_import/error.h"

namespace catoptra::cad_import {

/// Integral of the outward unit normal over a face, mm^2, by Stokes' theorem half the integral of r x dr
/// along its boundary; the sides of seams cancel.
[[nodiscard]] glm::dvec3 area_vector(const Face& face);

/// The optical axis of two surfaces and what they are along it.
struct LensGeometry {
  glm::dvec3 axis{0, 0, 1};  ///< unit, from the back to the front
  glm::dvec3 front_vertex_mm{0}, back_vertex_mm{0};
  double center_thickness_mm = 0;  ///< along the axis between the vertices, > 0
  /// At the vertices, positive where convex as seen from outside the lens.
  PrincipalCurvatures front_curvature, back_curvature;
};

/// Measures the lens between two sides, one or more faces each, whichever way their normals point. Its axis
/// is the coordinate axis within 2 degrees of the front's area vector (integral of the normal), through the
/// point of the front whose normal it is, else through that of the back, else through the front's middle.
/// Where no coordinate axis is so near: the line normal to both sides, else the direction of their area
/// vectors. Throws Error(`file`, ...) where the sides do not lie behind one another, or cross.
[[nodiscard]] LensGeometry measure_lens(std::span<const Face> front, std::span<const Face> back,
                                        const std::string& file);

/// Indices in CadModel::faces, ascending.
struct LensFaces {
  std::vector<int> front, back;
  std::vector<int> rim;  ///< what else the body has that holds the front; empty for loose surfaces
  LensGeometry geometry;
};

/// Finds the lens in `model`. Sides given by `front` and `back` (indices; empty: to be found) are taken as
/// they are. Others are the largest pair of smooth groups of faces of one solid that look away from each
/// other: faces named "front" and "back" tell which is which, else the front is the more convex one, else the
/// one farther along the positive axis. Throws Error(`model.file`, ...) for open shells and for models that
/// have no such pair unless both sides are given, for a face on both sides, and as measure_lens.
[[nodiscard]] LensFaces recognise_lens(const CadModel& model, std::span<const int> front = {},
                                       std::span<const int> back = {});

/// The lens that the solid `body` (index) is, for reports; nullopt where it does not look like one: no pair
/// of facing sides that makes up most of what it shows along an axis, both sides planar, thicker than wide,
/// of more than 64 faces, or a mirror glass by the names of its faces (those that write_mirror_blank gives).
[[nodiscard]] std::optional<LensFaces> lens_in_body(const CadModel& model, int body);

}  // namespace catoptra::cad_import
