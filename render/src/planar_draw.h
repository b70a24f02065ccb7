// A planar optic drawn with its maps into the picture, or into the map of another optic.
#pragma once

#include <map>
#include <tuple>

#include "render/src/gl_objects.h"
#include "render/src/planar_optic.h"
#include "render/src/pvrr_draw.h"

namespace catoptra::render {

/// Keeps the programs, made on first use; needs the same current context throughout.
class PlanarDraw {
 public:
  PlanarDraw(const Scene& scene, const RasterScene& raster) : scene_(scene), raster_(raster) {}

  /// `view`: begun, the one for which the maps were drawn. Its target is bound.
  void draw(const PlanarOptic& drawn, const RasterView& view, const PvrrDraw::Look& look);

 private:
  const GlProgram& program(const optics::Optic& optic, const PvrrDraw::Look& look);
  void set_glass(const PlanarOptic& drawn, const RasterView& view, bool geometry) const;

  const Scene& scene_;
  const RasterScene& raster_;
  /// By kind, look and RasterScene::shading_samples().
  std::map<std::tuple<optics::OpticKind, bool, bool, bool, int>, GlProgram> programs_;
};

}  // namespace catoptra::render
