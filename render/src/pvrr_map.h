// PVRR pass 1: the reflection map of one optic (paper 3.1, step 2; design 2.3 and 2.6).
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <vector>

#include "optics/virtual_view.h"
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

/// Optics that a map shows with maps of their own.
struct NestedOptics {
  std::vector<std::size_t> optics;
  /// Draws them into the map, which is bound, as the pass says.
  std::function<void(const RasterView& view, const RasterPass& pass, const RasterTarget& target)> draw;
};

class PvrrMap {
 public:
  /// Renews the textures where their size is not that of `size`.
  void resize(const PvrrMapSize& size, bool geometry);

  /// A small black map, for an optic of which no reflecting side is seen.
  void set_empty(bool geometry);

  /// Draws the surroundings as the virtual viewpoint sees them, with the other mirrors as diffuse bodies.
  /// What lies between viewpoint and `surface`, the last that the light meets (that is, behind the mirror, or
  /// on this side of the lens), is cut per fragment by its depth, unless the rays converge in front of it.
  /// `offset_px`: place of the samples within a texel; `nested`: may be null.
  void draw(RasterScene& scene, std::size_t optic, const RasterOptic& surface,
            const optics::VirtualView& view, glm::dvec2 offset_px, bool geometry,
            const NestedOptics* nested = nullptr);

  /// The view of the last draw(), with its depth of the optic (null where nothing is cut) for what is drawn
  /// on top.
  [[nodiscard]] const RasterView& view() const { return view_; }
  [[nodiscard]] const GlTexture* clip_depth() const { return clipped_ ? &optic_depth_ : nullptr; }

  [[nodiscard]] const RasterTarget& target() const { return *target_; }
  [[nodiscard]] const PvrrMapSize& size() const { return size_; }

 private:
  PvrrMapSize size_;
  std::unique_ptr<RasterTarget> target_;
  GlTexture optic_depth_;
  GlFramebuffer optic_depth_framebuffer_;
  RasterView view_;
  bool clipped_ = false;
};

}  // namespace catoptra::render
