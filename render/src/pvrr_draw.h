// PVRR pass 2 for one optic: drawn with its map into the picture, or into the map of another optic.
#pragma once

#include <map>
#include <tuple>

#include "render/src/pvrr_optic.h"
#include "render/src/raster_lens.h"
#include "render/src/raster_scene.h"

namespace catoptra::render {

/// Keeps the programs, made on first use; needs the same current context throughout.
class PvrrDraw {
 public:
  PvrrDraw(const Scene& scene, const RasterScene& raster) : scene_(scene), raster_(raster) {}

  /// How the optic is drawn: see pvrr_optic.frag.glsl.
  struct Look {
    bool geometry = false;
    bool in_map = false;
    bool clipped = false;  ///< by RasterPass::clip_depth, which is bound
  };

  /// Draws optic `index`, by what `drawn` knows of it, into `target` (bound) as `camera` sees it;
  /// begin_view() has been called for that. `offset_px`: of the camera's samples. In a picture, samples
  /// outside the map are counted in the atomic counter that is bound.
  void draw(const PvrrOptic& drawn, std::size_t index, const RasterTarget& target, const RasterView& camera,
            glm::dvec2 offset_px, const Look& look);

 private:
  const GlProgram& mirror_program(const Look& look);

  const Scene& scene_;
  const RasterScene& raster_;
  std::map<std::tuple<bool, bool, bool, int>, GlProgram> mirror_programs_;
  LensPrograms lens_programs_;
};

}  // namespace catoptra::render
