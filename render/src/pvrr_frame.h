// Mode `pvrr`: a frame by per-vertex reflection and refraction (paper 3.1, 4.5; design 2).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/frame.h"
#include "render/src/overlay_vertices.h"
#include "render/src/pvrr_stack.h"
#include "render/src/raster_picture.h"
#include "render/src/raster_scene.h"

namespace catoptra::render {

/// Keeps maps and programs from frame to frame; needs the same current context throughout.
class PvrrFrame {
 public:
  /// Keeps the references. `bounds`: of everything in the scene.
  PvrrFrame(const Scene& scene, RasterScene& raster, const optics::RayScene& rays,
            const cad_import::BoundingBox& bounds);

  /// The optic has changed, or is somewhere else now (which `raster` knows already); `bounds` as above.
  void optic_changed(std::size_t index, const cad_import::BoundingBox& bounds);
  void place_optic(std::size_t index, const optics::Placement& placement,
                   const cad_import::BoundingBox& bounds);

  /// Times: "trace" (vertex rays, viewpoints, map coordinates), "pass1", "pass2", "readback", "total". A
  /// warning tells how many pixels of an optic its map does not reach; in a mirror they show the sky in the
  /// outgoing direction, in a lens the map's border.
  /// With `sample_done` every sample has geometry, which is in the picture's target when it is called.
  using SampleDone = std::function<void(int sample, const RasterView& view)>;
  [[nodiscard]] RenderResult render(const Camera& camera, const FrameOptions& options, RasterPicture& picture,
                                    const SampleDone& sample_done = {});

  /// For SampleDone: writes the geometry of wavelength `extreme` of extreme_samples() in place of that of the
  /// reference wavelength, for every lens that has so many; for lenses with fewer, what was there stays.
  /// Returns whether there is any such lens.
  bool draw_extreme_geometry(const RasterTarget& target, const RasterView& view, glm::dvec2 offset_px,
                             std::size_t extreme);

 private:
  void set_overlay(const FrameOptions& options);
  void draw_picture(const RasterTarget& target, const RasterView& camera, glm::dvec2 offset_px, bool geometry,
                    const FrameOptions& options);
  void draw_optic(std::size_t optic, const RasterTarget& target, const RasterView& camera,
                  glm::dvec2 offset_px, bool geometry);
  [[nodiscard]] std::vector<std::string> map_warnings() const;
  [[nodiscard]] FrameStats statistics() const;

  const Scene& scene_;
  RasterScene& raster_;
  PvrrStack stack_;
  Overlay overlay_;
  GlBuffer outside_counter_;
};

}  // namespace catoptra::render
