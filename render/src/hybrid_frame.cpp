#include "render/src/hybrid_frame.h"

#include <algorithm>

#include "render/src/sampling.h"

namespace catoptra::render {
namespace {

/// Indices of the marked pixels and of those beside them: rasteriser and ray tracer round differently, so
/// that on the outline one may see the optic where the other does not. The ray tracer knows what to do with
/// both.
std::vector<std::uint32_t> with_neighbours(const std::vector<std::uint8_t>& mask, int width, int height) {
  std::vector<std::uint32_t> pixels;
  std::vector<std::uint8_t> rows(
      static_cast<std::size_t>(width));  // marked in this row or the ones beside it
  for (int y = 0; y < height; ++y) {
    std::fill(rows.begin(), rows.end(), std::uint8_t(0));
    for (int row = std::max(0, y - 1); row <= std::min(height - 1, y + 1); ++row)
      for (int x = 0; x < width; ++x) rows[x] |= mask[static_cast<std::size_t>(row) * width + x];
    for (int x = 0; x < width; ++x)
      if (rows[x] | rows[std::max(0, x - 1)] | rows[std::min(width - 1, x + 1)])
        pixels.push_back(static_cast<std::uint32_t>(y * width + x));
  }
  return pixels;
}

}  // namespace

HybridFrame::HybridFrame(const Scene& scene, RasterScene& raster)
    : scene_(scene),
      raster_(raster),
      mask_program_(
          make_program({"raster_view.glsl", "raster_surface.vert.glsl"}, {"raster_mask.frag.glsl"})) {}

RenderResult HybridFrame::render(const Camera& camera, const FrameOptions& options, RasterPicture& picture,
                                 const RayTracer& tracer) {
  RenderResult result;
  double raster_ms = 0, readback_ms = 0, trace_ms = 0;
  const glm::ivec2 size(options.width, options.height);
  const double total_ms = gl_time_ms([&] {
    raster_ms = gl_time_ms([&] {
      picture.begin(options);
      begin_mask(picture.target());
      for (int sample = 0; sample < options.samples; ++sample) {
        RasterPass pass;
        pass.geometry = options.geometry && sample == 0;
        const RasterView view = camera_view(camera, size, sample_offset(sample, options.samples));
        picture.target().bind(pass.geometry);
        raster_.draw(view, pass);
        draw_mask(view);
        picture.add_sample();
      }
    });
    std::vector<std::uint32_t> pixels;
    readback_ms = gl_time_ms([&] {
      result.frame = picture.read_back();
      pixels = masked_pixels();
    });
    trace_ms =
        gl_time_ms([&] { result.stats.rays = tracer.trace_pixels(camera, options, pixels, result.frame); });
  });
  result.stats.time_ms = {
      {"raster", raster_ms}, {"readback", readback_ms}, {"trace", trace_ms}, {"total", total_ms}};
  for (const optics::Optic& optic : scene_.optics)
    result.stats.optics.push_back(
        {optic.name,
         optic.kind == optics::OpticKind::mirror ? "mirror" : "lens",
         optic.mesh.vertices.size(),
         // Rays are traced by pixel and may meet several optics; a single one gets them all.
         scene_.optics.size() == 1 ? result.stats.rays : 0,
         0,
         {}});
  return result;
}

void HybridFrame::begin_mask(const RasterTarget& target) {
  if (mask_size_ != target.size()) {
    mask_ = make_texture_2d(GL_R8, target.size().x, target.size().y, 1, false);
    mask_size_ = target.size();
  }
  // The depth texture may be another one than in the last frame.
  mask_framebuffer_ = make_framebuffer({&mask_}, &target.depth());
  const glm::vec4 nothing(0);
  glClearNamedFramebufferfv(mask_framebuffer_.id(), GL_COLOR, 0, &nothing.x);
}

void HybridFrame::draw_mask(const RasterView& view) {
  glBindFramebuffer(GL_FRAMEBUFFER, mask_framebuffer_.id());
  glUseProgram(mask_program_.id());
  for (std::size_t i = 0; i < scene_.optics.size(); ++i) {
    const optics::Optic& optic = scene_.optics[i];
    const RasterOptic& seen =
        optic.kind == optics::OpticKind::mirror
            ? raster_.optic(i)
            : raster_.side(
                  i, optics::side_towards(optic, raster_.optic(i).placement().own_point(view.origin_mm)));
    RasterScene::set_mesh_origin(view, seen);
    seen.draw_surface();
  }
}

std::vector<std::uint32_t> HybridFrame::masked_pixels() const {
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(mask_size_.x) *
                                 static_cast<std::size_t>(mask_size_.y));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(mask_.id(), 0, GL_RED, GL_UNSIGNED_BYTE, static_cast<GLsizei>(mask.size()), mask.data());
  return with_neighbours(mask, mask_size_.x, mask_size_.y);
}

}  // namespace catoptra::render
