// Mode `cubemap`: the baseline of the PVRR paper (Fig. 1): a dynamic cube map at the optic's centre.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cad_import/cad_model.h"
#include "optics/lens_path.h"
#include "render/frame.h"
#include "render/src/raster_lens.h"
#include "render/src/raster_picture.h"
#include "render/src/raster_scene.h"

namespace catoptra::render {

/// Keeps cube maps and programs from frame to frame; needs the same current context throughout.
class CubemapFrame {
 public:
  CubemapFrame(const Scene& scene, RasterScene& raster);

  /// The optic has changed or moved.
  void optic_changed(std::size_t index) { lenses_[index] = {}; }

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
  };
  /// What the vertices of a lens show; `eye_mm`, `placement`: from where, and where it was.
  struct Lens {
    std::optional<glm::dvec3> eye_mm;
    optics::Placement placement;
    std::unique_ptr<optics::LensTracer> tracer;
    RasterLens raster;
  };

  void trace_lens(std::size_t optic, const glm::dvec3& eye_mm, bool reuse);
  static void set_cube_geometry(const Cube& cube, const glm::dvec3& center_mm);
  [[nodiscard]] glm::dvec3 center_mm(std::size_t optic) const;
  void draw_cube(std::size_t optic, int size, double texels_per_pixel, bool geometry);
  void draw_optic(std::size_t optic, const RasterTarget& target, const RasterView& camera, bool geometry);
  void draw_lens(std::size_t optic, const RasterTarget& target, const RasterView& camera, bool geometry);
  const GlProgram& optic_program(bool geometry);

  const Scene& scene_;
  RasterScene& raster_;
  std::vector<Cube> cubes_;   ///< one per optic
  std::vector<Lens> lenses_;  ///< one per optic, empty for mirrors
  std::map<std::pair<bool, int>, GlProgram> optic_programs_;
  LensPrograms lens_programs_;
};

}  // namespace catoptra::render
