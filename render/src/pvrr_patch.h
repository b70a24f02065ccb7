// One optic in mode pvrr: vertex rays, virtual viewpoint and map, kept while nothing changes them (paper 5).
// All but the map is in the optic's own frame, so that rays stay as they are where eye and optic move
// together.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "optics/lens_path.h"
#include "optics/passed_light.h"
#include "optics/vertex_hits.h"
#include "optics/virtual_view.h"
#include "render/frame.h"
#include "render/src/lens_rays.h"
#include "render/src/optic_bodies.h"
#include "render/src/overlay_vertices.h"
#include "render/src/pvrr_map.h"
#include "render/src/pvrr_refinement.h"
#include "render/src/raster_lens.h"
#include "render/src/raster_scene.h"

namespace catoptra::render {

/// Where a patch stands in the tree of maps (pvrr_stack.h).
struct PatchPlace {
  const OpticBodies* bodies = nullptr;  ///< what rays meet of the other optics; null where there are none
  bool shows_lenses = false;            ///< the map shows the other lenses, which rays then meet
  bool nested = false;                  ///< the optic is seen in another one's map
};

class PvrrPatch {
 public:
  /// Keeps the references; `bounds`: of everything in the scene, in the world.
  PvrrPatch(const Scene& scene, std::size_t optic, RasterScene& raster, const optics::RayScene& rays,
            const cad_import::BoundingBox& bounds, const PatchPlace& place = {});

  /// The optic itself has changed; or something else that its map shows; or the bounds of everything.
  void optic_changed();
  void map_changed() { drawn_.reset(); }
  void set_bounds(const cad_import::BoundingBox& bounds);
  /// The optic is somewhere else. Its rays stay if the eye comes along.
  void place(const optics::Placement& placement);
  /// Other optics have changed or moved, and rays may meet them.
  void others_changed() { hits_hold_ = false; }

  /// Steps 1 to 3 of the paper's 3.1, as far as eye, camera or optic have changed: rays of the vertices where
  /// the eye has another place as the optic sees it; their hits where either has another place in the world,
  /// and with them viewpoint, map coordinates, and the size of the map. `camera`: in the world, without
  /// sample offset. `texels_before`: texels per pixel of the map that the camera is of, 1 for the picture.
  /// `above`: the optic in whose map the camera sees this one, by way of which light comes here; null: none.
  /// It must outlive this, and its own update() must have been called.
  void update(const RasterView& camera, const FrameOptions& options, double texels_before = 1,
              const PvrrPatch* above = nullptr);

  /// How light comes from the eye through this optic to a point beyond it, both in the world; nullopt where
  /// it does not.
  [[nodiscard]] std::optional<optics::Arrival> light_to(const glm::dvec3& point_mm) const;

  /// Pass 1, unless the map is there already; returns whether it was drawn. An `overlay` (or null) is drawn
  /// into it, and before that the optics that it shows by their own maps.
  bool draw_map(glm::dvec2 offset_px, bool geometry, Overlay* overlay, const NestedOptics* nested = nullptr);

  /// The map's view in the world (after update()), without sample offset; and the offset of its samples
  /// within its texels.
  [[nodiscard]] RasterView map_camera() const;
  [[nodiscard]] glm::dvec2 map_offset(glm::dvec2 offset_px) const;

  /// For the program in use: the map of pass 2, with the map rays that geometry needs.
  void set_map(glm::dvec2 offset_px, bool geometry) const;

  [[nodiscard]] bool faces_eye() const { return faces_eye_; }
  /// Per vertex of the mesh drawn, in the optic's frame; of a lens at the reference wavelength.
  [[nodiscard]] std::span<const optics::VertexHit> hits() const;
  /// In the optic's frame.
  [[nodiscard]] const optics::VirtualView& view() const { return view_; }
  [[nodiscard]] const optics::Placement& placement() const { return placement_; }
  [[nodiscard]] const PvrrMap& map() const { return map_; }
  /// The mesh that the eye sees: a mirror's, or that of the side at which a lens is entered.
  [[nodiscard]] const RasterOptic& seen_surface() const;
  [[nodiscard]] const RasterLens& lens() const { return lens_; }
  /// What the last update() has cost and found.
  [[nodiscard]] OpticStats statistics() const;
  /// Where the last refinement ended at its limit.
  [[nodiscard]] std::optional<std::string> warning() const;

