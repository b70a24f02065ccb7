// The mesh of an optical surface on the GPU. Only the map coordinates change from frame to frame.
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "render/src/gl_objects.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::render {

/// A mirror's mesh, or that of one side of a lens. Attribute locations as in raster_surface.vert.glsl:
/// position relative to `center_mm`, normal, map coordinates.
class RasterOptic {
 public:
  explicit RasterOptic(const tessellate::OpticArrays& mesh);

  /// Homogeneous map coordinates (s q, t q, q), one per vertex of the mesh.
  void set_map_coordinates(std::span<const glm::dvec3> coordinates);

  /// Each draws with whatever program is in use, which must have been given `center_mm` as the mesh's origin.
  void draw_surface() const;
  /// The mesh's edges as lines.
  void draw_edges() const;
  /// The surface, continued outwards along the tangent plane at its border by its own radius.
  void draw_surface_with_skirt() const;

  /// The triangles' vertices and positions and normals, at binding point 0, for further attributes.
  [[nodiscard]] GlVertexArray make_array() const;
  void draw_triangles(const GlVertexArray& array) const;

  [[nodiscard]] const glm::dvec3& center_mm() const { return center_mm_; }

 private:
  glm::dvec3 center_mm_{0};
  GlBuffer vertices_, map_coordinates_, triangles_, edges_, skirt_vertices_;
  GlVertexArray surface_array_, edge_array_, skirt_array_;
  GLsizei triangle_indices_ = 0, edge_indices_ = 0, skirt_vertex_count_ = 0;
};

/// The mean of the surface points weighted by area, mm.
[[nodiscard]] glm::dvec3 area_centroid(const tessellate::OpticArrays& mesh);

}  // namespace catoptra::render
