#include "render/src/exact_frame.h"

#include "render/src/smooth_pixels.h"

namespace catoptra::render {

ExactFrame::ExactFrame(const Scene& scene, RasterScene& raster, PvrrFrame& pvrr)
    : scene_(scene), raster_(raster), pvrr_(pvrr), mask_(scene, raster) {}

RenderResult ExactFrame::render(const Camera& camera, const FrameOptions& options, RasterPicture& picture,
                                const RayTracer& tracer) {
  RenderResult result;
  double trace_ms = 0, pass1_ms = 0, pass2_ms = 0, verify_ms = 0, readback_ms = 0;
  std::size_t rays = 0;
  std::vector<std::uint8_t> marks;
  std::vector<std::uint32_t> pixels, outline;
  std::vector<std::uint8_t> retraced(std::size_t(options.width) * std::size_t(options.height), 0);
  const double total_ms = gl_time_ms([&] {
    pass2_ms = gl_time_ms([&] {
      picture.begin(options);
      draw_around_optics(raster_, mask_, picture, camera, options);
      marks = mask_.marks();
      pixels = marked_pixels(marks);
      outline = mask_.outline();
    });
    readback_ms = gl_time_ms([&] { result.frame = picture.read_back(); });
    trace_ms = gl_time_ms([&] {
      FrameOptions without_geometry = options;
      without_geometry.geometry = false;
      without_geometry.multisample = 1;  // colours of maps go with the depths of their texels
      // Where a ray meets another optic the tracer follows it: optics in optics need no maps.
      pvrr_.update(camera, without_geometry, 1, MapUse::exact_rays);
    });
    pass1_ms = gl_time_ms([&] {
      pvrr_.draw_maps(camera.offset_px, false, nullptr);
      pvrr_.copy_maps(maps_);
    });
    verify_ms = gl_time_ms([&] {
      owner_.resize(retraced.size());
      rays += tracer.trace_mapped(camera, options, pixels, {maps_, marks, retraced, owner_}, result.frame);
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

}  // namespace catoptra::render
