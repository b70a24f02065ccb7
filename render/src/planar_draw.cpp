#include "render/src/planar_draw.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "render/src/shading.h"

namespace catoptra::render {
namespace {

// As in planar_optic.frag.glsl and raster_shown.glsl.
constexpr GLint kReflectance = 3, kWorks = 4, kBackAlbedo = 5, kOpticId = 6, kSurfaceAlbedo = 7,
                kReflectedGrid = 8, kPassedGrid = 9, kIndexRatio = 10, kTint = 11, kHasMap = 12,
                kPassedEye = 13, kFog = 14, kFace = 15, kFogAlbedo = 20;
constexpr GLuint kReflectedColor = 2, kReflectedPosition = 3, kReflectedDetail = 4, kPassedColor = 5,
                 kPassedDepth = 6, kPassedPosition = 9, kPassedDetail = 10;
// Fog of translucency 1 leaves nothing at any distance.
constexpr double kDensestFog = -1e6;

void set_vec3(GLint location, const glm::vec3& v) {
  glUniform3f(location, v.x, v.y, v.z);
}

/// Texels of a map for pixels of the target.
void set_grid(GLint location, const PixelRect& rect, glm::ivec2 corner, bool mirrored) {
  const glm::ivec2 first = rect.begin + corner;
  if (mirrored)
    glUniform4i(location, first.x + rect.size().x - 1, -first.y, -1, 1);
  else
    glUniform4i(location, -first.x, -first.y, 1, 1);
}

}  // namespace

void PlanarDraw::draw(const PlanarOptic& drawn, const RasterView& view, const PvrrDraw::Look& look) {
  const optics::Optic& optic = scene_.optics[drawn.index()];
  const bool glass = optics::is_planar_glass(optic);
  const bool covered = optic.material.material_alpha > 0;
  if (glass && !drawn.works()) return;
  if (!drawn.faces_eye() && drawn.works() && !covered) return;
  glUseProgram(program(optic, look).id());
  RasterScene::set_mesh_origin(view, raster_.optic(drawn.index()));
  set_vec3(kReflectance, optic.reflectance);
  glUniform1i(kWorks, drawn.works() && drawn.faces_eye() ? 1 : 0);
  glUniform1f(kBackAlbedo, kOpticBackAlbedo);
  glUniform1f(kOpticId, static_cast<float>(drawn.index()));
  const optics::PlanarMaterial& material = optic.material;
  glUniform4f(kSurfaceAlbedo, material.color.x, material.color.y, material.color.z,
              static_cast<float>(material.material_alpha));
  if (drawn.has_map(PlanarOptic::kReflected)) {
    const RasterTarget& target = drawn.target(PlanarOptic::kReflected);
    set_grid(kReflectedGrid, drawn.rect(), view.corner, true);
    glBindTextureUnit(kReflectedColor, target.color().id());
    if (look.geometry) {
      glBindTextureUnit(kReflectedPosition, target.position().id());
      glBindTextureUnit(kReflectedDetail, target.detail().id());
    }
  }
  if (glass) set_glass(drawn, view, look.geometry);
  raster_.optic(drawn.index()).draw_surface();
}

void PlanarDraw::set_glass(const PlanarOptic& drawn, const RasterView& view, bool geometry) const {
  const optics::PlanarMaterial& material = scene_.optics[drawn.index()].material;
  const bool passes = drawn.has_map(PlanarOptic::kPassed);
  glUniform1f(kIndexRatio, static_cast<float>(drawn.index_ratio()));
  set_vec3(kTint, material.tint);
  // Black glass passes nothing, and reflects no more than clear glass for that.
  const bool all_reflected = !passes && glm::dot(material.tint, material.tint) > 0;
  glUniform3i(kHasMap, drawn.has_map(PlanarOptic::kReflected) ? 1 : 0, passes ? 1 : 0, all_reflected ? 1 : 0);
  set_vec3(kFogAlbedo, material.color);
  if (!passes) return;
  set_grid(kPassedGrid, drawn.rect(), view.corner, false);
  set_vec3(kPassedEye, glm::vec3(drawn.passed_eye_mm() - view.origin_mm));
  const optics::Plane& plane = drawn.plane();
  glUniform4f(kFace, float(plane.normal.x), float(plane.normal.y), float(plane.normal.z),
              float(-plane.height_mm(view.origin_mm)));
  const double fog = material.translucency < 1
                         ? std::max(kDensestFog, std::log1p(-material.translucency) / 1000)
                         : kDensestFog;
  glUniform2f(kFog, float(fog), float(drawn.near(PlanarOptic::kPassed)));
  const RasterTarget& target = drawn.target(PlanarOptic::kPassed);
  glBindTextureUnit(kPassedColor, target.color().id());
  glBindTextureUnit(kPassedDepth, target.depth().id());
  if (!geometry) return;
  glBindTextureUnit(kPassedPosition, target.position().id());
  glBindTextureUnit(kPassedDetail, target.detail().id());
}

const GlProgram& PlanarDraw::program(const optics::Optic& optic, const PvrrDraw::Look& look) {
  const std::tuple key{optic.kind, look.geometry, look.in_map, look.clipped, raster_.shading_samples()};
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second;
  std::vector<std::string> defines = raster_.shading_defines();
  if (optics::is_planar_glass(optic)) defines.emplace_back("GLASS");
  if (optic.kind == optics::OpticKind::pane) defines.emplace_back("PANE");
  if (look.geometry) defines.emplace_back("GEOMETRY");
  if (look.in_map) defines.emplace_back("IN_MAP");
  if (look.clipped) defines.emplace_back("CLIP_AGAINST_OPTIC");
  return programs_
      .emplace(key, make_program({"raster_view.glsl", "raster_surface.vert.glsl"},
                                 {"raster_view.glsl", "raster_lights.glsl", "raster_shading.glsl",
                                  "raster_shown.glsl", "planar_optic.frag.glsl"},
                                 defines))
      .first->second;
}

}  // namespace catoptra::render
