#include "render/src/raster_shadow_target.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>
#include <string>

#include "cad_import/error.h"

namespace catoptra::render {
namespace {

GlTexture make_layers(glm::ivec2 size, int layers, int multisample) {
  GLuint id = 0;
  if (multisample > 1) {
    glCreateTextures(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, 1, &id);
    GlTexture texture(id);
    glTextureStorage3DMultisample(id, multisample, GL_RGBA8, size.x, size.y, layers, GL_TRUE);
    return texture;
  }
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
  GlTexture texture(id);
  glTextureStorage3D(id, 1, GL_RGBA8, size.x, size.y, layers);
  for (const GLenum filter : {GL_TEXTURE_MAG_FILTER, GL_TEXTURE_MIN_FILTER})
    glTextureParameteri(id, filter, GL_NEAREST);
  return texture;
}

}  // namespace

void RasterShadowTarget::fit(glm::ivec2 size, int multisample, int bits) {
  const int layers = std::max(1, (bits + 31) / 32);
  if (multisample == multisample_ && layers <= layers_ && glm::all(glm::lessThanEqual(size, size_))) return;
  size_ = multisample == multisample_ ? glm::max(size, size_) : size;
  layers_ = layers;
  multisample_ = multisample;
  bits_ = make_layers(size_, layers_, multisample);
  depth_ = multisample > 1 ? make_texture_multisample(GL_DEPTH32F_STENCIL8, size_.x, size_.y, multisample)
                           : make_texture_2d(GL_DEPTH32F_STENCIL8, size_.x, size_.y, 1, false);
  framebuffers_.clear();
  for (int layer = 0; layer < layers_; ++layer) {
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    framebuffers_.emplace_back(id);
    glNamedFramebufferTextureLayer(id, GL_COLOR_ATTACHMENT0, bits_.id(), 0, layer);
    glNamedFramebufferTexture(id, GL_DEPTH_STENCIL_ATTACHMENT, depth_.id(), 0);
    const GLenum status = glCheckNamedFramebufferStatus(id, GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
      throw Error({}, "OpenGL",
                  "the driver refuses a framebuffer for shadows (status " + std::to_string(status) + ")",
                  "the picture may be too large for the graphics memory");
  }
}

void RasterShadowTarget::clear(int lit_bits) const {
  for (int layer = layers_ - 1; layer >= 0; --layer) {
    glm::vec4 lit;
    for (int byte = 0; byte < 4; ++byte)
      lit[byte] = float((1 << std::clamp(lit_bits - 32 * layer - 8 * byte, 0, 8)) - 1) / 255;
    bind(layer);
    glClearBufferfv(GL_COLOR, 0, &lit.x);
  }
  glClearBufferfi(GL_DEPTH_STENCIL, 0, 0, 0);
}

void RasterShadowTarget::bind(int layer) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[std::size_t(layer)].id());
}

}  // namespace catoptra::render
