// A wavefront's curvature carried along a ray: generalised Coddington equations without a choice of axes.
//
// Near a ray of unit direction d in a medium of index n the eikonal has the Hessian n Q, a symmetric tensor
// with Q d = 0: a displacement x across the ray turns the ray's direction by Q x. Q is positive where light
// diverges, 1/mm. Vergence in dioptre is -1000 Q, positive where light converges. Source: Landgrave and
// Moya-Cessa, JOSA A 13, 1637 (1996); here from equality of phase along the surface, to second order.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "cad_import/exact_surface.h"

namespace catoptra::optics {

struct Wavefront {
  glm::dmat3 curvature{0};  ///< Q, 1/mm, symmetric, Q d = 0; zero: a plane wave
};

/// The wave of a point `distance_mm` behind a ray of unit direction `d` (infinite: a plane wave; negative:
/// the light converges to a point that far ahead).
[[nodiscard]] Wavefront spherical_wavefront(const glm::dvec3& d, double distance_mm);

/// The wave `length_mm` further along the unit direction `d`: Q (I + L Q)^-1. Beyond a focus it comes out
/// inverted; at a focus the result is not finite.
[[nodiscard]] Wavefront transferred(const Wavefront& wave, const glm::dvec3& d, double length_mm);

/// The wave after refraction of the unit direction `d` into `out` (optics::refract) at a surface with these
/// derivatives, with eta = n_from / n_to. The sense of the surface's normal does not matter.
[[nodiscard]] Wavefront refracted(const Wavefront& wave, const glm::dvec3& d, const glm::dvec3& out,
                                  double eta, const cad_import::SurfaceDerivatives& surface);

/// The same after reflection of `d` into `out`.
[[nodiscard]] Wavefront reflected(const Wavefront& wave, const glm::dvec3& d, const glm::dvec3& out,
                                  const cad_import::SurfaceDerivatives& surface);

}  // namespace catoptra::optics
