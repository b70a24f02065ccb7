#include "render/src/hybrid_frame.h"

#include "render/src/smooth_pixels.h"

namespace catoptra::render {
HybridFrame::HybridFrame(const Scene& scene, RasterScene& raster)
    : scene_(scene), raster_(raster), mask_(scene, raster) {}

RenderResult HybridFrame::render(const Camera& camera, const FrameOptions& options, RasterPicture& picture,
                                 const RayTracer& tracer) {
  RenderResult result;
  double raster_ms = 0, readback_ms = 0, trace_ms = 0;
  const double total_ms = gl_time_ms([&] {
    raster_ms = gl_time_ms([&] {
      picture.begin(options);
      draw_around_optics(raster_, mask_, picture, camera, options);
    });
    std::vector<std::uint32_t> pixels, outline;
    readback_ms = gl_time_ms([&] {
      result.frame = picture.read_back();
      pixels = marked_pixels(mask_.marks());
      outline = mask_.outline();
    });
    trace_ms = gl_time_ms([&] {
      result.stats.rays = tracer.trace_pixels(camera, options, pixels, result.frame);
      result.stats.rays +=
          trace_smooth(tracer, camera, options, picture.multisample(), outline, result.frame);
    });
  });
  result.stats.time_ms = {
      {"raster", raster_ms}, {"readback", readback_ms}, {"trace", trace_ms}, {"total", total_ms}};
  add_shadows(raster_.take_shadow_statistics(), result.stats);
  for (const optics::Optic& optic : scene_.optics)
    result.stats.optics.push_back(
        {optic.name,
         optics::kind_name(optic.kind),
         optic.mesh.vertices.size(),
         // Rays are traced by pixel and may meet several optics; a single one gets them all.
         scene_.optics.size() == 1 ? result.stats.rays : 0,
         0,
         {}});
  return result;
}

}  // namespace catoptra::render
