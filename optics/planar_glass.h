// Planar optics: the plane of a face, and what a plate and fog do to light
// (docs/decisions/0015-planar-optics-and-light.md).
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "optics/optic.h"

namespace catoptra::optics {

/// A flat face: the centroid of its area, its unit normal (to the front), and unit vectors in it along its
/// first edge and across.
struct PlanarFace {
  glm::dvec3 centre_mm{0}, normal{0, 0, 1}, along{1, 0, 0}, across{0, 1, 0};
};

/// The face of a planar optic, from its mesh.
[[nodiscard]] PlanarFace planar_face(const Optic& optic);

/// The normal of the face tilted towards its first edge and across it, radians, each below pi / 2.
[[nodiscard]] glm::dvec3 tilted_normal(const PlanarFace& face, const glm::dvec2& tilt_rad);

/// Share of unpolarised light that a plate reflects whose two borders reflect the share `border` each, with
/// all internal reflections, incoherent and without absorption: 2 R / (1 + R). What is not reflected passes.
/// Source: Born & Wolf, Principles of Optics, 7th ed., 7.6.1, summed without phases.
[[nodiscard]] double plate_reflectance(double border);

/// Where, measured from the point at which a ray of unit direction `d` meets the front of a plate, the line
/// on which it leaves the plate crosses that front: -t (tan a - tan b) e, mm, with a and b the angles in air
/// and glass and e the direction of `d` along the plate. `normal`: unit, of either sense; `ior` at least 1;
/// `d` not along the plate. Source: Hecht 2017, 4.4 (Snell at two parallel borders).
[[nodiscard]] glm::dvec3 plate_shift(const glm::dvec3& d, const glm::dvec3& normal, double ior,
                                     double thickness_mm);

/// Share of fog in light that has come `way_mm` (infinite: from the sky) through air of translucency 0 .. 1,
/// the share over 1 m: 1 - (1 - f)^(s / 1 m). 0 where translucency is.
[[nodiscard]] double fog_share(double translucency, double way_mm);

}  // namespace catoptra::optics
