// PVRR pass 1: the reflection maps of one optic, one per patch (paper 3.1, step 2; design 2.3 and 2.6).
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "optics/virtual_view.h"
#include "render/src/map_coverage.h"
#include "render/src/overlay_vertices.h"
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

/// Optics that a map shows with maps of their own.
struct NestedOptics {
  std::vector<std::size_t> optics;
  /// Draws them into the map, which is bound, as the pass says.
  std::function<void(const RasterView& view, const RasterPass& pass, const RasterTarget& target)> draw;
};

class PvrrMap {
 public:
  /// Renews the textures where their size is not that of the layout.
  void resize(const AtlasLayout& layout, bool geometry);

  /// From the next draw() on, outlines get so many samples a texel, as far as the driver has them.
  void set_multisample(int samples) { multisample_ = samples; }

  /// A small black map, for an optic of which no reflecting side is seen.
  void set_empty(bool geometry);

  /// Draws the surroundings as the virtual viewpoint sees them, with the other mirrors as diffuse bodies, and
  /// an `overlay` (or null).
  /// What lies between viewpoint and `surface`, the last that the light meets (that is, behind the mirror, or
  /// on this side of the lens), is cut per fragment by its depth.
  /// Where the rays converge in front of the optic the zooming region is drawn over the reversed one: light
  /// meets it first (design 2.10), and both have the same map coordinates. What lies behind the optic is cut
  /// by its depth; so is, beside the optic, the last tenth of the way back to it: there stands its own frame,
  /// which rays that leave near its border do not meet.
  /// `patch`: its place in the layout; `offset_px`: place of the samples within a texel; `nested`: may be
  /// null; in a zooming region these optics too are plain bodies. `unseen`: parts of the target in which
  /// nothing is drawn; their depth becomes 1, which nothing else has.
  void draw(RasterScene& scene, std::size_t optic, const RasterOptic& surface, std::size_t patch,
            const optics::VirtualView& view, double texels_per_pixel, glm::dvec2 offset_px, bool geometry,
            Overlay* overlay, const NestedOptics* nested = nullptr, std::span<const TexelRect> unseen = {});

  /// The views of the last draw() of each patch, in its place of the target, and those of zooming regions in
  /// which anything may be seen. Depths of both are in the target, see zooming_view().
  [[nodiscard]] std::vector<RasterView> views() const;

  [[nodiscard]] const RasterTarget& target() const { return *target_; }
  [[nodiscard]] const AtlasLayout& layout() const { return layout_; }

 private:
  struct PatchViews {
    RasterView view;
    std::optional<RasterView> zooming;
  };
  void bind_optic_depth() const;
  /// What the map of one patch shows, and with what on top.
  struct Regions {
    RasterScene& scene;
    const RasterOptic& surface;
    const PatchViews& views;
    bool beyond_viewpoint;
    double beside_mm;
    Overlay* overlay;
    const NestedOptics* nested;  ///< or null
    std::span<const TexelRect> unseen;
  };
  static void block(std::span<const TexelRect> unseen);
  void draw_regions(const Regions& regions, RasterPass pass, const RasterTarget& target) const;

  AtlasLayout layout_;
  std::unique_ptr<RasterTarget> target_, smooth_;  ///< the latter with several samples a texel, or null
  int multisample_ = 1;
  GlTexture optic_depth_;
  glm::ivec2 optic_depth_size_{0, 0};
  GlFramebuffer optic_depth_framebuffer_;
  std::vector<PatchViews> views_;  ///< by patch
};

}  // namespace catoptra::render
