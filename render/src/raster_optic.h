// The mesh of an optical surface on the GPU. Only the map coordinates change from frame to frame.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "optics/placement.h"
#include "render/src/gl_objects.h"
#include "render/src/raster_view.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::render {

/// A mirror's mesh, or that of one side of a lens. Attribute locations as in raster_surface.vert.glsl:
/// position relative to `center_mm`, normal, map coordinates.
class RasterOptic {
 public:
  /// Without a skirt, draw_surface_with_skirt() draws the surface alone.
  explicit RasterOptic(const tessellate::OpticArrays& mesh, bool with_skirt = true);

  /// Divides the surface into parts of so many triangles, which follow each other; without this it is one
  /// part.
  void set_parts(std::span<const std::size_t> triangles);
  [[nodiscard]] std::size_t part_count() const { return part_begins_.size() - 1; }

  /// Homogeneous map coordinates (s q, t q, q), one per vertex of the mesh.
  void set_map_coordinates(std::span<const glm::dvec3> coordinates);

  /// Each draws with whatever program is in use, which must have been given the optic as its mesh
  /// (RasterScene::set_mesh_origin).
  void draw_surface() const;
  /// The mesh's edges as lines; those with one triangle alone, which are the borders of surface and parts.
  void draw_edges() const;
  void draw_borders() const;
  /// The surface, continued outwards along the tangent plane at its border by its own radius.
  void draw_surface_with_skirt() const;

  /// The triangles' vertices and positions and normals, at binding point 0, for further attributes.
  [[nodiscard]] GlVertexArray make_array() const;
  /// Part `part` alone.
  void draw_part(std::size_t part) const { draw_part(part, surface_array_); }
  void draw_part(std::size_t part, const GlVertexArray& array) const;

  /// In the optic's own frame, as the mesh is.
  [[nodiscard]] const glm::dvec3& center_mm() const { return center_mm_; }

  /// Where that frame is in the world.
  void place(const optics::Placement& placement) { placement_ = placement; }
  [[nodiscard]] const optics::Placement& placement() const { return placement_; }

  /// The largest distance along the direction of `view`, of surface and skirt, mm.
  [[nodiscard]] double farthest_mm(const RasterView& view) const;

 private:
  glm::dvec3 center_mm_{0};
  optics::Placement placement_;
  std::vector<glm::vec3> points_;  ///< of surface and skirt, relative to the centre
  GlBuffer vertices_, map_coordinates_, triangles_, edges_, borders_, skirt_vertices_;
  GlVertexArray surface_array_, edge_array_, border_array_, skirt_array_;
  std::vector<GLsizei> part_begins_;  ///< in the triangles' indices, and their end
  GLsizei triangle_indices_ = 0, edge_indices_ = 0, border_indices_ = 0, skirt_vertex_count_ = 0;
};

/// The mean of the surface points weighted by area, mm.
[[nodiscard]] glm::dvec3 area_centroid(const tessellate::OpticArrays& mesh);

}  // namespace catoptra::render
