#include "render/src/overlay_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

namespace catoptra::render {
namespace {

constexpr GLint kColor = 2, kLift = 5;  // as in overlay_line.*.glsl
constexpr GLuint kBallAttribute = 3, kOpticDepthUnit = 1;

/// A unit sphere: the octahedron with every face divided into 16.
std::vector<glm::vec3> make_sphere() {
  constexpr int kDivisions = 4;
  std::vector<glm::vec3> triangles;
  for (int octant = 0; octant < 8; ++octant) {
    const glm::vec3 sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
    const auto at = [&](int i, int j) {
      return glm::normalize(sign * glm::vec3(float(i), float(j), float(kDivisions - i - j)));
    };
    for (int i = 0; i < kDivisions; ++i)
      for (int j = 0; i + j < kDivisions; ++j) {
        triangles.insert(triangles.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < kDivisions)
          triangles.insert(triangles.end(), {at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
  return triangles;
}

// A thousandth of the distance lifts lines off the facets that they lie on.
constexpr float kLineLift = 1e-3f;

/// Hues that follow each other by the golden angle differ as much as they can, however many there are.
glm::vec3 patch_color(std::size_t patch) {
  const auto channel = [&](float shift) {
    const float hue = std::fmod(0.381966f * float(patch) + shift, 1.0f);
    return std::clamp(std::abs(6 * hue - 3) - 1, 0.0f, 1.0f);
  };
  return {channel(0), channel(2.0f / 3), channel(1.0f / 3)};
}

}  // namespace

Overlay::Overlay() {
  const std::vector<glm::vec3> sphere = make_sphere();
  sphere_vertices_ = static_cast<GLsizei>(sphere.size());
  sphere_ = make_static_buffer(std::as_bytes(std::span(sphere)));
  balls_ = make_dynamic_buffer(0);
  line_ends_ = make_dynamic_buffer(0);
  ball_array_ = make_vertex_array({});
  bind_attributes(ball_array_, 0, sphere_, sizeof(glm::vec3), {{0, 3, 0}});
  bind_attributes(ball_array_, 1, balls_, sizeof(glm::vec4), {{kBallAttribute, 4, 0}});
  glVertexArrayBindingDivisor(ball_array_.id(), 1, 1);
  line_array_ = make_vertex_array({});
  bind_attributes(line_array_, 0, line_ends_, sizeof(glm::vec3), {{0, 3, 0}});
}

void Overlay::set_balls(std::span<const OverlayBall> balls) {
  ball_count_ = static_cast<GLsizei>(balls.size());
  if (balls.empty()) return;
  origin_mm_ = balls.front().center_mm;
  std::vector<glm::vec4> narrow;
  narrow.reserve(balls.size());
  for (const OverlayBall& ball : balls)
    narrow.emplace_back(glm::vec3(ball.center_mm - origin_mm_), static_cast<float>(ball.radius_mm));
  update_buffer(balls_, std::as_bytes(std::span(narrow)));
}

void Overlay::set_lines(std::span<const OverlayLine> lines) {
  line_vertices_ = static_cast<GLsizei>(2 * lines.size());
  if (lines.empty()) return;
  line_origin_mm_ = lines.front().begin_mm;
  std::vector<glm::vec3> narrow;
  narrow.reserve(2 * lines.size());
  for (const OverlayLine& line : lines) {
    narrow.emplace_back(line.begin_mm - line_origin_mm_);
    narrow.emplace_back(line.end_mm - line_origin_mm_);
  }
  update_buffer(line_ends_, std::as_bytes(std::span(narrow)));
}

void Overlay::draw_in_scene(const RasterView& view, const GlTexture* clip_depth) {
  if (ball_count_ == 0 && line_vertices_ == 0) return;
  glUseProgram(program(clip_depth != nullptr).id());
  if (clip_depth) glBindTextureUnit(kOpticDepthUnit, clip_depth->id());
  glUniform1f(kLift, 0);
  if (ball_count_ > 0) {
    RasterScene::set_mesh_origin(view, origin_mm_);
    glUniform3f(kColor, 0.9f, 0.02f, 0.02f);
    glBindVertexArray(ball_array_.id());
    glDrawArraysInstanced(GL_TRIANGLES, 0, sphere_vertices_, ball_count_);
  }
  if (line_vertices_ > 0) {
    RasterScene::set_mesh_origin(view, line_origin_mm_);
    glUniform3f(kColor, 0.9f, 0.8f, 0.1f);
    glVertexAttrib4f(kBallAttribute, 0, 0, 0, 1);
    glBindVertexArray(line_array_.id());
    glDrawArrays(GL_LINES, 0, line_vertices_);
  }
}

void Overlay::draw_mesh(const RasterView& view, const RasterOptic& optic) {
  // Half transparent, so that the balls which the vertices show stay visible under the lines.
  begin_lines(view, optic, glm::vec3(1), kLineLift, 0.5f);
  optic.draw_edges();
  glDisable(GL_BLEND);
}

void Overlay::begin_lines(const RasterView& view, const RasterOptic& optic, glm::vec3 color, float lift,
                          float opacity) {
  glUseProgram(program(false).id());
  RasterScene::set_mesh_origin(view, optic);
  glUniform3f(kColor, color.r, color.g, color.b);
  glUniform1f(kLift, lift);
  glVertexAttrib4f(kBallAttribute, 0, 0, 0, 1);
  glEnable(GL_BLEND);
  glBlendColor(0, 0, 0, opacity);
  glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
}

void Overlay::draw_patches(const RasterView& view, const RasterOptic& optic,
                           std::span<const OverlayLine> viewpoints) {
  for (std::size_t part = 0; part < optic.part_count(); ++part) {
    begin_lines(view, optic, patch_color(part), 0.5f * kLineLift, 0.3f);
    optic.draw_part(part);
  }
  begin_lines(view, optic, glm::vec3(1), kLineLift, 1);
  optic.draw_borders();
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  for (std::size_t part = 0; part < viewpoints.size(); ++part) {
    set_lines(viewpoints.subspan(part, 1));
    glUseProgram(program(false).id());
    RasterScene::set_mesh_origin(view, line_origin_mm_);
    const glm::vec3 color = patch_color(part);
    glUniform3f(kColor, color.r, color.g, color.b);
    glUniform1f(kLift, 0);
    glBindVertexArray(line_array_.id());
    glDrawArrays(GL_LINES, 0, line_vertices_);
  }
  set_lines({});
  glEnable(GL_DEPTH_TEST);
}

const GlProgram& Overlay::program(bool clip) {
  const auto found = programs_.find(clip);
  if (found != programs_.end()) return found->second;
  const std::vector<std::string> defines(clip ? 1 : 0, "CLIP_AGAINST_OPTIC");
  return programs_
      .emplace(clip, make_program({"raster_view.glsl", "overlay_line.vert.glsl"}, {"overlay_line.frag.glsl"},
                                  defines))
      .first->second;
}

}  // namespace catoptra::render
