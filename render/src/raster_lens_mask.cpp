#include "render/src/raster_lens_mask.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "render/src/raster_scene.h"

namespace catoptra::render {
namespace {

constexpr int kSize = 1024;
constexpr double kBorder = 1.01;  // so that the outermost texels are empty

/// Rows: two axes across the mean normal of the surface, and that normal.
glm::dmat3 axes_of(const tessellate::OpticArrays& mesh) {
  glm::dvec3 normal(0);
  for (const auto& t : mesh.triangles) {
    const glm::dvec3& a = mesh.vertices[t.vertices[0]].position_mm;
    normal += glm::cross(mesh.vertices[t.vertices[1]].position_mm - a,
                         mesh.vertices[t.vertices[2]].position_mm - a);
  }
  normal = glm::normalize(normal);
  const glm::dvec3 helper = std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(helper, normal));
  return glm::transpose(glm::dmat3(right, glm::cross(normal, right), normal));
}

}  // namespace

LensMask::LensMask(const RasterScene& scene, const RasterOptic& exit, const tessellate::OpticArrays& mesh)
    : center_mm_(exit.center_mm()), axes_(axes_of(mesh)) {
  glm::dvec3 half(0);
  for (const auto& v : mesh.vertices) half = glm::max(half, glm::abs(axes_ * (v.position_mm - center_mm_)));
  half_mm_ = kBorder * glm::dvec2(half);

  RasterView view;
  view.origin_mm = center_mm_;
  view.rotation = axes_;
  view.size = {kSize, kSize};
  view.bottom_row_first = true;
  view.projection = glm::dmat4(1);
  view.projection[0][0] = 1 / half_mm_.x;
  view.projection[1][1] = 1 / half_mm_.y;
  // Depth is not tested, but has to lie between 0 and 1.
  view.projection[2][2] = 0.25 / (half.z + 1);
  view.projection[3][2] = 0.5;

  texture_ = make_texture_2d(GL_R8, kSize, kSize, 1, true);
  const GlFramebuffer framebuffer = make_framebuffer({&texture_}, nullptr);
  const GlProgram program =
      make_program({"raster_view.glsl", "raster_surface.vert.glsl"}, {"raster_mask.frag.glsl"});
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  scene.begin_view(view, 0);
  glDisable(GL_DEPTH_TEST);
  const glm::vec4 nothing(0);
  glClearBufferfv(GL_COLOR, 0, &nothing.x);
  glUseProgram(program.id());
  RasterScene::set_mesh_origin(view, center_mm_);
  exit.draw_surface();
  glEnable(GL_DEPTH_TEST);
}

glm::dvec2 LensMask::place(const glm::dvec3& point_mm) const {
  return 0.5 + 0.5 * glm::dvec2(axes_ * (point_mm - center_mm_)) / half_mm_;
}

}  // namespace catoptra::render
