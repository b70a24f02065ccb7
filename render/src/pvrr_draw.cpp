#include "render/src/pvrr_draw.h"

#include <string>
#include <vector>

#include "render/src/raster_optic_uniforms.h"

namespace catoptra::render {

void PvrrDraw::draw(const PvrrOptic& drawn, std::size_t index, const RasterTarget& target,
                    const RasterView& camera, glm::dvec2 offset_px, const Look& look) {
  const optics::Optic& optic = scene_.optics[index];
  if (optics::is_planar_glass(optic)) return;
  if (optic.kind == optics::OpticKind::lens) {
    const LensLook lens_look = !look.in_map   ? LensLook::map
                               : look.clipped ? LensLook::nested_clipped
                                              : LensLook::nested;
    drawn.lens().draw(
        camera, target, look.geometry, lens_look, lens_programs_, optic, index, scene_.environment.ambient,
        [&](std::size_t patch, bool with_geometry) { drawn.set_map(patch, offset_px, with_geometry); });
    return;
  }
  glUseProgram(mirror_program(look).id());
  RasterScene::set_mesh_origin(camera, drawn.seen_surface());
  set_optic_uniforms(optic, index);
  for (std::size_t patch = 0; patch < drawn.seen_surface().part_count(); ++patch) {
    drawn.set_map(patch, offset_px, look.geometry);
    drawn.seen_surface().draw_part(patch);
  }
}

const GlProgram& PvrrDraw::mirror_program(const Look& look) {
  const std::tuple key{look.geometry, look.in_map, look.clipped, raster_.shading_samples()};
  const auto found = mirror_programs_.find(key);
  if (found != mirror_programs_.end()) return found->second;
  std::vector<std::string> defines = raster_.shading_defines();
  if (look.geometry) defines.emplace_back("GEOMETRY");
  if (look.in_map) defines.emplace_back("IN_MAP");
  if (look.clipped) defines.emplace_back("CLIP_AGAINST_OPTIC");
  return mirror_programs_
      .emplace(key, make_program({"raster_view.glsl", "raster_surface.vert.glsl"},
                                 {"raster_view.glsl", "raster_lights.glsl", "raster_shading.glsl",
                                  "raster_shown.glsl", "raster_optic.glsl", "pvrr_optic.frag.glsl"},
                                 defines))
      .first->second;
}

}  // namespace catoptra::render
