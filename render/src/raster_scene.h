// The surroundings (and the optics as plain bodies) on the GPU, drawn into any view.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "optics/lens_path.h"
#include "render/scene.h"
#include "render/src/gl_objects.h"
#include "render/src/raster_lens_mask.h"
#include "render/src/raster_optic.h"
#include "render/src/raster_view.h"
#include "render/src/textures.h"

namespace catoptra::render {

/// How one view of the scene is drawn.
struct RasterPass {
  bool geometry = false;  ///< also write world position and normal; the bound target must have them
  float level_bias = 0;   ///< added to the textures' level of detail (maps: see PvrrMap)
  const GlTexture* clip_depth = nullptr;  ///< depth of the optic in this view: what is nearer is not drawn
  bool draw_optics = false;               ///< the mirrors as diffuse bodies of their reflectance ...
  std::optional<std::size_t> except;      ///< ... but not this one
};

/// Everything static is uploaded once, positions in the meshes' own coordinates. Needs a current context
/// throughout.
class RasterScene {
 public:
  /// Copies what it needs to the GPU; keeps a reference to `scene`. Throws catoptra::Error for more than 64
  /// lights.
  RasterScene(const Scene& scene, const SceneTextures& textures);

  /// Uploads the mesh of optic `index` again.
  void optic_changed(std::size_t index);
  /// A mirror, or the front of a lens.
  [[nodiscard]] RasterOptic& optic(std::size_t index) { return optics_[index]; }
  [[nodiscard]] const RasterOptic& optic(std::size_t index) const { return optics_[index]; }
  [[nodiscard]] const RasterOptic& side(std::size_t lens, optics::LensSide side) const {
    return side == optics::LensSide::front ? optics_[lens] : *backs_[lens];
  }

  /// Of the surface by which light leaves `lens`. Binds another target where it is made for the first time.
  const LensMask& exit_mask(std::size_t lens, optics::LensSide exit);

  /// Clears the bound target and draws surroundings, optics as asked, and the sky.
  void draw(const RasterView& view, const RasterPass& pass);

  /// Draws only the depth of an optical surface and of its continuation beyond the border, the farthest where
  /// there are several. Depth is 1 (nearer than everything) where there is none. The bound target needs depth
  /// alone.
  void draw_optic_depth(const RasterView& view, const RasterOptic& surface);

  /// Makes `view` that of the following draws; draw() does so itself.
  void begin_view(const RasterView& view, float level_bias) const;

  /// Sets the uniforms by which a mesh with origin `mesh_origin_mm` finds its place relative to the view
  /// (program in use).
  static void set_mesh_origin(const RasterView& view, const glm::dvec3& mesh_origin_mm);

 private:
  struct Batch {
    GLsizei count;
    std::size_t first;  ///< index in the common index buffer
    GLint texture;      ///< index in textures_, -1: none
    bool alpha_test;
    glm::vec3 albedo, emissive;
    float alpha, cutoff;
    cad_import::TextureWrap wrap;
  };

  void upload_surroundings();
  void upload_textures(const SceneTextures& textures);
  void draw_surroundings(const RasterView& view, const RasterPass& pass);
  void draw_optics(const RasterView& view, const RasterPass& pass);
  void draw_sky(const RasterPass& pass);
  /// Compiled on first use, for each combination of the shader's variants.
  const GlProgram& surface_program(bool textured, bool alpha_test, bool clip, bool geometry);
  const GlProgram& sky_program(bool geometry);

  const Scene& scene_;
  GlBuffer view_uniforms_, vertices_, indices_;
  GlVertexArray surroundings_, nothing_;
  std::vector<GlTexture> textures_;
  std::array<GlSampler, 3> samplers_;  ///< by TextureWrap
  GlTexture sky_;
  std::vector<Batch> batches_;
  std::vector<RasterOptic> optics_;
  std::vector<std::optional<RasterOptic>> backs_;  ///< of the lenses
  std::map<unsigned, GlProgram> surface_programs_;
  std::map<bool, GlProgram> sky_programs_;
  GlProgram depth_program_;
  std::map<std::pair<std::size_t, optics::LensSide>, LensMask> masks_;
};

}  // namespace catoptra::render
