#include "render/src/raster_optic_uniforms.h"

#include <epoxy/gl.h>

#include "render/src/shading.h"

namespace catoptra::render {
namespace {

// As in raster_optic.glsl.
constexpr GLint kReflectance = 3, kFrontReflects = 4, kBackAlbedo = 5, kOpticId = 6;

}  // namespace

void set_optic_uniforms(const optics::Optic& optic, std::size_t index) {
  glUniform3f(kReflectance, optic.reflectance.x, optic.reflectance.y, optic.reflectance.z);
  glUniform1i(kFrontReflects, optic.flip ? 0 : 1);
  glUniform1f(kBackAlbedo, kOpticBackAlbedo);
  glUniform1f(kOpticId, static_cast<float>(index));
}

}  // namespace catoptra::render
