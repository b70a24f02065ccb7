#include "render/src/ray_tracer.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>

#include "render/src/ray_tracer_packet.h"
#include "render/src/threads.h"

namespace catoptra::render {
namespace {

constexpr int kTile = 4;  // pixels a side: one packet

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The pixels of tile (tile_x, tile_y), row by row; lanes outside the picture are inactive.
PixelPacket tile_pixels(int tile_x, int tile_y, int width, int height) {
  PixelPacket pixels;
  for (int i = 0; i < PixelPacket::kLanes; ++i) {
    pixels.column[i] = tile_x * kTile + i % kTile;
    pixels.row[i] = tile_y * kTile + i / kTile;
    pixels.active[i] = pixels.column[i] < width && pixels.row[i] < height;
  }
  return pixels;
}

/// Pixel numbers in the order of the tiles that hold them, so that 16 in a row make a coherent packet.
std::vector<std::uint32_t> by_tiles(std::span<const std::uint32_t> pixels, int width, int height) {
  const std::size_t across = std::size_t(width + kTile - 1) / kTile,
                    down = std::size_t(height + kTile - 1) / kTile;
  const auto tile_of = [&](std::uint32_t pixel) {
    return std::size_t(pixel) / std::size_t(width) / kTile * across +
           std::size_t(pixel) % std::size_t(width) / kTile;
  };
  std::vector<std::uint32_t> next(across * down + 1, 0), sorted(pixels.size());
  for (const std::uint32_t pixel : pixels) ++next[tile_of(pixel) + 1];
  for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
  for (const std::uint32_t pixel : pixels) sorted[next[tile_of(pixel)]++] = pixel;
  return sorted;
}

/// Calls `trace` (packet of pixels -> number of rays) for all pixels listed, on the options' threads; adds up
/// the rays.
template <typename Trace>
std::size_t for_packets(const FrameOptions& options, std::span<const std::uint32_t> pixels,
                        const Trace& trace) {
  const std::vector<std::uint32_t> sorted = by_tiles(pixels, options.width, options.height);
  constexpr std::size_t lanes = PixelPacket::kLanes;
  const std::size_t packet_count = (sorted.size() + lanes - 1) / lanes;
  std::atomic<std::size_t> count{0};
  with_threads(options.threads, [&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, packet_count, 64), [&](const auto& range) {
      std::size_t traced = 0;
      for (std::size_t p = range.begin(); p != range.end(); ++p) {
        PixelPacket packet;
        for (std::size_t i = 0; i < lanes; ++i) {
          const std::size_t k = p * lanes + i;
          packet.active[i] = k < sorted.size();
          const int pixel = int(sorted[std::min(k, sorted.size() - 1)]);
          packet.column[i] = pixel % options.width;
          packet.row[i] = pixel / options.width;
        }
        traced += trace(packet);
      }
      count += traced;
    });
  });
  return count;
}

/// The layers that other modes may lack, which know of one optic along a path.
void add_paths(Frame& frame) {
  if (!frame.path.empty()) return;
  frame.bounces.resize(frame.optic_id.size());
  frame.path.resize(frame.optic_id.size());
  for (std::size_t i = 0; i < frame.optic_id.size(); ++i) {
    if (frame.optic_id[i] < 0) continue;
    frame.bounces[i] = 1;
    frame.path[i] = path_after(0, frame.optic_id[i]);
  }
}

}  // namespace

const tessellate::OpticArrays& mesh_for_rays(const optics::Optic& optic) {
  static const tessellate::OpticArrays none;
  return optic.kind == optics::OpticKind::lens ? none : optic.mesh;
}

std::uint32_t mask_for_rays(const optics::Optic& optic) {
  return optic.kind == optics::OpticKind::mirror ? optics::kOptics | optics::kCasters : optics::kCasters;
}

void allocate(Frame& frame, const FrameOptions& options) {
  frame.width = options.width;
  frame.height = options.height;
  const std::size_t count = std::size_t(options.width) * std::size_t(options.height);
  frame.color.resize(count);
  if (!options.geometry) return;
  frame.position.resize(count);
  frame.surface.resize(count);
  frame.direction.resize(count);
  frame.optic_id.resize(count);
  frame.bounces.resize(count);
  frame.path.resize(count);
}

