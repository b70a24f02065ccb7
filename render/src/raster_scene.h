// The surroundings (and the optics as plain bodies) on the GPU, drawn into any view.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "optics/lens_path.h"
#include "optics/placement.h"
#include "render/scene.h"
#include "render/src/gl_objects.h"
#include "render/src/raster_chunks.h"
#include "render/src/raster_lens_mask.h"
#include "render/src/raster_optic.h"
#include "render/src/raster_shadows.h"
#include "render/src/raster_view.h"
#include "render/src/textures.h"

namespace catoptra::render {

/// How one view of the scene is drawn.
struct RasterPass {
  bool geometry = false;  ///< also write world position and normal; the bound target must have them
  float level_bias = 0;   ///< added to the textures' level of detail (maps: see PvrrMap)
  const GlTexture* clip_depth = nullptr;  ///< depth of the optic in this view: what is nearer is not drawn
  double clip_reach_mm = 0;               ///< that depth is nowhere beyond this distance along the view
  bool draw_optics = false;               ///< the mirrors as diffuse bodies of their reflectance ...
  std::optional<std::size_t> except;      ///< ... but not this one
  std::span<const std::size_t> nested{};  ///< ... nor these, which show their own maps
  int multisample = 1;                    ///< samples a pixel of the bound target
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
  /// Draws it from now on where `placement` takes it to.
  void place_optic(std::size_t index, const optics::Placement& placement);
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
  /// Whether any of the surroundings, or other optics as `pass` asks for them, may be seen.
  [[nodiscard]] bool sees_anything(const RasterView& view, const RasterPass& pass) const;
  /// Surroundings and optics as asked, without sky, where they hide what is in the bound target.
  void draw_bodies(const RasterView& view, const RasterPass& pass);
  /// draw() in two steps. What is drawn between them hides what is behind it before that costs anything.
  void clear(const RasterView& view, const RasterPass& pass);
  void draw_all(const RasterView& view, const RasterPass& pass);

  /// Draws only the depth of an optical surface and of its continuation beyond the border, the farthest where
  /// there are several. Depth is 1 (nearer than everything) where there is none. The bound target needs depth
  /// alone.
  void draw_optic_depth(const RasterView& view, const RasterOptic& surface);
  /// In a zooming_view(): the surface alone, and where there is none the depth of `beside_mm` from the
  /// viewpoint, which is also the least.
  void draw_zooming_optic_depth(const RasterView& view, const RasterOptic& surface, double beside_mm);

  /// Makes `view` that of the following draws; draw() does so itself.
  void begin_view(const RasterView& view, float level_bias) const;

  /// Sets the uniforms by which a mesh with origin `mesh_origin_mm` finds its place relative to the view
  /// (program in use).
  static void set_mesh_origin(const RasterView& view, const glm::dvec3& mesh_origin_mm);
  /// The same for a mesh in a frame of its own, at `mesh_origin_mm` in it.
  static void set_mesh_origin(const RasterView& view, const glm::dvec3& mesh_origin_mm,
                              const optics::Placement& placement);
  static void set_mesh_origin(const RasterView& view, const RasterOptic& optic);

  /// Draw calls for surroundings and optics as bodies, since it was made.
  [[nodiscard]] std::size_t draws() const { return draws_; }

  /// For programs that shade, see raster_shading.glsl and raster_lights.glsl; they hold for targets with
  /// shading_samples() samples a pixel, which is that of the last clear(), or 1 where there are no shadows.
  [[nodiscard]] std::vector<std::string> shading_defines() const;
  [[nodiscard]] int shading_samples() const { return shading_samples_; }

  /// What shadows have cost since the last call.
  [[nodiscard]] ShadowStats take_shadow_statistics();

 private:
  struct Batch {
    GLint texture;  ///< index in textures_, -1: none
    bool alpha_test;
    glm::vec3 albedo, emissive;
    float alpha, cutoff;
    cad_import::TextureWrap wrap;
  };
  /// What is drawn in one piece.
  struct Chunk {
    std::size_t batch;
    TriangleChunk triangles;  ///< in the common index buffer
  };
  struct Draw {
    std::size_t chunk;
    double nearest_mm;
    bool clip;
  };

  /// Of the numbers of ways by several optics, see raster_shown.glsl.
  [[nodiscard]] float way_base() const;
  [[nodiscard]] float way_limit() const;
  void upload_surroundings();
  void upload_textures(const SceneTextures& textures);
  [[nodiscard]] std::vector<Draw> draws_of(const RasterView& view, const RasterPass& pass) const;
  void draw_bodies_in_view(const RasterView& view, const RasterPass& pass);
  void draw_surroundings(const RasterView& view, const RasterPass& pass);
  void draw_shadows(const RasterView& view, const RasterPass& pass);
  void draw_depth_of_bodies(const RasterView& view, RasterPass pass);
  void draw_depth(const RasterView& view, const RasterOptic& surface, float none, GLenum keep, bool skirt);
  void set_material(const Batch& batch) const;
  void draw_optics(const RasterView& view, const RasterPass& pass);
  void draw_sky(const RasterPass& pass);
  /// Compiled on first use, for each combination of the shader's variants.
  struct Surface {
    bool textured, alpha_test, clip, geometry, depth_only;
  };
  const GlProgram& surface_program(const Surface& surface);
  const GlProgram& sky_program(bool geometry);

  const Scene& scene_;
  GlBuffer view_uniforms_, vertices_, indices_;
  GlVertexArray surroundings_, nothing_;
  std::vector<GlTexture> textures_;
  std::array<GlSampler, 3> samplers_;  ///< by TextureWrap
  GlTexture sky_;
  std::vector<Light> lights_;  ///< the directional ones first
  std::vector<Batch> batches_;
  std::vector<Chunk> chunks_;
  std::vector<glm::vec3> positions_;      ///< of the surroundings, once more on the CPU ...
  std::vector<std::uint32_t> triangles_;  ///< ... with the common index buffer, to find what is near
  std::vector<RasterOptic> optics_;
  std::vector<std::optional<RasterOptic>> backs_;  ///< of the lenses
  std::map<unsigned, GlProgram> surface_programs_;
  std::map<std::pair<bool, int>, GlProgram> sky_programs_;
  GlProgram depth_program_;
  std::size_t draws_ = 0;
  std::unique_ptr<RasterShadows> shadows_;  ///< null where no light casts shadows
  int shading_samples_ = 1;
  bool depth_only_ = false;  ///< bodies are being drawn for shadows
  std::map<std::pair<std::size_t, optics::LensSide>, LensMask> masks_;
};

}  // namespace catoptra::render
