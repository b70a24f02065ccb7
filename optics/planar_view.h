// The view by way of a plane: what an eye sees in a plane mirror, behind a change of medium, through a plate,
// as the picture of another eye on the first one's own image. Source: Diefenbach and Badler 1994,
// "Reflections", "Refractions" and appendix; docs/planar-optics.md has the derivation and the errors of the
// refracted views.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace catoptra::optics {

struct Plane {
  glm::dvec3 point_mm{0};
  glm::dvec3 normal{0, 0, 1};  ///< unit

  /// Positive on the side to which the normal points, mm.
  [[nodiscard]] double height_mm(const glm::dvec3& point) const;
};

/// A picture: image * (p - eye) = w (x, y, 1) for a point p, with image coordinates (x, y) of any scale; w >
/// 0 before the eye.
struct ProjectiveView {
  glm::dvec3 eye_mm{0};
  glm::dmat3 image{1};
};

/// What `view` sees in the mirror `plane`, on its own image: exact for every point.
[[nodiscard]] ProjectiveView mirrored(const ProjectiveView& view, const Plane& plane);

/// What `eye_mm` sees beyond the plane, in an image in which every point of the plane is where it is in
/// `view`. This is the paper's map M3 of the two pictures of a face, after the projection of the new eye; w
/// of points of the plane stays what it is in `view`, too. `eye_mm` is on the same side of the plane as the
/// view's eye.
[[nodiscard]] ProjectiveView through(const ProjectiveView& view, const Plane& plane,
                                     const glm::dvec3& eye_mm);

/// Where the eye of a refracted camera is put.
enum class RefractedEye {
  rotated,   ///< the paper's: the camera rotated about the point of the plane, its distance from there kept
  sagittal,  ///< farther off by n_to / n_from: where, to first order across the plane of incidence, the rays
             ///< about that point seem to come from
};

/// The eye behind a change of medium: on the line of the exactly refracted ray through `at_mm`, a point of
/// the plane. `eta` = n_from / n_to > 0, the eye being in n_from. Nullopt beyond the critical angle.
[[nodiscard]] std::optional<glm::dvec3> refracted_eye(const glm::dvec3& eye_mm, const glm::dvec3& at_mm,
                                                      const Plane& plane, double eta,
                                                      RefractedEye place = RefractedEye::sagittal);

/// How far a plate of index `ior` (against what is around it) moves what is seen through it towards the eye
/// along its normal, for light that arrives with `cos_theta_i` in (0, 1], mm: t (1 - tan b / tan a), a and b
/// the angles outside and inside. Exact for every ray of that angle; t (1 - 1 / n) at right angles.
[[nodiscard]] double plate_shift_mm(double thickness_mm, double ior, double cos_theta_i);

/// Whether all light from the eye to `at_mm` is reflected there. `eta` as above.
[[nodiscard]] bool totally_reflected(const glm::dvec3& eye_mm, const glm::dvec3& at_mm, const Plane& plane,
                                     double eta);

using Quad = std::array<glm::dvec2, 4>;

/// The projective map of the corners (0, 0), (1, 0), (1, 1), (0, 1) of the unit square to `quad` (appendix,
/// A1 to A3), as m * (x, y, 1). Nullopt where three corners are in line.
[[nodiscard]] std::optional<glm::dmat3> square_to_quad(const Quad& quad);
/// The same from one quadrilateral to another: by way of the square (appendix).
[[nodiscard]] std::optional<glm::dmat3> quad_to_quad(const Quad& from, const Quad& to);

}  // namespace catoptra::optics