struct RayTracer::Impl {
  PacketTracer packets;

  /// Traces tiles of rows [first, last) of tiles; adds up the rays.
  std::size_t trace_tile_rows(const PacketView& view, const FrameOptions& options, int first, int last,
                              Frame& frame) const {
    const int across = (options.width + kTile - 1) / kTile;
    std::size_t rays = 0;
    for (int y = first; y < last; ++y)
      for (int x = 0; x < across; ++x)
        rays += packets.trace(view, options, tile_pixels(x, y, options.width, options.height), frame);
    return rays;
  }
};

RayTracer::RayTracer(const Scene& scene, const SceneTextures& textures, const optics::RayScene& rays)
    : impl_(new Impl{PacketTracer(scene, textures, rays)}) {}
RayTracer::~RayTracer() = default;

void RayTracer::optic_changed(std::size_t index) {
  impl_->packets.optic_changed(index);
}

RenderResult RayTracer::render(const Camera& camera, const FrameOptions& options) const {
  const auto start = Clock::now();
  RenderResult result;
  allocate(result.frame, options);
  const PacketView view = impl_->packets.view(camera_rays(camera, options.width, options.height));
  const int rows = (options.height + kTile - 1) / kTile;
  std::atomic<std::size_t> count{0};
  with_threads(options.threads, [&] {
    tbb::parallel_for(tbb::blocked_range<int>(0, rows), [&](const tbb::blocked_range<int>& range) {
      count += impl_->trace_tile_rows(view, options, range.begin(), range.end(), result.frame);
    });
  });
  result.stats.rays = count;
  result.stats.time_ms["trace"] = result.stats.time_ms["total"] = ms_since(start);
  return result;
}

std::size_t RayTracer::trace_pixels(const Camera& camera, const FrameOptions& options,
                                    std::span<const std::uint32_t> pixels, Frame& frame) const {
  if (options.geometry) add_paths(frame);
  const PacketView view = impl_->packets.view(camera_rays(camera, options.width, options.height));
  return for_packets(options, pixels, [&](const PixelPacket& packet) {
    return impl_->packets.trace(view, options, packet, frame);
  });
}

std::size_t RayTracer::trace_mapped(const Camera& camera, const FrameOptions& options,
                                    std::span<const std::uint32_t> pixels, const MappedSample& mapped,
                                    Frame& frame) const {
  const PacketView view = impl_->packets.view(camera_rays(camera, options.width, options.height));
  return for_packets(options, pixels, [&](const PixelPacket& packet) {
    return impl_->packets.trace_mapped(view, options, packet, mapped, frame);
  });
}

double RayTracer::bare_packet_ms(const Camera& camera, const FrameOptions& options) const {
  const PacketView view = impl_->packets.view(camera_rays(camera, options.width, options.height));
  const int across = (options.width + kTile - 1) / kTile, rows = (options.height + kTile - 1) / kTile;
  std::vector<std::vector<SecondaryPacket>> secondary(static_cast<std::size_t>(rows));
  double ms = 0;
  with_threads(options.threads, [&] {
    tbb::parallel_for(0, rows, [&](int y) {
      for (int x = 0; x < across; ++x)
        for (const SecondaryPacket& packet :
             impl_->packets.secondary_rays(view, tile_pixels(x, y, options.width, options.height)))
          secondary[std::size_t(y)].push_back(packet);
    });
    const auto start = Clock::now();
    tbb::parallel_for(tbb::blocked_range<int>(0, rows), [&](const tbb::blocked_range<int>& range) {
      for (int y = range.begin(); y != range.end(); ++y) {
        for (int x = 0; x < across; ++x)
          impl_->packets.query_primary(view, tile_pixels(x, y, options.width, options.height));
        for (const SecondaryPacket& packet : secondary[std::size_t(y)])
          impl_->packets.query_secondary(packet);
      }
    });
    ms = ms_since(start);
  });
  return ms;
}

}  // namespace catoptra::render
