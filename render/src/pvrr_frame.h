// Mode `pvrr`: a frame by per-vertex reflection and refraction (paper 3.1, 4.5; design 2).
#pragma once

#include <string>
#include <vector>

#include "render/frame.h"
#include "render/src/map_colors.h"
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
  [[nodiscard]] RenderResult render(const Camera& camera, const FrameOptions& options,
                                    RasterPicture& picture);

  /// For mode exact, the parts of render(): vertex rays, viewpoints and sizes of the maps, with optics in
  /// optics down to `levels`; the maps of a sample, of which those of the optics in the picture are then
  /// copied into `maps`; and what they have cost.
  void update(const Camera& camera, const FrameOptions& options, int levels, MapUse use);
  void draw_maps(glm::dvec2 offset_px, bool geometry, Overlay* overlay);
  void copy_maps(MapColors& maps) const;
  [[nodiscard]] FrameStats statistics() const;

 private:
  void set_overlay(const FrameOptions& options);
  void draw_picture(const RasterTarget& target, const RasterView& camera, glm::dvec2 offset_px, bool geometry,
                    const FrameOptions& options);
  void draw_optic(std::size_t optic, const RasterTarget& target, const RasterView& camera,
                  glm::dvec2 offset_px, bool geometry);
  void count_anew() const;
  [[nodiscard]] std::vector<std::string> map_warnings() const;

  const Scene& scene_;
  RasterScene& raster_;
  PvrrStack stack_;
  Overlay overlay_;
  GlBuffer outside_counter_;
};

}  // namespace catoptra::render
