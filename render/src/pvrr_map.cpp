#include "render/src/pvrr_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptra::render {
namespace {

constexpr int kSmallest = 16, kLargest = 4096;
// Sizes come in steps, so that a moving camera does not ask for new textures in every frame.
constexpr int kStep = 32;
// Beside the optic the zooming region ends at this share of its depth: see PvrrMap::draw.
constexpr double kBeside = 0.9;

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

void PvrrMap::resize(const AtlasLayout& layout, bool geometry) {
  layout_ = layout;
  RasterTarget::fit(target_, layout.texels, geometry);
  if (optic_depth_ && optic_depth_size_ == layout.texels) return;
  optic_depth_ = make_texture_2d(GL_DEPTH_COMPONENT32F, layout.texels.x, layout.texels.y, 1, false);
  optic_depth_framebuffer_ = make_framebuffer({}, &optic_depth_);
  optic_depth_size_ = layout.texels;
}

void PvrrMap::set_empty(bool geometry) {
  resize(lay_out(std::vector{PvrrMapSize().texels}), geometry);
  const glm::vec4 black(0, 0, 0, 1);
  for (const GlTexture* texture : {&target_->color(), &target_->position(), &target_->detail()})
    if (*texture) glClearTexImage(texture->id(), 0, GL_RGBA, GL_FLOAT, &black.x);
}

void PvrrMap::bind_optic_depth() const {
  glBindFramebuffer(GL_FRAMEBUFFER, optic_depth_framebuffer_.id());
}

void PvrrMap::draw(RasterScene& scene, std::size_t optic, const RasterOptic& surface, std::size_t patch,
                   const optics::VirtualView& view, double texels_per_pixel, glm::dvec2 offset_px,
                   bool geometry, Overlay* overlay, const NestedOptics* nested,
                   std::span<const TexelRect> unseen) {
  const AtlasPlace& place = layout_.places[patch];
  const glm::ivec2 size = place.texels + 2 * place.guard;
  const optics::VirtualView guarded = with_guard(view, place.texels, place.guard);
  RasterPass pass;
  // A map texel is smaller than a pixel, yet what it shows is to be as sharp as the picture, no sharper.
  pass.level_bias = static_cast<float>(std::log2(texels_per_pixel));
  pass.draw_optics = true;
  pass.except = optic;
  views_.resize(layout_.places.size());
  PatchViews& views = views_[patch];
  views.view = map_view(guarded, size, offset_px);
  views.view.corner = place.corner;
  views.zooming.reset();
  if (view.zooms()) {
    RasterView back = zooming_view(guarded, size, offset_px);
    back.corner = place.corner;
    if (scene.sees_anything(back, pass)) views.zooming = back;
  }
  const Regions regions{scene,
                        surface,
                        views,
                        view.beyond_viewpoint,
                        kBeside * view.zooming_far_mm,
                        overlay,
                        nested && !nested->optics.empty() ? nested : nullptr,
                        unseen};
  // What is cleared, and resolved, is the patch's part alone.
  glEnable(GL_SCISSOR_TEST);
  glScissor(place.corner.x, place.corner.y, size.x, size.y);
  const int multisample = available_multisamples(multisample_);
  // Geometry is that of the texels' centres, and drawn on its own.
  pass.geometry = geometry;
  if (multisample == 1 || geometry) draw_regions(regions, pass, *target_);
  if (multisample > 1) {
    pass.geometry = false;
    RasterTarget::fit(smooth_, target_->size(), false, multisample);
    draw_regions(regions, pass, *smooth_);
    smooth_->resolve_into(*target_);
  } else {
    smooth_.reset();
  }
  glDisable(GL_SCISSOR_TEST);
}

/// Nothing is nearer than depth 1.
void PvrrMap::block(std::span<const TexelRect> unseen) {
  if (unseen.empty()) return;
  std::array<GLint, 4> scissor{};
  glGetIntegerv(GL_SCISSOR_BOX, scissor.data());
  const float nearest = 1;
  for (const TexelRect& rect : unseen) {
    glScissor(rect.corner.x, rect.corner.y, rect.size.x, rect.size.y);
    glClearBufferfv(GL_DEPTH, 0, &nearest);
  }
  glScissor(scissor[0], scissor[1], scissor[2], scissor[3]);
}

void PvrrMap::draw_regions(const Regions& regions, RasterPass pass, const RasterTarget& target) const {
  const auto& [scene, surface, views, beyond_viewpoint, beside_mm, overlay, nested, unseen] = regions;
  if (!beyond_viewpoint) {
    bind_optic_depth();
    scene.draw_optic_depth(views.view, surface);
    pass.clip_depth = &optic_depth_;
    // A little farther than the surface is, so that rounding decides nothing.
    const double farthest = surface.farthest_mm(views.view);
    pass.clip_reach_mm = farthest + 1e-3 * std::abs(farthest) + 0.1;
  }
  pass.multisample = target.multisample();
  target.bind(pass.geometry);
  scene.clear(views.view, pass);
  block(unseen);
  if (nested) {
    pass.nested = nested->optics;
    nested->draw(views.view, pass, target);
  }
  scene.draw_all(views.view, pass);
  pass.nested = {};
  if (overlay) {
    target.bind(false);
    overlay->draw_in_scene(views.view, pass.clip_depth);
  }
  if (!views.zooming) return;
  bind_optic_depth();
  scene.draw_zooming_optic_depth(*views.zooming, surface, beside_mm);
  pass.clip_depth = &optic_depth_;
  pass.clip_reach_mm = optics::kInfinity;
  target.bind(pass.geometry);
  scene.draw_bodies(*views.zooming, pass);
  if (!overlay) return;
  target.bind(false);
  overlay->draw_in_scene(*views.zooming, pass.clip_depth);
}

std::vector<RasterView> PvrrMap::views() const {
  std::vector<RasterView> views;
  for (const PatchViews& patch : views_) {
    views.push_back(patch.view);
    if (patch.zooming) views.push_back(*patch.zooming);
  }
  return views;
}

}  // namespace catoptra::render
