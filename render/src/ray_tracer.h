// The reference: every pixel by exact rays, with packets of 16 on all cores (design 4).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "optics/ray_scene.h"
#include "render/frame.h"
#include "render/scene.h"
#include "render/src/ray_tracer_mapped.h"
#include "render/src/textures.h"

namespace catoptra::render {

/// What stands for an optic in the shared ray scene: the mesh of a mirror or planar glass; nothing for a
/// lens, which casts no shadow. Lenses and glass are kept apart by the tracer itself, so that
[[nodiscard]] const tessellate::OpticArrays& mesh_for_rays(const optics::Optic& optic);
/// ... only shadow rays meet glass.
[[nodiscard]] std::uint32_t mask_for_rays(const optics::Optic& optic);

/// Objects of the shared ray scene: surroundings 0 .. surroundings.size() - 1, then the optics in order.
/// Gives `frame` the options' size, and room for colours and, where asked for, geometry. Keeps its memory.
void allocate(Frame& frame, const FrameOptions& options);

class RayTracer {
 public:
  /// Keeps references to all three, which must outlive it.
  RayTracer(const Scene& scene, const SceneTextures& textures, const optics::RayScene& rays);
  ~RayTracer();

  /// Every pixel: mode `raytrace`.
  [[nodiscard]] RenderResult render(const Camera& camera, const FrameOptions& options) const;

  /// Mode `hybrid`: traces only the pixels listed (index = row * width + column), which are expected to show
  /// an optic, and writes their colour (and geometry where asked) into `frame`, which has the options' size.
  /// A listed pixel whose primary ray meets no optic gets what the ray meets. Returns the number of rays
  /// traced.
  std::size_t trace_pixels(const Camera& camera, const FrameOptions& options,
                           std::span<const std::uint32_t> pixels, Frame& frame) const;

  /// Mode `exact`: the same for one sample, whose share is added to the colours in `frame`. What the rays
  /// meet behind an optic is shaded only where its maps do not show it.
  std::size_t trace_mapped(const Camera& camera, const FrameOptions& options,
                           std::span<const std::uint32_t> pixels, const MappedSample& mapped,
                           Frame& frame) const;

  /// Tells that the mesh of optic `index` has changed (the ray scene is updated by its owner).
  void optic_changed(std::size_t index);

  /// Time in ms of nothing but the packet queries of such a frame, on the same threads: primary rays
  /// generated and queried, and the reflected rays, computed beforehand, loaded and queried. The yardstick of
  /// the ray tracer's speed.
  [[nodiscard]] double bare_packet_ms(const Camera& camera, const FrameOptions& options) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catoptra::render
