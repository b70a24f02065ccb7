#include "render/src/exact_frame.h"

#include <span>

#include "render/src/smooth_pixels.h"

namespace catoptra::render {

ExactFrame::ExactFrame(const Scene& scene, RasterScene& raster, PvrrFrame& pvrr)
    : scene_(scene), raster_(raster), pvrr_(pvrr), mask_(scene, raster) {}

RenderResult ExactFrame::render(const Camera& camera, const FrameOptions& options, RasterPicture& picture,
                                const RayTracer& tracer) {
  RenderResult result;
  double trace_ms = 0, pass1_ms = 0, pass2_ms = 0, verify_ms = 0, readback_ms = 0;
  const glm::ivec2 size(options.width, options.height);
  std::size_t rays = 0;
  std::vector<std::uint8_t> marks;
  std::vector<std::uint32_t> pixels, outline;
  std::vector<std::uint8_t> retraced(std::size_t(size.x) * std::size_t(size.y), 0);
  const double total_ms = gl_time_ms([&] {
    pass2_ms = gl_time_ms([&] {
      picture.begin(options);
      draw_around_optics(raster_, mask_, picture, camera, options);
      marks = mask_.marks();
      pixels = marked_pixels(marks);
      outline = mask_.outline();
      start_traced(options, pixels);
    });
    trace_ms = gl_time_ms([&] {
      FrameOptions without_geometry = options;
      without_geometry.geometry = false;
      without_geometry.multisample = 1;  // colours of maps go with the depths of their texels
      // Where a ray meets another optic the tracer follows it: optics in optics need no maps.
      pvrr_.update(camera, without_geometry, 1);
    });
    pass1_ms = gl_time_ms([&] {
      pvrr_.draw_maps(camera.offset_px, false, nullptr);
      pvrr_.copy_maps(maps_);
    });
    verify_ms = gl_time_ms([&] {
      rays += tracer.trace_mapped(camera, options, pixels, {maps_, marks, retraced, owner_}, traced_);
    });
    readback_ms = gl_time_ms([&] {
      result.frame = picture.read_back();
      take_traced(pixels, result);
      rays += trace_smooth(tracer, camera, options, picture.multisample(), outline, result.frame);
    });
  });
  result.stats = pvrr_.statistics();
  for (const std::uint32_t i : pixels) {
    if (owner_[i] < 0) continue;
    OpticStats& optic = result.stats.optics[std::size_t(owner_[i])];
    ++optic.shown_pixels;
    optic.retraced_pixels += retraced[i];
  }
  result.frame.retraced = std::move(retraced);
  result.stats.rays += rays;
  result.stats.time_ms = {{"trace", trace_ms},   {"pass1", pass1_ms},       {"pass2", pass2_ms},
                          {"verify", verify_ms}, {"readback", readback_ms}, {"total", total_ms}};
  add_shadows(raster_.take_shadow_statistics(), result.stats);
  return result;
}

void ExactFrame::start_traced(const FrameOptions& options, std::span<const std::uint32_t> pixels) {
  allocate(traced_, options);
  owner_.resize(traced_.color.size());
  for (const std::uint32_t i : pixels) {
    traced_.color[i] = {0, 0, 0, 1};
    owner_[i] = -1;
  }
}

void ExactFrame::take_traced(std::span<const std::uint32_t> pixels, RenderResult& result) {
  Frame& frame = result.frame;
  for (const std::uint32_t i : pixels) frame.color[i] = traced_.color[i];
  if (frame.optic_id.empty()) return;
  for (const std::uint32_t i : pixels) {
    frame.position[i] = traced_.position[i];
    frame.surface[i] = traced_.surface[i];
    frame.direction[i] = traced_.direction[i];
    frame.optic_id[i] = traced_.optic_id[i];
    frame.bounces[i] = traced_.bounces[i];
    frame.path[i] = traced_.path[i];
  }
}

}  // namespace catoptra::render
