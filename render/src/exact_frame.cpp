#include "render/src/exact_frame.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "render/src/sampling.h"
#include "render/src/threads.h"

namespace catoptra::render {

/// What is known of one picture so far.
struct ExactFrame::Verification {
  const Camera& camera;
  const FrameOptions& options;
  const RasterPicture& picture;
  const RayTracer& tracer;
  std::vector<std::uint8_t> wrong;  ///< per pixel: a sample was found wrong
  std::vector<std::int32_t> owner;  ///< per pixel: an optic that shows in it; -1: none
  Frame geometry;                   ///< of sample 0, where the options ask for it
  std::size_t rays = 0;
  double ms = 0;
};

namespace {

/// Verified pixels have the exact ray; what they show is what was drawn.
Frame with_exact_rays(Frame geometry, const ExactPixels& exact) {
  for (std::size_t i = 0; i < geometry.optic_id.size(); ++i) {
    if (exact.frame.optic_id[i] < 0 || exact.frame.optic_id[i] != geometry.optic_id[i]) continue;
    geometry.surface[i] = exact.frame.surface[i];
    geometry.direction[i] = exact.frame.direction[i];
  }
  return geometry;
}

std::vector<std::uint32_t> marked_pixels(const std::vector<std::uint8_t>& marked) {
  std::vector<std::uint32_t> pixels;
  for (std::size_t i = 0; i < marked.size(); ++i)
    if (marked[i]) pixels.push_back(std::uint32_t(i));
  return pixels;
}

}  // namespace

ExactFrame::ExactFrame(const Scene& scene, const RasterScene& raster, PvrrFrame& pvrr)
    : scene_(scene), pvrr_(pvrr), mask_(scene, raster) {}

RenderResult ExactFrame::render(const Camera& camera, const FrameOptions& options, RasterPicture& picture,
                                const RayTracer& tracer) {
  FrameOptions drawn = options;
  drawn.geometry = false;
  drawn.read_back = true;
  drawn.overlay_vertices = drawn.overlay_rays = false;
  const std::size_t count = std::size_t(options.width) * std::size_t(options.height);
  Verification v{camera, options, picture, tracer, {}, {}, {}, 0, 0};
  v.wrong.assign(count, 0);
  v.owner.assign(count, -1);
  RenderResult result;
  double retrace_ms = 0;
  const double total_ms = gl_time_ms([&] {
    result = pvrr_.render(camera, drawn, picture, [&](int sample, const RasterView& view) {
      v.ms += gl_time_ms([&] { verify_sample(v, sample, view); });
    });
    retrace_ms = gl_time_ms([&] {
      Frame& frame = result.frame;
      frame.position = std::move(v.geometry.position);
      frame.surface = std::move(v.geometry.surface);
      frame.direction = std::move(v.geometry.direction);
      frame.optic_id = std::move(v.geometry.optic_id);
      frame.bounces = std::move(v.geometry.bounces);
      frame.path = std::move(v.geometry.path);
      v.rays += tracer.trace_pixels(camera, options, marked_pixels(v.wrong), frame);
    });
  });
  for (std::size_t i = 0; i < count; ++i) {
    if (v.owner[i] < 0) continue;
    OpticStats& optic = result.stats.optics[std::size_t(v.owner[i])];
    ++optic.shown_pixels;
    optic.retraced_pixels += v.wrong[i];
  }
  result.frame.retraced = std::move(v.wrong);
  result.stats.rays += v.rays;
  result.stats.time_ms["verify"] = v.ms;
  result.stats.time_ms["retrace"] = retrace_ms;
  result.stats.time_ms["total"] = total_ms;
  result.warnings.clear();  // of pixels that maps do not reach, which have been traced
  return result;
}

void ExactFrame::verify_sample(Verification& v, int sample, const RasterView& view) {
  const FrameOptions& options = v.options;
  const glm::dvec2 offset = sample_offset(sample, options.samples);
  // Hidden optics too: the ray tracer knows what hides them, and would be asked about outlines anyway.
  mask_.begin(view.size, nullptr);
  mask_.draw(view);
  const std::vector<std::uint32_t> pixels = mask_.pixels();
  for (std::size_t extreme = 0;
       extreme == 0 || pvrr_.draw_extreme_geometry(v.picture.target(), view, offset, extreme); ++extreme) {
    v.picture.read_geometry(shown_);
    exact_.reset(options.width, options.height);
    v.rays += v.tracer.trace_exact(v.camera, options, offset, extreme, pixels, exact_);
    compare_pixels(v, pixels);
    if (extreme == 0 && sample == 0 && options.geometry) v.geometry = with_exact_rays(shown_, exact_);
  }
}

void ExactFrame::compare_pixels(Verification& v, std::span<const std::uint32_t> pixels) {
  with_threads(v.options.threads, [&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), 1024), [&](const auto& range) {
      for (std::size_t k = range.begin(); k != range.end(); ++k) {
        const std::size_t i = pixels[k];
        if (!agrees(exact_, shown_, i)) v.wrong[i] = 1;
        const std::int32_t id = exact_.frame.optic_id[i] >= 0 ? exact_.frame.optic_id[i] : shown_.optic_id[i];
        if (id >= 0) v.owner[i] = id;
      }
    });
  });
}

}  // namespace catoptra::render
