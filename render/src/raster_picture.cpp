#include "render/src/raster_picture.h"

#include <glm/geometric.hpp>

namespace catoptra::render {
namespace {

constexpr GLint kWeight = 2;  // as in raster_accumulate.frag.glsl

/// The optics of a way as passed_detail() of raster_shown.glsl numbers it, the first one first.
void set_path(Frame& frame, std::size_t pixel, std::uint32_t way, std::uint32_t base) {
  frame.optic_id[pixel] = static_cast<std::int32_t>(way % base) - 1;
  for (; way > 0; way /= base) {
    const auto optic = static_cast<std::int32_t>(way % base) - 1;
    frame.path[pixel] = path_after(frame.path[pixel], optic);
    ++frame.bounces[pixel];
  }
}

}  // namespace

RasterPicture::RasterPicture(std::size_t optic_count)
    : optic_count_(optic_count),
      nothing_(make_vertex_array({})),
      accumulate_(make_program({"raster_accumulate.vert.glsl"}, {"raster_accumulate.frag.glsl"})) {}

void RasterPicture::begin(const FrameOptions& options) {
  options_ = options;
  const glm::ivec2 size(options.width, options.height);
  RasterTarget::fit(target_, size, options.geometry);
  if (options.samples <= 1) return;
  if (sum_size_ != size) {
    sum_ = make_texture_2d(GL_RGBA32F, size.x, size.y, 1, false);
    sum_framebuffer_ = make_framebuffer({&sum_}, nullptr);
    sum_size_ = size;
  }
  const glm::vec4 zero(0);
  glClearNamedFramebufferfv(sum_framebuffer_.id(), GL_COLOR, 0, &zero.x);
}

void RasterPicture::add_sample() {
  if (options_.samples <= 1) return;
  glBindFramebuffer(GL_FRAMEBUFFER, sum_framebuffer_.id());
  glViewport(0, 0, sum_size_.x, sum_size_.y);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glUseProgram(accumulate_.id());
  glUniform1f(kWeight, 1.0f / float(options_.samples));
  glBindTextureUnit(0, target_->color().id());
  glBindVertexArray(nothing_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
}

Frame RasterPicture::read_color() const {
  Frame frame;
  frame.width = options_.width;
  frame.height = options_.height;
  frame.color = read_texture(options_.samples > 1 ? sum_ : target_->color(), target_->size());
  for (glm::vec4& pixel : frame.color) pixel.w = 1;
  return frame;
}

Frame RasterPicture::read_back() const {
  Frame frame = read_color();
  if (options_.geometry) read_geometry(frame);
  return frame;
}

void RasterPicture::read_geometry(Frame& frame) const {
  frame.position = read_texture(target_->position(), target_->size());
  const std::vector<glm::vec4> detail = read_texture(target_->detail(), target_->size());
  frame.surface.assign(detail.size(), glm::vec3(0));
  frame.direction.assign(detail.size(), glm::vec3(0));
  frame.optic_id.assign(detail.size(), -1);
  frame.bounces.assign(detail.size(), 0);
  frame.path.assign(detail.size(), 0);
  for (std::size_t i = 0; i < detail.size(); ++i) {
    if (detail[i].w < 0.5f) continue;
    set_path(frame, i, static_cast<std::uint32_t>(detail[i].w + 0.5f),
             static_cast<std::uint32_t>(optic_count_ + 1));
    frame.surface[i] = glm::vec3(detail[i]);
    const glm::vec3 shown(frame.position[i]);
    const glm::vec3 direction = frame.position[i].w == 0 ? shown : shown - frame.surface[i];
    const float length = glm::length(direction);
    if (length > 0) frame.direction[i] = direction / length;
  }
}

}  // namespace catoptra::render
