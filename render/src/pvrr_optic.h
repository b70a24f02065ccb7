// One optic in mode pvrr: vertex rays, and for each of its patches virtual viewpoint and map, kept while
// nothing changes them (paper 5). All but the maps is in the optic's own frame, so that rays stay as they are
// where eye and optic move together.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "optics/lens_path.h"
#include "optics/passed_light.h"
#include "optics/vertex_hits.h"
#include "optics/view_regions.h"
#include "optics/virtual_view.h"
#include "render/frame.h"
#include "render/src/lens_rays.h"
#include "render/src/optic_bodies.h"
#include "render/src/overlay_vertices.h"
#include "render/src/patch_mesh.h"
#include "render/src/patch_tree.h"
#include "render/src/pvrr_atlas.h"
#include "render/src/pvrr_map.h"
#include "render/src/pvrr_refinement.h"
#include "render/src/raster_lens.h"
#include "render/src/raster_scene.h"
#include "render/src/stack_optic.h"

namespace catoptra::render {

/// Where an optic stands in the tree of maps (pvrr_stack.h).
struct OpticPlace {
  const OpticBodies* bodies = nullptr;  ///< what rays meet of the other optics; null where there are none
  bool shows_lenses = false;            ///< the map shows the other lenses, which rays then meet
  bool nested = false;                  ///< seen in another one's map: it is one patch then
};

/// What the maps are for. In a picture the optic's mesh shows them, with all that patches and refinement of
/// the mesh are for. Exact rays find in a map what they meet wherever it shows that: patches are cut where a
/// map would be too wide alone, and what no ray can ask for is not drawn (see unseen_parts()).
enum class MapUse { picture, exact_rays };

class PvrrOptic final : public StackOptic, public LightWay {
 public:
  /// Keeps the references; `bounds`: of everything in the scene, in the world.
  PvrrOptic(const Scene& scene, std::size_t optic, RasterScene& raster, const optics::RayScene& rays,
            const cad_import::BoundingBox& bounds, const OpticPlace& place = {});

  /// The optic itself has changed; or something else that its map shows; or the bounds of everything.
  void optic_changed() override;
  void map_changed() override { drawn_.reset(); }
  void set_bounds(const cad_import::BoundingBox& bounds) override;
  /// The optic is somewhere else. Its rays stay if the eye comes along.
  void place(const optics::Placement& placement) override;
  /// Other optics have changed or moved, and rays may meet them.
  void others_changed() override { hits_hold_ = false; }

  /// Steps 1 to 3 of the paper's 3.1, as far as eye, camera or optic have changed: rays of the vertices where
  /// the eye has another place as the optic sees it; their hits where either has another place in the world,
  /// and with them patches, viewpoints, map coordinates, and the sizes of the maps. `camera`: in the world,
  /// without sample offset. `texels_before`: texels per pixel of the map that the camera is of, 1 for the
  /// picture. `above`: how light comes here where the camera is that of another optic's map and its rays
  /// come from no one point; null: from the camera's eye. It must outlive this.
  void update(const RasterView& camera, const FrameOptions& options, double texels_before = 1,
              const LightWay* above = nullptr, MapUse use = MapUse::picture);

  /// How light comes from the eye through this optic to a point beyond it, both in the world; nullopt where
  /// it does not.
  [[nodiscard]] std::optional<optics::Arrival> light_to(const glm::dvec3& point_mm) const override;
  [[nodiscard]] std::size_t changes() const override { return traces_; }
  [[nodiscard]] const LightWay* light(std::size_t) const override { return this; }

  /// Pass 1, unless the maps are there already; returns whether they were drawn. An `overlay` (or null) is
  /// drawn into them, and before that the optics that each shows by their own maps (`nested`: per patch, or
  /// empty).
  bool draw_map(glm::dvec2 offset_px, bool geometry, Overlay* overlay,
                std::span<const NestedOptics> nested = {});

  /// The views of the patches' maps in the world, with their guard (after update(), of an optic that faces
  /// the eye), without sample offset; and the offset of their samples within their texels.
  [[nodiscard]] std::size_t patch_count() const override { return views_.size(); }
  [[nodiscard]] bool has_map(std::size_t) const override { return faces_eye_; }
  [[nodiscard]] RasterView map_camera(std::size_t patch) const override;
  [[nodiscard]] double texels_per_pixel(std::size_t patch) const override {
    return map_sizes_[patch].texels_per_pixel;
  }
  [[nodiscard]] glm::dvec2 map_offset(glm::dvec2 offset_px) const override;

  /// For the program in use: the map of pass 2 of `patch` (part of seen_surface()), with the map rays that
  /// geometry needs.
  void set_map(std::size_t patch, glm::dvec2 offset_px, bool geometry) const;

  [[nodiscard]] std::size_t index() const { return index_; }
  [[nodiscard]] const PvrrMap& map() const { return map_; }
  [[nodiscard]] bool faces_eye() const override { return faces_eye_; }
  /// Per vertex of the mesh drawn, in the optic's frame; of a lens at the reference wavelength.
  [[nodiscard]] std::span<const optics::VertexHit> hits() const;
  /// Of the map in which hit number `hit` has its place; the view in the optic's frame.
  [[nodiscard]] const optics::VirtualView& view(std::size_t hit) const { return views_[patch_of(hit)]; }
  [[nodiscard]] const PvrrMapSize& map_size(std::size_t hit) const { return map_sizes_[patch_of(hit)]; }
  [[nodiscard]] const optics::Placement& placement() const { return placement_; }
  /// The mesh that the eye sees: a mirror's, or that of the side at which a lens is entered.
  [[nodiscard]] const RasterOptic& seen_surface() const;
  [[nodiscard]] const RasterLens& lens() const { return lens_; }
  /// From the middle of each patch to its viewpoint, in the world; a parallel map has none, and the line no
  /// length.
  [[nodiscard]] std::vector<OverlayLine> viewpoint_lines() const;
  /// What the last update() has cost and found.
  [[nodiscard]] OpticStats statistics() const override;
  [[nodiscard]] std::size_t map_texels() const override {
    const glm::ivec2 texels = map_.layout().texels;
    return std::size_t(texels.x) * std::size_t(texels.y);
  }
  /// What the vertices see that no single viewpoint can show, or shows roughly; over all patches.
  [[nodiscard]] optics::ViewRegions regions() const;
  /// Where the last refinement ended at its limit.
  [[nodiscard]] std::optional<std::string> warning() const;

