#include "render/src/optic_mask.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "optics/planar_glass.h"

namespace catoptra::render {
namespace {

/// Whether the eye, in the optic's frame, is behind glass that works from one side alone.
bool is_absent(const optics::Optic& optic, const glm::dvec3& own_eye_mm) {
  if (!optics::is_planar_glass(optic) || !optic.one_sided) return false;
  const optics::PlanarFace face = optics::planar_face(optic);
  return glm::dot(own_eye_mm - face.centre_mm, face.normal) <= 0;
}

/// `mask` is 255 where an optic covers the pixel, 0 where none does, and between where it does in part.
std::vector<std::uint8_t> with_edges(const std::vector<std::uint8_t>& mask, int width, int height) {
  const auto wide = static_cast<std::size_t>(width);
  std::vector<std::uint8_t> marks(mask.size());
  std::vector<std::uint8_t> any(wide), all(wide);  // of this row and the ones beside it
  for (int y = 0; y < height; ++y) {
    std::fill(any.begin(), any.end(), std::uint8_t(0));
    std::fill(all.begin(), all.end(), std::uint8_t(255));
    for (int row = std::max(0, y - 1); row <= std::min(height - 1, y + 1); ++row) {
      const std::uint8_t* of_row = &mask[static_cast<std::size_t>(row) * wide];
      for (std::size_t x = 0; x < wide; ++x) {
        any[x] |= of_row[x];
        all[x] &= of_row[x];
      }
    }
    std::uint8_t* out = &marks[static_cast<std::size_t>(y) * wide];
    for (std::size_t x = 0; x < wide; ++x) {
      const std::size_t before = x > 0 ? x - 1 : x, after = x + 1 < wide ? x + 1 : x;
      const bool some = (any[before] | any[x] | any[after]) != 0,
                 every = (all[before] & all[x] & all[after]) == 255;
      out[x] = every ? kOpticPixel : some ? kOpticEdge : std::uint8_t(0);
    }
  }
  return marks;
}

}  // namespace

std::vector<std::uint32_t> marked_pixels(const std::vector<std::uint8_t>& marks) {
  std::vector<std::uint32_t> pixels;
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (marks[i] != 0) pixels.push_back(static_cast<std::uint32_t>(i));
  return pixels;
}

OpticMask::OpticMask(const Scene& scene, const RasterScene& raster)
    : scene_(scene),
      raster_(raster),
      program_(make_program({"raster_view.glsl", "raster_surface.vert.glsl"}, {"raster_mask.frag.glsl"})) {}

void OpticMask::begin(glm::ivec2 size, const GlTexture* depth, int multisample) {
  if (size_ != size) mask_ = make_texture_2d(GL_R8, size.x, size.y, 1, false);
  if (multisample > 1 && (size_ != size || multisample_ != multisample || !smooth_))
    smooth_ = make_texture_multisample(GL_R8, size.x, size.y, multisample);
  size_ = size;
  multisample_ = multisample;
  // The depth texture may be another one than in the last frame.
  framebuffer_ = make_framebuffer({&mask_}, multisample > 1 ? nullptr : depth);
  if (multisample > 1) smooth_framebuffer_ = make_framebuffer({&smooth_}, depth);
  const glm::vec4 nothing(0);
  for (const GlFramebuffer* framebuffer : {&framebuffer_, &smooth_framebuffer_})
    if (*framebuffer) glClearNamedFramebufferfv(framebuffer->id(), GL_COLOR, 0, &nothing.x);
}

void OpticMask::hide(const RasterView& view) const {
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw_surfaces(view);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void OpticMask::draw(const RasterView& view) const {
  glBindFramebuffer(GL_FRAMEBUFFER, multisample_ > 1 ? smooth_framebuffer_.id() : framebuffer_.id());
  // Where the same program has left their own depth, that is not nearer.
  glDepthFunc(GL_GEQUAL);
  draw_surfaces(view);
  glDepthFunc(GL_GREATER);
}

void OpticMask::draw_surfaces(const RasterView& view) const {
  glUseProgram(program_.id());
  for (std::size_t i = 0; i < scene_.optics.size(); ++i) {
    const optics::Optic& optic = scene_.optics[i];
    if (is_absent(optic, raster_.optic(i).placement().own_point(view.origin_mm))) continue;
    const RasterOptic& seen =
        optic.kind == optics::OpticKind::lens
            ? raster_.side(
                  i, optics::side_towards(optic, raster_.optic(i).placement().own_point(view.origin_mm)))
            : raster_.optic(i);
    RasterScene::set_mesh_origin(view, seen);
    seen.draw_surface();
  }
}

std::vector<std::uint8_t> OpticMask::read() const {
  if (multisample_ > 1)
    glBlitNamedFramebuffer(smooth_framebuffer_.id(), framebuffer_.id(), 0, 0, size_.x, size_.y, 0, 0, size_.x,
                           size_.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(mask_.id(), 0, GL_RED, GL_UNSIGNED_BYTE, static_cast<GLsizei>(mask.size()), mask.data());
  return mask;
}

std::vector<std::uint8_t> OpticMask::marks() const {
  return with_edges(read(), size_.x, size_.y);
}

std::vector<std::uint32_t> OpticMask::outline() const {
  if (multisample_ == 1) return {};
  const std::vector<std::uint8_t> covered = read();
  std::vector<std::uint32_t> pixels = marked_pixels(with_edges(covered, size_.x, size_.y));
  std::erase_if(pixels, [&](std::uint32_t pixel) { return covered[pixel] == 255; });
  return pixels;
}

void draw_around_optics(RasterScene& raster, OpticMask& mask, RasterPicture& picture, const Camera& camera,
                        const FrameOptions& options) {
  const glm::ivec2 size(options.width, options.height);
  const RasterView view = camera_view(camera, size, camera.offset_px);
  for (const auto& [target, geometry] : picture.passes(options.geometry)) {
    RasterPass pass;
    pass.geometry = geometry;
    pass.multisample = target->multisample();
    target->bind(geometry);
    raster.clear(view, pass);
    mask.hide(view);
    raster.draw_all(view, pass);
    mask.begin(size, &target->depth(), target->multisample());
    mask.draw(view);
  }
  picture.add_sample();
}

}  // namespace catoptra::render
