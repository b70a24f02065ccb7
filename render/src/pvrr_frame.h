// Mode `pvrr`: a frame by per-vertex reflection (paper 3.1; design 2).
#pragma once

#include <map>
#include <span>
#include <vector>

#include "optics/map_coordinates.h"
#include "optics/vertex_hits.h"
#include "optics/virtual_view.h"
#include "render/frame.h"
#include "render/src/overlay_vertices.h"
#include "render/src/pvrr_map.h"
#include "render/src/raster_picture.h"
#include "render/src/raster_scene.h"

namespace catoptra::render {

/// Keeps maps and programs from frame to frame; needs the same current context throughout.
class PvrrFrame {
 public:
  /// Keeps the references. `bounds`: of everything in the scene.
  PvrrFrame(const Scene& scene, RasterScene& raster, const optics::RayScene& rays,
            cad_import::BoundingBox bounds);

  /// Times: "trace" (vertex rays, viewpoints, map coordinates), "pass1", "pass2", "readback", "total". A
  /// warning tells how many pixels of an optic its map does not reach; they show the sky in the reflected
  /// direction.
  [[nodiscard]] RenderResult render(const Camera& camera, const FrameOptions& options,
                                    RasterPicture& picture);

 private:
  /// One optic in the frame at hand. Without `faces_eye` there is no view and the map is left alone.
  struct Patch {
    std::vector<optics::VertexHit> hits;
    optics::VirtualView view;
    std::vector<glm::dvec3> coordinates;
    std::size_t rays = 0;
    bool faces_eye = false;
    bool on_pixel_grid = false;  ///< the view is that of plane_view()
    PvrrMap map;
  };

  void trace(std::size_t optic, const RasterView& camera, const FrameOptions& options);
  void set_overlay(const FrameOptions& options);
  /// Where the samples of an optic's map lie within its texels, for samples at `offset_px` in the pixels.
  [[nodiscard]] static glm::dvec2 map_offset(const Patch& patch, glm::dvec2 offset_px);
  void draw_maps(glm::dvec2 offset_px, bool geometry, const FrameOptions& options);
  void draw_picture(const RasterTarget& picture_target, const RasterView& camera, glm::dvec2 map_offset_px,
                    bool geometry, const FrameOptions& options);
  void draw_optic(std::size_t optic, const RasterView& camera, glm::dvec2 offset_px, bool geometry);
  [[nodiscard]] FrameStats statistics() const;
  const GlProgram& optic_program(bool geometry);

  const Scene& scene_;
  RasterScene& raster_;
  const optics::RayScene& rays_;
  cad_import::BoundingBox bounds_;
  std::vector<Patch> patches_;  ///< one per optic
  Overlay overlay_;
  GlBuffer outside_counter_;
  std::map<bool, GlProgram> optic_programs_;
};

}  // namespace catoptra::render
