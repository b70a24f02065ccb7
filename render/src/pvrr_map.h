// PVRR pass 1: the reflection maps of one optic, one per patch (paper 3.1, step 2; design 2.3 and 2.6).
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <span>

#include "optics/virtual_view.h"
#include "render/src/pvrr_atlas.h"
#include "render/src/raster_scene.h"
#include "render/src/raster_target.h"

namespace catoptra::render {

/// How large a map has to be for a picture.
struct PvrrMapSize {
  glm::ivec2 texels{16, 16};
  double texels_per_pixel = 1;  ///< what comes of it, at the mean over the optic
};

/// Chooses the map's size so that, by area over the part of the optic on the screen, `texels_per_pixel`
/// squared texels fall on a pixel; square texels on the map's projection plane, 16 .. 4096 a side. `pixels`:
/// the mesh's vertices in pixel coordinates (z <= 0: behind the eye, or not to be counted); `coordinates`:
/// their map coordinates.
[[nodiscard]] PvrrMapSize choose_map_size(const tessellate::OpticArrays& mesh,
                                          std::span<const glm::dvec3> pixels,
                                          std::span<const glm::dvec3> coordinates,
                                          const optics::VirtualView& view, glm::ivec2 picture,
                                          double texels_per_pixel);

/// The same for a mirror.
[[nodiscard]] inline PvrrMapSize choose_map_size(const optics::Optic& mirror,
                                                 std::span<const glm::dvec3> pixels,
                                                 std::span<const glm::dvec3> coordinates,
                                                 const optics::VirtualView& view, glm::ivec2 picture,
                                                 double texels_per_pixel) {
  return choose_map_size(mirror.mesh, pixels, coordinates, view, picture, texels_per_pixel);
}

class PvrrMap {
 public:
  /// Renews the textures where their size is not that of the layout.
  void resize(const AtlasLayout& layout, bool geometry);

  /// A small black map, for an optic of which no reflecting side is seen.
  void set_empty(bool geometry);

  /// Draws the surroundings as the virtual viewpoint sees them, with the other mirrors as diffuse bodies.
  /// What lies between viewpoint and `surface`, the last that the light meets (that is, behind the mirror, or
  /// on this side of the lens), is cut per fragment by its depth, unless the rays converge in front of it.
  /// `patch`: its place in the layout; `offset_px`: place of the samples within a texel.
  void draw(RasterScene& scene, std::size_t optic, const RasterOptic& surface, std::size_t patch,
            const optics::VirtualView& view, double texels_per_pixel, glm::dvec2 offset_px, bool geometry);

  /// The view of the last draw(), in its place of the target, with its depth of the optic (null where nothing
  /// is cut) for what is drawn on top.
  [[nodiscard]] const RasterView& view() const { return view_; }
  [[nodiscard]] const GlTexture* clip_depth() const { return clipped_ ? &optic_depth_ : nullptr; }

  [[nodiscard]] const RasterTarget& target() const { return *target_; }
  [[nodiscard]] const AtlasLayout& layout() const { return layout_; }

 private:
  AtlasLayout layout_;
  std::unique_ptr<RasterTarget> target_;
  GlTexture optic_depth_;
  glm::ivec2 optic_depth_size_{0, 0};
  GlFramebuffer optic_depth_framebuffer_;
  RasterView view_;
  bool clipped_ = false;
};

}  // namespace catoptra::render
