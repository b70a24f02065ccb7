// Shadows in the raster modes: shadow and light volumes counted in the stencil (Diefenbach and Badler 1994;
// depth-fail after Bilodeau and Songy, and Carmack), for any view. What reaches a pixel is kept as one bit
// for each light.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "optics/placement.h"
#include "render/frame.h"
#include "render/scene.h"
#include "render/src/raster_shadow_target.h"
#include "render/src/raster_view.h"
#include "render/src/shadow_points.h"
#include "render/src/shadow_volume.h"
#include "render/src/virtual_shadows.h"

namespace catoptra::render {

/// Whether any light casts shadows; else everything is drawn without any of this.
[[nodiscard]] bool has_shadows(const Scene& scene);

/// Adds them to what a frame has cost, its times included, where there are any.
void add_shadows(const ShadowStats& shadows, FrameStats& stats);

class RasterShadows {
 public:
  /// Keeps a reference to `scene`. Needs a current context throughout.
  explicit RasterShadows(const Scene& scene);

  /// The optic has changed, or is somewhere else now. Only its own volumes, and those of virtual lights, are
  /// made anew.
  void optic_changed(std::size_t index);
  /// Needs no current context.
  void place_optic(std::size_t index, const optics::Placement& placement);

  /// For raster_lights.glsl, in targets with so many samples a pixel.
  [[nodiscard]] std::vector<std::string> defines(int multisample) const;
  /// Lets programs read the lights relative to the view.
  void bind_lights(const RasterView& view);

  /// Finds out which lights reach what the view shows, and lets programs read it at the same pixels.
  /// `draw_depth` draws the depth of all bodies of the view into the bound target. Uniforms of the view are
  /// set (RasterScene::begin_view). The scissor rectangle holds here too. Leaves the bound target as it is.
  void draw(const RasterView& view, int multisample, const std::function<void()>& draw_depth);

  /// Counts since the last call.
  [[nodiscard]] ShadowStats take_statistics();

 private:
  /// Casters on the GPU, in a frame of their own.
  struct Casters {
    ShadowCasters mesh;
    glm::dvec3 center_mm{0};
    optics::Placement placement;
    GlBuffer vertices;
    GlVertexArray array;
  };
  struct Volume {
    const Casters* casters = nullptr;
    glm::dvec4 light{0};  ///< in their frame, relative to their centre
    ShadowVolume volume;
    GlBuffer indices;
  };
  /// Of a virtual light.
  struct Beam {
    Casters aperture, casters;
    Volume light_volume, shadows;
  };
  struct Counting;

  void upload(Casters& casters) const;
  void update();
  void update_lights();
  void update_direct();
  void update_beams();
  [[nodiscard]] TriangleSoup world_soup(std::size_t set) const;
  [[nodiscard]] Volume make_volume(const Casters& casters, const optics::LightPlace& light) const;
  static void upload(Volume& volume);
  void count_direct(Counting& counting, std::size_t point, int bit);
  void count_beam(Counting& counting, const Beam& beam, int bit);
  /// What the count becomes: a bit is taken where it is not 0, or set there.
  enum class Fold { shade, light };
  void count(Counting& counting, const Volume& volume, int bit, Fold by);
  void draw_volume(Counting& counting, const Volume& volume, const ShadowVolume::Batch& batch);
  void fold(Counting& counting, int bit, Fold by);

  const Scene& scene_;
  bool levels_;
  SceneLights lights_;
  std::vector<ShadowPoint> points_;
  std::vector<Casters> sets_;  ///< surroundings, then every optic (empty for lenses)
  std::vector<std::vector<std::optional<Volume>>> direct_;  ///< by point, then by set
  std::vector<Beam> beams_;  ///< by entry of points_ after the points themselves
  std::vector<bool> stale_;  ///< sets whose volumes belong to another place
  bool lights_hold_ = false;
  RasterShadowTarget target_;
  GlBuffer gpu_points_;
  GlProgram volume_program_, fold_program_;
  GlVertexArray nothing_;
  ShadowStats statistics_;
};

}  // namespace catoptra::render
