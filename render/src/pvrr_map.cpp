#include "render/src/pvrr_map.h"

#include <algorithm>
#include <cmath>

namespace catoptra::render {
namespace {

constexpr int kSmallest = 16, kLargest = 4096;
// Sizes come in steps, so that a moving camera does not ask for new textures in every frame.
constexpr int kStep = 32;

double twice_area(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
  const glm::dvec2 u = b - a, v = c - a;
  return std::abs(u.x * v.y - u.y * v.x);
}

bool off_screen(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, glm::ivec2 picture) {
  return std::max({a.x, b.x, c.x}) < 0 || std::min({a.x, b.x, c.x}) > picture.x ||
         std::max({a.y, b.y, c.y}) < 0 || std::min({a.y, b.y, c.y}) > picture.y;
}

int texels(double wanted) {
  const int stepped = static_cast<int>(std::ceil(std::clamp(wanted, 1.0, double(kLargest)) / kStep)) * kStep;
  return std::clamp(stepped, kSmallest, kLargest);
}

}  // namespace

PvrrMapSize choose_map_size(const tessellate::OpticArrays& mesh, std::span<const glm::dvec3> pixels,
                            std::span<const glm::dvec3> coordinates, const optics::VirtualView& view,
                            glm::ivec2 picture, double texels_per_pixel) {
  const double aspect = (view.right_side - view.left) / (view.top - view.bottom);
  double pixel_area = 0, map_area = 0;  // the latter in squares of the map's height
  const auto map_point = [&](std::uint32_t i) {
    return glm::dvec2(aspect * coordinates[i].x, coordinates[i].y) / coordinates[i].z;
  };
  for (const auto& triangle : mesh.triangles) {
    const auto [i, j, k] = triangle.vertices;
    if (pixels[i].z <= 0 || pixels[j].z <= 0 || pixels[k].z <= 0) continue;
    if (off_screen(pixels[i], pixels[j], pixels[k], picture)) continue;
    pixel_area += twice_area(pixels[i], pixels[j], pixels[k]);
    map_area += twice_area(map_point(i), map_point(j), map_point(k));
  }
  if (!(pixel_area > 0) || !(map_area > 0)) return {};
  const double pixels_per_height = std::sqrt(pixel_area / map_area);
  PvrrMapSize size;
  size.texels = {texels(texels_per_pixel * pixels_per_height * aspect),
                 texels(texels_per_pixel * pixels_per_height)};
  size.texels_per_pixel = std::sqrt(double(size.texels.x) / aspect * size.texels.y) / pixels_per_height;
  return size;
}

void PvrrMap::resize(const PvrrMapSize& size, bool geometry) {
  size_ = size;
  RasterTarget::fit(target_, size.texels, geometry);
  if (optic_depth_ && view_.size == size.texels) return;
  optic_depth_ = make_texture_2d(GL_DEPTH_COMPONENT32F, size.texels.x, size.texels.y, 1, false);
  optic_depth_framebuffer_ = make_framebuffer({}, &optic_depth_);
  view_.size = size.texels;
}

void PvrrMap::set_empty(bool geometry) {
  resize({}, geometry);
  const glm::vec4 black(0, 0, 0, 1);
  for (const GlTexture* texture : {&target_->color(), &target_->position(), &target_->detail()})
    if (*texture) glClearTexImage(texture->id(), 0, GL_RGBA, GL_FLOAT, &black.x);
}

void PvrrMap::draw(RasterScene& scene, std::size_t optic, const RasterOptic& surface,
                   const optics::VirtualView& view, glm::dvec2 offset_px, bool geometry,
                   const NestedOptics* nested) {
  view_ = map_view(view, size_.texels, offset_px);
  clipped_ = !view.beyond_viewpoint;
  if (clipped_) {
    glBindFramebuffer(GL_FRAMEBUFFER, optic_depth_framebuffer_.id());
    scene.draw_optic_depth(view_, surface);
  }
  RasterPass pass;
  pass.geometry = geometry;
  // A map texel is smaller than a pixel, yet what it shows is to be as sharp as the picture, no sharper.
  pass.level_bias = static_cast<float>(std::log2(size_.texels_per_pixel));
  pass.clip_depth = clip_depth();
  // A little farther than the surface is, so that rounding decides nothing.
  const double farthest = clipped_ ? surface.farthest_mm(view_) : 0;
  pass.clip_reach_mm = farthest + 1e-3 * std::abs(farthest) + 0.1;
  pass.draw_optics = true;
  pass.except = optic;
  if (nested) pass.nested = nested->optics;
  target_->bind(geometry);
  scene.clear(view_, pass);
  if (nested && !nested->optics.empty()) nested->draw(view_, pass, *target_);
  scene.draw_all(view_, pass);
}

}  // namespace catoptra::render
