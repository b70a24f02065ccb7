// Mode `cubemap`: the baseline of the PVRR paper (Fig. 1): a dynamic cube map at the optic's centre.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "cad_import/cad_model.h"
#include "render/frame.h"
#include "render/src/raster_picture.h"
#include "render/src/raster_scene.h"

namespace catoptra::render {

/// Keeps cube maps and programs from frame to frame; needs the same current context throughout.
class CubemapFrame {
 public:
  CubemapFrame(const Scene& scene, RasterScene& raster);

  /// All six faces are drawn in every frame, each with as many texels per radian as a pixel's reflection off
  /// a plane mirror needs for settings.texels_per_pixel, at most 1024 a side. Times: "pass1"
  /// (six faces), "pass2", "readback", "total".
  [[nodiscard]] RenderResult render(const Camera& camera, const FrameOptions& options,
                                    RasterPicture& picture);

 private:
  struct Cube {
    int size = 0;
    bool geometry = false;
    GlTexture color, position, detail, depth;
    GlFramebuffer framebuffer;
  };

  void draw_cube(std::size_t optic, int size, double texels_per_pixel, bool geometry);
  void draw_optic(std::size_t optic, const RasterView& camera, bool geometry);
  const GlProgram& optic_program(bool geometry);

  const Scene& scene_;
  RasterScene& raster_;
  std::vector<Cube> cubes_;  ///< one per optic
  std::map<bool, GlProgram> optic_programs_;
};

}  // namespace catoptra::render
