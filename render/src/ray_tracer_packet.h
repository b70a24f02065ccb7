// One packet of 16 pixels from the eye to its colours.
#pragma once

#include <memory>
#include <vector>

#include "optics/ray_scene.h"
#include "render/frame.h"
#include "render/src/ray_tracer_chain.h"
#include "render/src/ray_tracer_exact.h"
#include "render/src/ray_tracer_lens.h"
#include "render/src/ray_tracer_mapped.h"
#include "render/src/ray_tracer_planar.h"
#include "render/src/sampling.h"
#include "render/src/shading.h"

namespace catoptra::render {

struct PixelPacket {
  static constexpr int kLanes = 16;
  int column[kLanes], row[kLanes];
  bool active[kLanes];
};

/// What is the same for all packets of a picture.
struct PacketView {
  CameraRays camera;
  std::vector<optics::LensSide> entered;  ///< of each lens, by the eye; see TracedLenses
};

/// The reflected or refracted rays of a packet, for timing queries alone.
struct alignas(64) SecondaryPacket {
  float origin_x[16], origin_y[16], origin_z[16], direction_x[16], direction_y[16], direction_z[16];
  float t_max[16];      ///< negative: inactive
  bool others = false;  ///< may meet optics
};

class PacketTracer {
 public:
  /// Keeps references to all three, which must outlive it.
  PacketTracer(const Scene& scene, const SceneTextures& textures, const optics::RayScene& rays);

  void optic_changed(std::size_t index);

  [[nodiscard]] PacketView view(const CameraRays& camera) const {
    return {camera, lenses_.entered_from(camera.eye_mm)};
  }

  /// Traces and shades all samples of the active pixels and writes them into `frame`. Returns the number of
  /// rays.
  std::size_t trace(const PacketView& view, const FrameOptions& options, const PixelPacket& pixels,
                    Frame& frame) const;

  /// The same of one sample alone. What maps do not know is shaded as in trace().
  std::size_t trace_mapped(const PacketView& view, const FrameOptions& options, const PixelPacket& pixels,
                           const MappedSample& mapped, Frame& frame) const;

  /// The reflected and refracted rays of the pixels' centres.
  [[nodiscard]] std::vector<SecondaryPacket> secondary_rays(const PacketView& view,
                                                            const PixelPacket& pixels) const;

  /// Bare queries, as trace() makes them.
  void query_primary(const PacketView& view, const PixelPacket& pixels) const;
  void query_secondary(const SecondaryPacket& secondary) const;

 private:
  struct Packet;

  void primary(const PacketView& view, const PixelPacket& pixels, glm::dvec2 offset, std::uint32_t mask,
               Packet& p) const;
  void reflect(const CameraRays& camera, Packet& p) const;
  bool find_mirrors(Packet& p) const;
  [[nodiscard]] bool reflects(const optics::RayPacket16& hits, int lane) const;
  void find_planars(Packet& p) const;
  static void load_reflected(Packet& p);
  std::size_t trace_sample(const PacketView& view, const FrameOptions& options, const PixelPacket& pixels,
                           int sample, const MappedSample* mapped, Frame& frame, Packet& p) const;
  std::size_t refract(const PacketView& view, const PixelPacket& pixels, const MapColors* maps, Packet& p,
                      Frame* geometry) const;
  void take_mirrored_colors(const CameraRays& camera, const MapColors& maps, Packet& p) const;
  void set_hits(const CameraRays& camera, Packet& p) const;
  void write_geometry(const CameraRays& camera, const PixelPacket& pixels, const Packet& p,
                      Frame& frame) const;

  // Paths of several optics; `geometry`, or null, has been written as if the first optic were the last.
  std::size_t follow_mirrors(const CameraRays& camera, const PixelPacket& pixels, Packet& p,
                             Frame* geometry) const;
  std::size_t follow_planars(const CameraRays& camera, const PixelPacket& pixels, Packet& p,
                             Frame* geometry) const;
  std::size_t follow_lenses(const PixelPacket& pixels, Packet& p, std::size_t sample, RefractedLanes& out,
                            Frame* geometry) const;
  std::size_t follow(const PixelPacket& pixels, const ChainLanes& from, const MetOptics& met,
                     ShadeLanes& shade, bool (&traced)[PixelPacket::kLanes], Frame* geometry) const;
  static void write_ends(const PixelPacket& pixels, const MetOptics& met, const ChainEnds& ends,
                         Frame& frame);

  const Scene& scene_;
  const optics::RayScene& rays_;
  ShadingScene shading_;
  std::vector<std::unique_ptr<ExactMirror>> mirrors_;  ///< one per optic; null: no mirror
  TracedLenses lenses_;
  TracedPlanars planars_;
  TracedChains chains_;
  std::vector<Float4> tints_;  ///< reflectance of each optic
};

}  // namespace catoptra::render
