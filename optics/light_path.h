// Light by way of planar optics: virtual lights with their apertures (docs/decisions/0015, section "Light").
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "optics/optic.h"

namespace catoptra::optics {

/// Homogeneous place of a light that is a point: (position in mm, 1), or (unit direction *towards* the light,
/// 0).
using LightPlace = glm::dvec4;

/// Corners in order in one plane, in either sense, at least three.
using ConvexPolygon = std::vector<glm::dvec3>;

/// `count` points of equal share in the unit disc; no two the same, the mean at the centre, and the same ones
/// in every call. A spiral by the golden ratio of points and their opposites, after Vogel, Mathematical
/// Biosciences 44, 1979. Throws Error where count < 1.
[[nodiscard]] std::vector<glm::dvec2> disc_points(int count);

/// Those points on the disc of `radius_mm` across `axis` (any length) about a position, or, for a direction,
/// on the disc 1 m from what is lit across that direction (`axis` does not matter): places of `count` lights.
/// The centre alone where the radius is 0.
[[nodiscard]] std::vector<LightPlace> disc_lights(const LightPlace& centre, const glm::dvec3& axis,
                                                  double radius_mm, int count);

/// A planar optic as light meets it.
struct LightFace {
  std::size_t optic = 0;  ///< index among the scene's optics
  OpticKind kind = OpticKind::mirror;
  glm::dvec3 centroid_mm{0};          ///< of the area
  glm::dvec3 normal{0, 0, 1};         ///< unit, to the front
  std::vector<ConvexPolygon> pieces;  ///< make up the outline, without overlap
  bool one_sided = false;             ///< only what comes from the front is reflected or passes
  glm::vec3 reflectance{0.9f};        ///< mirror
  glm::vec3 tint{1};                  ///< glass
  double ior = 1.5;                   ///< glass: behind the face over before it
  double thickness_mm = 0;            ///< pane
};

/// Of the optics that are planar, in their order. Throws Error where one's mesh does not lie in a plane or
/// has no area.
[[nodiscard]] std::vector<LightFace> light_faces(std::span<const Optic> optics);

/// A light as one planar optic sends it on, the light before it being the source or another virtual light.
/// A point P is lit if the segment from P to `place` crosses `aperture` at Q, P to Q is free, and Q is lit by
/// the light before. Its irradiance across the beam is that of the source times `gain` (over the squared
/// distance of `place` in metres, where it is a position) times face_share() of every step.
struct VirtualLight {
  int before = -1;              ///< index in the same list, less than its own; -1: the source
  std::size_t face = 0;         ///< index in the list of faces
  bool reflected = true;        ///< else passed
  double n_from = 1, n_to = 1;  ///< indices before and behind the face, as this light meets it
  LightPlace place{0, 0, 1, 0};
  double gain = 1;  ///< of this step and all before it
  /// Parts of the face that the light before reaches if nothing opaque stands in its way.
  std::vector<ConvexPolygon> aperture;
  /// Lit points P have dot(lit_side, (P, 1)) > 0: the face's plane, unit normal.
  glm::dvec4 lit_side{0, 0, 1, 0};
};

/// All virtual lights of a source by way of at most `depth` faces, without those that light nothing: whose
/// face is turned away (or seen edge-on) or out of the light's way, or met at the centroid beyond the
/// critical angle. Every light comes after the one before it.
[[nodiscard]] std::vector<VirtualLight> virtual_lights(const LightPlace& source,
                                                       std::span<const LightFace> faces, int depth);

/// Number of planar optics on the way.
[[nodiscard]] int step_count(std::span<const VirtualLight> lights, std::size_t index);

/// The planes about what a light sends through `piece` of its aperture: points P inside have
/// dot(plane, (P, 1)) >= 0 for all of them. First the face's own plane, then one for each side. Unit normals.
[[nodiscard]] std::vector<glm::dvec4> light_volume(const VirtualLight& light, const ConvexPolygon& piece);

/// What the face leaves of the light that meets it at an angle of incidence of cosine `cos_theta_i`, linear
/// RGB: reflectance or Fresnel's R (pane: R'), or tint times Fresnel's 1 - R (pane: T').
[[nodiscard]] glm::dvec3 face_share(const LightFace& face, const VirtualLight& light, double cos_theta_i);

/// How light comes to a point.
struct LightPath {
  /// Where it meets the faces, from the last (which lights the point) to the first.
  std::vector<glm::dvec3> points;
  glm::dvec3 share{1};  ///< product of face_share() over the faces
};

/// The way of virtual light `index` to `point`; nullopt where the light does not reach it through its
/// apertures. Takes no account of what stands in the way.
[[nodiscard]] std::optional<LightPath> light_path(std::span<const VirtualLight> lights,
                                                  std::span<const LightFace> faces, const LightPlace& source,
                                                  std::size_t index, const glm::dvec3& point);

/// Irradiance of a surface of unit normal `normal` at `point` by a light of unit strength (1 across the beam
/// of a direction, or at 1 m from a position) at `place`; 0 where it is turned away.
[[nodiscard]] double unit_irradiance(const LightPlace& place, const glm::dvec3& point,
                                     const glm::dvec3& normal);

/// dot(plane, (P, 1)): for a unit normal the height of a point above the plane, mm.
[[nodiscard]] double side_of(const glm::dvec4& plane, const glm::dvec3& point);

/// From `point` to the light, mm for a position; not normalised.
[[nodiscard]] glm::dvec3 towards(const LightPlace& place, const glm::dvec3& point);

/// Where the line from `point` to the light meets `plane`, which it must not run along.
[[nodiscard]] glm::dvec3 crossing(const glm::dvec4& plane, const LightPlace& place, const glm::dvec3& point);

/// The part of a convex polygon with dot(plane, (P, 1)) >= 0; empty where there is none.
[[nodiscard]] ConvexPolygon clip(const ConvexPolygon& polygon, const glm::dvec4& plane);

}  // namespace catoptra::optics
