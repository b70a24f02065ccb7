#include "render/src/raster_picture.h"

#include <glm/geometric.hpp>

namespace catoptra::render {
namespace {

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

void RasterPicture::start_sum() {
  summing_ = true;
  summed_ = 0;
}

void RasterPicture::begin(const FrameOptions& options) {
  options_ = options;
  const glm::ivec2 size(options.width, options.height);
  RasterTarget::fit(target_, size, options.geometry);
  const int multisample = available_multisamples(options.multisample);
  if (multisample > 1)
    RasterTarget::fit(smooth_, size, false, multisample);
  else
    smooth_.reset();
  if (!summing_ || summed_ > 0) return;
  if (sum_size_ != size) {
    sum_ = make_texture_2d(GL_RGBA32F, size.x, size.y, 1, false);
    sum_framebuffer_ = make_framebuffer({&sum_}, nullptr);
    sum_size_ = size;
  }
  const glm::vec4 zero(0);
  glClearNamedFramebufferfv(sum_framebuffer_.id(), GL_COLOR, 0, &zero.x);
}

std::vector<RasterPicture::Pass> RasterPicture::passes(bool geometry) const {
  if (!smooth_) return {{target_.get(), geometry}};
  if (!geometry) return {{smooth_.get(), false}};
  return {{target_.get(), true}, {smooth_.get(), false}};
}

void RasterPicture::add_sample() {
  if (smooth_) smooth_->resolve_into(*target_);
  if (!summing_) return;
  ++summed_;
  glBindFramebuffer(GL_FRAMEBUFFER, sum_framebuffer_.id());
  glViewport(0, 0, sum_size_.x, sum_size_.y);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glUseProgram(accumulate_.id());
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
  frame.color = read_texture(summing_ ? sum_ : target_->color(), target_->size());
  const float share = summing_ ? 1 / float(summed_) : 1;
  for (glm::vec4& pixel : frame.color) pixel = glm::vec4(share * glm::vec3(pixel), 1);
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
