// From the kernel's surface to ours.
#pragma once

#include <Geom_BSplineSurface.hxx>
#include <Geom_Surface.hxx>
#include <memory>

#include "cad_import/bspline_surface.h"
#include "cad_import/src/affine_map.h"

namespace catoptra::cad_import {

/// Parameters that a face uses, to cut unbounded surfaces and to choose the period.
struct ParameterRange {
  double u_min = 0, u_max = 1, v_min = 0, v_max = 1;
};

/// The poles, weights and flat knots of `surface`, placed by `map`; periodic directions are written out.
[[nodiscard]] BSplineData bspline_data(const Handle(Geom_BSplineSurface) & surface, const AffineMap& map);

/// `map`: placement of `surface` in the model. `face_reversed`: the face's outside is against du x dv before
/// `map`. Throws Error for a surface whose data contradict themselves.
[[nodiscard]] std::shared_ptr<const ExactSurface> make_surface(const Handle(Geom_Surface) & surface,
                                                               const AffineMap& map,
                                                               const ParameterRange& range,
                                                               bool face_reversed);

}  // namespace catoptra::cad_import
