// One packet of 16 pixels from the eye to its colours.
#pragma once

#include <memory>
#include <vector>

#include "optics/ray_scene.h"
#include "render/frame.h"
#include "render/src/exact_pixels.h"
#include "render/src/ray_tracer_chain.h"
#include "render/src/ray_tracer_exact.h"
#include "render/src/ray_tracer_lens.h"
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

  /// Writes where the rays through the pixels' centres, moved by `offset_px`, leave an optic and what they
  /// meet, for the active pixels that show one. Behind a lens the ray is that of wavelength `extreme` of
  /// extreme_samples(), or of the last of them where there are fewer. Returns the number of rays.
  std::size_t trace_exact(const PacketView& view, glm::dvec2 offset_px, std::size_t extreme,
                          const PixelPacket& pixels, ExactPixels& exact) const;

  /// The reflected and refracted rays of the pixels' centres.
  [[nodiscard]] std::vector<SecondaryPacket> secondary_rays(const PacketView& view,
                                                            const PixelPacket& pixels) const;

  /// Bare queries, as trace() makes them.
  void query_primary(const PacketView& view, const PixelPacket& pixels) const;
  void query_secondary(const SecondaryPacket& secondary) const;

 private:
  struct Packet;

  void primary(const PacketView& view, const PixelPacket& pixels, glm::dvec2 offset, Packet& p) const;
  void reflect(const CameraRays& camera, Packet& p) const;
  bool find_mirrors(Packet& p) const;
  static void load_reflected(Packet& p);
  std::size_t refract(const PacketView& view, const PixelPacket& pixels, Packet& p, Frame* geometry) const;
  void set_hits(const CameraRays& camera, Packet& p) const;
  std::size_t refract_exact(const PacketView& view, std::size_t extreme, const PixelPacket& pixels, Packet& p,
                            ExactPixels& exact) const;
  void write_geometry(const CameraRays& camera, const PixelPacket& pixels, const Packet& p,
                      Frame& frame) const;

  /// Where the geometry of paths of several optics goes: the frame has it already as if the first optic were
  /// the last. Null: nowhere.
  struct GeometrySink {
    Frame* frame = nullptr;
    std::vector<glm::vec3>* normal = nullptr;
  };
  std::size_t follow_mirrors(const CameraRays& camera, const PixelPacket& pixels, Packet& p,
                             const ChainTask& task, const GeometrySink& sink) const;
  std::size_t follow_lenses(const PixelPacket& pixels, const Packet& p, std::size_t sample,
                            const ChainTask& task, RefractedLanes& out, const GeometrySink& sink) const;
  static void write_ends(const PixelPacket& pixels, const MetOptics& met, const ChainEnds& ends,
                         const GeometrySink& sink);

  const Scene& scene_;
  const optics::RayScene& rays_;
  ShadingScene shading_;
  std::vector<std::unique_ptr<ExactMirror>> mirrors_;  ///< one per optic; null: a lens
  TracedLenses lenses_;
  TracedChains chains_;
  std::vector<Float4> tints_;  ///< reflectance of each optic
};

}  // namespace catoptra::render