 private:
  [[nodiscard]] bool rays_hold(const glm::dvec3& eye_mm) const;
  [[nodiscard]] optics::Arrival arrival_at(const glm::dvec3& own_point_mm) const;
  void trace(const glm::dvec3& eye_mm);
  void find_hits();
  [[nodiscard]] std::vector<optics::VertexHit> with_hits(std::vector<optics::VertexHit> rays) const;
  void fit(const RasterView& camera, bool hits_anew, bool remember);
  [[nodiscard]] bool choose_patches(const RasterView& camera, bool remember);
  void set_patches(PatchLabels labels);
  void fit_patches();
  void set_coordinates();
  void set_surface();
  void set_map_sizes(const RasterView& camera);
  void refine(const RasterView& camera, bool remember);
  void refine_lens(bool remember);
  [[nodiscard]] std::vector<std::vector<optics::VertexHit>> further_wavelengths(
      const tessellate::OpticArrays& mesh, std::size_t first);
  void show();
  [[nodiscard]] std::vector<TexelRect> unseen_in(std::size_t patch) const;
  [[nodiscard]] std::vector<std::vector<glm::dvec3>> lens_coordinates() const;
  void set_layout(std::vector<PvrrMapSize> sizes);
  [[nodiscard]] bool in_patches() const { return !patches_.ranges.empty(); }
  [[nodiscard]] const tessellate::OpticArrays& tessellated_mesh() const;
  [[nodiscard]] const tessellate::OpticArrays& cut_mesh() const;
  [[nodiscard]] const tessellate::OpticArrays& seen_mesh() const;
  [[nodiscard]] std::span<const std::uint32_t> patches_of_seen() const;
  [[nodiscard]] std::uint32_t patch_of(std::size_t vertex) const;
  [[nodiscard]] const LensRays& shown_rays() const;

  const Scene& scene_;
  const optics::Optic& optic_;
  std::size_t index_;
  RasterScene& raster_;
  const optics::RayScene& rays_;
  cad_import::BoundingBox bounds_;
  OpticPlace place_;

  optics::Placement placement_;

  std::optional<glm::dvec3> traced_from_;  ///< the eye, in the optic's frame, that what follows belongs to
  const LightWay* above_ = nullptr;
  std::size_t traced_above_ = 0;  ///< how often the rays of the optic above had been traced
  std::size_t traces_ = 0;
  std::optional<optics::PassedLight> light_;
  std::vector<optics::VertexHit> mirror_rays_;
  std::unique_ptr<optics::LensTracer> tracer_;
  LensRays lens_paths_;
  std::size_t ray_count_ = 0;
  bool faces_eye_ = false;

  bool hits_hold_ = false;                     ///< what follows belongs to those rays at this placement
  std::vector<optics::VertexHit> whole_hits_;  ///< of the mesh as tessellated
  LensRays whole_lens_rays_;

  PatchTree tree_;
  optics::LensSide cut_side_ = optics::LensSide::front;  ///< of a lens, that the patches belong to
  PatchLabels labels_;
  PatchMesh patches_;                           ///< empty where the optic is one patch
  std::vector<optics::VertexHit> mirror_hits_;  ///< of the mesh cut into patches
  LensRays lens_rays_;
  std::vector<optics::VirtualView> fitted_;  ///< per patch

  // Of the mesh cut into patches where nothing is refined, else of that of refinement_.
  PvrrRefinement refinement_;
  bool refined_ = false;
  std::unique_ptr<RasterOptic> own_surface_;  ///< null where the scene's own is drawn
  std::size_t vertex_count_ = 0;              ///< of the mesh drawn, those that patches share counted once
  std::optional<glm::dvec3> refined_from_;    ///< the eye that refined_paths_ belong to
  /// Of a lens, at all wavelengths but the reference, of the vertices that refinement has added.
  std::vector<std::vector<optics::VertexHit>> refined_paths_;
  LensRays refined_rays_;  ///< of all vertices, with what they meet

  std::optional<RasterView> fitted_for_;  ///< the camera, in the optic's frame, that what follows belongs to
  double texels_before_ = 1;
  std::vector<optics::VirtualView> views_;   ///< per patch
  bool on_pixel_grid_ = false;               ///< the view is that of plane_view()
  std::vector<glm::dvec3> cut_coordinates_;  ///< of the mesh cut into patches, in fitted_ or the plane's view
  std::vector<glm::dvec3> coordinates_;      ///< of a lens at the reference wavelength
  std::vector<PvrrMapSize> map_sizes_;       ///< per patch
  AtlasLayout layout_;
  RasterLens lens_;

  struct Drawn {
    glm::dvec2 offset_px;
    bool geometry;
    int multisample;
    MapUse use;
    bool operator==(const Drawn&) const = default;
  };
  std::optional<Drawn> drawn_;  ///< what the maps hold
  PvrrMap map_;
  int multisample_ = 1;
  MapUse use_ = MapUse::picture;
  std::size_t traced_rays_ = 0, scene_rays_ = 0, refinement_rays_ = 0;
};

}  // namespace catoptra::render
