// PVRR step 3: texture coordinates at which each vertex shows exactly what its ray hits (paper 3.4;
// design 2.5).
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "optics/optic.h"
#include "optics/vertex_hits.h"
#include "optics/virtual_view.h"

namespace catoptra::optics {

/// How the third homogeneous coordinate is chosen, which decides what is shown *between* vertices. The errors
/// of each are in docs/decisions/0002-map-interpolation.md.
enum class MapInterpolation {
  affine,      ///< q = 1, the paper's
  homography,  ///< q = denominator of the least-squares homography from the optic's tangent plane to the map
  fitted,      ///< q = that of the homography from the eye's picture of the optic to the map, times the
               ///< exponential of a quadratic chosen so that the middles of the mesh's edges show what they
               ///< should
};

/// Homogeneous map coordinates (s q, t q, q), one per vertex; the vertex shows (s, t). q > 0, mean 1. To be
/// interpolated linearly over the flat triangles in space, as perspective-correct interpolation on a GPU
/// does. Vertices that do not face the eye get (0.5, 0.5, 1). Where no denominator is positive over the whole
/// optic, q = 1. Exact on planes at any vertex count. Throws catoptra::Error where `hits` do not belong to
/// `optic`.
[[nodiscard]] std::vector<glm::dvec3> map_coordinates(
    const Optic& optic, std::span<const VertexHit> hits, const VirtualView& view,
    MapInterpolation interpolation = MapInterpolation::fitted);

/// The same for a lens, one per vertex of the side entered.
[[nodiscard]] std::vector<glm::dvec3> map_coordinates(
    const Optic& lens, LensSide entered, std::span<const VertexHit> hits, const VirtualView& view,
    MapInterpolation interpolation = MapInterpolation::fitted);

/// The same for a part of an optic: `mesh` is a piece of the mirror's, or of the side at which a lens is
/// entered.
[[nodiscard]] std::vector<glm::dvec3> map_coordinates(
    const Optic& optic, const tessellate::OpticArrays& mesh, std::span<const VertexHit> hits,
    const VirtualView& view, MapInterpolation interpolation = MapInterpolation::fitted);

/// Map coordinates of a further wavelength: what `hits` show, with the denominators q of `reference` (the
/// coordinates of the same vertices at another wavelength, nearly the same map). Vertices that show nothing
/// keep the reference's. Throws catoptra::Error where the counts differ.
[[nodiscard]] std::vector<glm::dvec3> map_coordinates_like(std::span<const glm::dvec3> reference,
                                                           std::span<const VertexHit> hits,
                                                           const VirtualView& view);

}  // namespace catoptra::optics
