// A lens in a raster picture: the side that the eye's rays enter, seen at every wavelength.
#pragma once

#include <functional>
#include <glm/mat3x3.hpp>
#include <map>
#include <tuple>
#include <vector>

#include "render/src/gl_objects.h"
#include "render/src/lens_rays.h"
#include "render/src/raster_lens_mask.h"
#include "render/src/raster_optic.h"
#include "render/src/raster_target.h"
#include "render/src/raster_view.h"
#include "render/src/textures.h"

namespace catoptra::render {

/// How what a vertex shows is looked up: in a map, by a lens that the picture shows, or one that another map
/// shows (as a whole, or only before a surface: RasterPass::clip_depth); or in a cube map.
enum class LensLook { map, nested, nested_clipped, cube };

/// The programs that draw lenses, made on first use.
class LensPrograms {
 public:
  const GlProgram& program(LensLook look, std::size_t samples, bool geometry);

 private:
  std::map<std::tuple<LensLook, std::size_t, bool>, GlProgram> programs_;
};

/// The vertex data of one lens for one position of the eye.
class RasterLens {
 public:
  /// `side`: the mesh of the side entered; `mask`: of the other one; both must outlive the use; `shown`: per
  /// sample of `rays` and vertex what the fragment shader of the look in use expects: homogeneous map
  /// coordinates, or directions.
  void set_shown(const RasterOptic& side, const LensMask& mask, const LensRays& rays,
                 const std::vector<std::vector<glm::dvec3>>& shown);

  /// Adds `lens`, number `index`, to what `target` (bound) shows from `camera`; geometry is that of the first
  /// sample. `set_look` sets the uniforms and textures of the look for the program in use, for a part of the
  /// side's surface (RasterOptic::set_parts).
  using SetLook = std::function<void(std::size_t part, bool geometry)>;
  void draw(const RasterView& camera, const RasterTarget& target, bool geometry, LensLook look,
            LensPrograms& programs, const optics::Optic& lens, std::size_t index, float ambient,
            const SetLook& set_look) const;

 private:
  struct Batch {
    GlBuffer shown;
    GlVertexArray array;
    std::vector<glm::mat3> weights;
  };
  const RasterOptic* side_ = nullptr;
  const LensMask* mask_ = nullptr;
  GlBuffer exits_;
  std::vector<Batch> batches_;
};

}  // namespace catoptra::render
