// Overlays: the exact hits as red balls, the vertex rays as lines, the optic's mesh in white (paper, Figs. 1,
// 3, 14).
#pragma once

#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <vector>

#include "render/src/gl_objects.h"
#include "render/src/raster_scene.h"

namespace catoptra::render {

struct OverlayBall {
  glm::dvec3 center_mm;
  double radius_mm;
};

struct OverlayLine {
  glm::dvec3 begin_mm, end_mm;
};

/// Balls and lines are part of the scene: the picture and the maps show them, hidden by what is before them.
class Overlay {
 public:
  Overlay();

  void set_balls(std::span<const OverlayBall> balls);
  void set_lines(std::span<const OverlayLine> lines);

  /// Draws into the bound target after RasterScene::draw with the same view and `clip_depth`.
  void draw_in_scene(const RasterView& view, const GlTexture* clip_depth);
  /// The parts of an optic tinted, their borders in white, and, before everything, a line from the middle of
  /// each to its viewpoint, in the part's colour. Forgets the lines set before.
  void draw_patches(const RasterView& view, const RasterOptic& optic,
                    std::span<const OverlayLine> viewpoints);
  /// The mesh of an optic as white lines, to be drawn after the optic itself.
  void draw_mesh(const RasterView& view, const RasterOptic& optic);

 private:
  void begin_lines(const RasterView& view, const RasterOptic& optic, glm::vec3 color, float lift,
                   float opacity);
  const GlProgram& program(bool clip);

  glm::dvec3 origin_mm_{0};  ///< balls are relative to it
  GlBuffer sphere_, balls_, line_ends_;
  GlVertexArray ball_array_, line_array_;
  glm::dvec3 line_origin_mm_{0};
  GLsizei sphere_vertices_ = 0, ball_count_ = 0, line_vertices_ = 0;
  std::map<bool, GlProgram> programs_;
};

}  // namespace catoptra::render
