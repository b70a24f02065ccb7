// Where a lens's exit surface is: the picture of it along its own mean normal.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/src/gl_objects.h"
#include "render/src/raster_optic.h"

namespace catoptra::render {

class RasterScene;

/// Tells by a point on (the continuation of) the exit surface whether light passes there or meets the rim, to
/// about a third of a texel of 1/1000 of the lens. Depends on the lens alone.
class LensMask {
 public:
  LensMask(const RasterScene& scene, const RasterOptic& exit, const tessellate::OpticArrays& mesh);

  /// 1 on the surface, 0 beside it, linearly filtered; outside is 0.
  [[nodiscard]] const GlTexture& texture() const { return texture_; }
  /// Texture coordinates of a point.
  [[nodiscard]] glm::dvec2 place(const glm::dvec3& point_mm) const;

 private:
  glm::dvec3 center_mm_{0};
  glm::dmat3 axes_{1};  ///< rows: right, up, towards the eye of the picture
  glm::dvec2 half_mm_{1};
  GlTexture texture_;
};

}  // namespace catoptra::render