 private:
  [[nodiscard]] bool rays_hold(const glm::dvec3& eye_mm) const;
  [[nodiscard]] optics::Arrival arrival_at(const glm::dvec3& own_point_mm) const;
  [[nodiscard]] std::vector<optics::Arrival> arrivals(const tessellate::OpticArrays& mesh) const;
  void trace(const glm::dvec3& eye_mm);
  void find_hits();
  [[nodiscard]] std::vector<optics::VertexHit> with_hits(std::vector<optics::VertexHit> rays) const;
  void fit(const RasterView& camera, bool hits_anew, bool remember);
  void set_coordinates();
  void refine(const RasterView& camera, bool remember);
  void refine_lens(bool remember);
  void show();
  [[nodiscard]] std::vector<std::vector<glm::dvec3>> lens_coordinates() const;
  void set_map_size(const PvrrMapSize& size);
  [[nodiscard]] const tessellate::OpticArrays& seen_mesh() const;
  [[nodiscard]] const LensRays& shown_rays() const;
  [[nodiscard]] RasterOptic& mirror_surface() const;

  const Scene& scene_;
  const optics::Optic& optic_;
  std::size_t index_;
  RasterScene& raster_;
  const optics::RayScene& rays_;
  cad_import::BoundingBox bounds_;
  PatchPlace place_;
  std::unique_ptr<RasterOptic> own_surface_;  ///< of a nested mirror, with its own map coordinates

  optics::Placement placement_;

  std::optional<glm::dvec3> traced_from_;  ///< the eye, in the optic's frame, that what follows belongs to
  const PvrrPatch* above_ = nullptr;
  std::size_t traced_above_ = 0;  ///< how often the rays of the optic above had been traced
  std::size_t traces_ = 0;
  std::optional<optics::PassedLight> light_;
  std::vector<optics::VertexHit> mirror_rays_;
  std::unique_ptr<optics::LensTracer> tracer_;
  LensRays lens_paths_;
  std::size_t ray_count_ = 0;
  bool faces_eye_ = false;

  bool hits_hold_ = false;  ///< what follows belongs to those rays at this placement
  std::vector<optics::VertexHit> mirror_hits_;
  LensRays lens_rays_;
  optics::VirtualView fitted_;

  // Of the mesh as tessellated where nothing is refined, else of that of refinement_.
  PvrrRefinement refinement_;
  std::unique_ptr<RasterOptic> refined_surface_;  ///< null where nothing is refined
  optics::Optic refined_lens_;                    ///< the lens with the refined mesh
  std::optional<glm::dvec3> refined_from_;        ///< the eye that refined_paths_ belong to
  LensRays refined_paths_, refined_rays_;         ///< without and with what they meet

  std::optional<RasterView> fitted_for_;  ///< the camera, in the optic's frame, that what follows belongs to
  double texels_before_ = 1;
  optics::VirtualView view_;
  bool on_pixel_grid_ = false;  ///< the view is that of plane_view()
  std::vector<glm::dvec3>
      tessellated_coordinates_;          ///< of the mesh as tessellated, in fitted_ or the plane's view
  std::vector<glm::dvec3> coordinates_;  ///< of a lens at the reference wavelength
  PvrrMapSize map_size_;
  RasterLens lens_;

  struct Drawn {
    glm::dvec2 offset_px;
    bool geometry;
  };
  std::optional<Drawn> drawn_;  ///< what the map holds
  PvrrMap map_;
  std::size_t traced_rays_ = 0, scene_rays_ = 0, refinement_rays_ = 0;
};

}  // namespace catoptra::render
