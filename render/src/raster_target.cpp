#include "render/src/raster_target.h"

#include <string>

#include "cad_import/error.h"

namespace catoptra::render {
namespace {

void check_size(glm::ivec2 size) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (size.x >= 1 && size.y >= 1 && size.x <= largest && size.y <= largest) return;
  throw Error({}, "resolution", std::to_string(size.x) + " x " + std::to_string(size.y) + " cannot be drawn",
              "the driver allows 1 to " + std::to_string(largest) + " pixels a side");
}

}  // namespace

RasterTarget::RasterTarget(glm::ivec2 size, bool geometry, int multisample)
    : size_(size), multisample_(multisample) {
  check_size(size);
  if (multisample > 1) {
    color_ = make_texture_multisample(GL_RGBA16F, size.x, size.y, multisample);
    depth_ = make_texture_multisample(GL_DEPTH_COMPONENT32F, size.x, size.y, multisample);
    color_only_ = make_framebuffer({&color_}, &depth_);
    return;
  }
  color_ = make_texture_2d(GL_RGBA16F, size.x, size.y, 1, true);
  depth_ = make_texture_2d(GL_DEPTH_COMPONENT32F, size.x, size.y, 1, false);
  color_only_ = make_framebuffer({&color_}, &depth_);
  if (!geometry) return;
  position_ = make_texture_2d(GL_RGBA32F, size.x, size.y, 1, false);
  detail_ = make_texture_2d(GL_RGBA32F, size.x, size.y, 1, false);
  with_geometry_ = make_framebuffer({&color_, &position_, &detail_}, &depth_);
}

void RasterTarget::fit(std::unique_ptr<RasterTarget>& target, glm::ivec2 size, bool geometry,
                       int multisample) {
  if (!target || target->size_ != size || target->multisample_ != multisample ||
      (geometry && !target->position_))
    target = std::make_unique<RasterTarget>(size, geometry, multisample);
}

void RasterTarget::bind(bool geometry) const {
  glBindFramebuffer(GL_FRAMEBUFFER, geometry ? with_geometry_.id() : color_only_.id());
}

void RasterTarget::resolve_into(const RasterTarget& target, bool depth) const {
  glBlitNamedFramebuffer(color_only_.id(), target.color_only_.id(), 0, 0, size_.x, size_.y, 0, 0, size_.x,
                         size_.y, GL_COLOR_BUFFER_BIT | (depth ? GL_DEPTH_BUFFER_BIT : 0u), GL_NEAREST);
}

std::vector<glm::vec4> read_texture(const GlTexture& texture, glm::ivec2 size) {
  std::vector<glm::vec4> pixels(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  glGetTextureImage(texture.id(), 0, GL_RGBA, GL_FLOAT,
                    static_cast<GLsizei>(pixels.size() * sizeof(glm::vec4)), pixels.data());
  return pixels;
}

}  // namespace catoptra::render
