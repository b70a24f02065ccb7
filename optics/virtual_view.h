// PVRR step 2: the virtual viewpoint and view volume from which the reflection map is rendered
// (paper 3.2, 3.3, 4.3).
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "optics/optic.h"
#include "optics/vertex_hits.h"

namespace catoptra::optics {

/// The point nearest to all lines x_i + s d_i in the least-squares sense: minimises sum |(I - d d^T)(x -
/// o)|^2.
struct ViewpointFit {
  glm::dvec3 viewpoint_mm{0};
  double residual_mm = 0;  ///< root mean square distance of the lines from the viewpoint
  bool parallel = false;   ///< the lines are parallel to working precision: there is no viewpoint
};
[[nodiscard]] ViewpointFit fit_viewpoint(std::span<const glm::dvec3> points,
                                         std::span<const glm::dvec3> directions);

enum class MapProjection { perspective, parallel };

/// A camera for the reflection map. Right-handed: `right` x `up` = -`direction`; the camera looks along
/// `direction`. Map coordinates (s, t) run over [0, 1]^2, s along `right`, t along `up`.
struct VirtualView {
  MapProjection projection = MapProjection::perspective;
  glm::dvec3 viewpoint_mm{0};  ///< perspective: the centre; parallel: a point on the near plane
  glm::dvec3 direction{0, 0, -1}, up{0, 1, 0}, right{1, 0, 0};
  double left = -1, right_side = 1, bottom = -1,
         top = 1;  ///< perspective: at unit distance (tangents); parallel: mm
  double near_mm = 1, far_mm = 1e6;
  double residual_mm = 0;
  glm::dvec2 fov_rad{0};  ///< horizontal, vertical; 0 for a parallel projection
  bool beyond_viewpoint =
      false;  ///< rays converge in front of the optic: the map shows the reversed region (Fig. 8) ...
  double zooming_near_mm = 0,
         zooming_far_mm = 0;  ///< ... and what lies so far from the viewpoint back towards the optic: the
                              ///< zooming region. 0: there is none
  bool fov_clamped =
      false;  ///< some rays leave the widest volume a projection can have: they are not in the map

  /// World (mm) to eye space, and eye space to clip space with reversed depth: near -> 1, far -> 0.
  [[nodiscard]] glm::dmat4 view_matrix() const;
  [[nodiscard]] glm::dmat4 projection_matrix() const;

  /// Whether the map also shows a zooming region, between optic and viewpoint.
  [[nodiscard]] bool zooms() const { return zooming_far_mm > zooming_near_mm; }
  /// The same two for the zooming region. A perspective from the viewpoint, mirrored in it: a point and its
  /// mirror image, in the reversed region, come out at the same place. Depth is 1 at zooming_near_mm and 0 at
  /// zooming_far_mm; the ray comes from there. Requires zooms().
  [[nodiscard]] glm::dmat4 zooming_view_matrix() const;
  [[nodiscard]] glm::dmat4 zooming_projection_matrix() const;

  /// Homogeneous map coordinates (s w, t w, w) of a world point, or of a direction (a point at infinity). w <
  /// 0 for points before the viewpoint, as those of the zooming region are; (s, t) holds for them too.
  [[nodiscard]] glm::dvec3 project_point(const glm::dvec3& point_mm) const;
  [[nodiscard]] glm::dvec3 project_direction(const glm::dvec3& direction) const;

  /// The ray that map coordinates (s, t) show: from the viewpoint (or the near plane) on.
  [[nodiscard]] Ray map_ray(double s, double t) const;
};

/// Fits viewpoint, volume and up vector to the vertices that face the eye. `scene_bounds` bounds the far
/// plane. The near plane lies in front of all that may be seen, not behind the mirror: what is behind the
/// mirror's surface is cut by comparing with the optic's own depth (design 2.3), which the renderer does per
/// fragment. The volume holds every ray segment from the optic on, with a border of `margin` of its width on
/// each side; where rays converge before the optic (beyond_viewpoint) all but the piece around the viewpoint
/// between the near planes of zooming and reversed region, where no perspective from there says anything.
/// Throws catoptra::Error where no vertex faces the eye.
[[nodiscard]] VirtualView make_virtual_view(const Optic& optic, std::span<const VertexHit> hits,
                                            const cad_import::BoundingBox& scene_bounds,
                                            double margin = 0.01);

/// The same for a part of an optic: `mesh` is a piece of the mirror's, or of the side at which a lens is
/// entered, and `hits` belong to it.
[[nodiscard]] VirtualView make_virtual_view(const Optic& optic, const tessellate::OpticArrays& mesh,
                                            std::span<const VertexHit> hits,
                                            const cad_import::BoundingBox& scene_bounds,
                                            double margin = 0.01);

/// The same for a lens entered from side `entered`. `hits` holds the rays of one wavelength, one per vertex
/// of that side, or those of several wavelengths one list after the other: one volume then holds them all.
[[nodiscard]] VirtualView make_virtual_view(const Optic& lens, LensSide entered,
                                            std::span<const VertexHit> hits,
                                            const cad_import::BoundingBox& scene_bounds,
                                            double margin = 0.01);

}  // namespace catoptra::optics
