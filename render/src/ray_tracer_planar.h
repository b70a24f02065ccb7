// Planar optics in the reference: where rays meet refractors and panes, how both branches go on, and the tilt
// of rough faces (docs/decisions/0015-planar-optics-and-light.md).
#pragma once

#include <cstddef>
#include <vector>

#include "optics/planar_glass.h"
#include "optics/ray_scene.h"
#include "render/scene.h"
#include "render/src/ray_tracer_chain_lanes.h"

namespace catoptra::render {

/// The light that passes glass.
struct PassedBeams {
  static constexpr int kLanes = LaneVectors::kLanes;
  BeamLanes beams;           ///< where `reflected` is below 1: from points in the face's plane on
  double reflected[kLanes];  ///< share, of unpolarised light; 1: none passes
};

/// The planar optics of a scene. Glass is no part of the shared ray scene: where RenderSettings::depth is
/// exhausted it is absent, as lenses are.
class TracedPlanars {
 public:
  static constexpr int kLanes = LaneVectors::kLanes;

  /// Keeps a reference to `scene`, which must outlive it.
  explicit TracedPlanars(const Scene& scene);

  void optic_changed(std::size_t index);

  /// Whether there is glass, and whether there are optics whose lit surface is part of what they show.
  [[nodiscard]] bool any_glass() const { return !glass_.empty(); }
  [[nodiscard]] bool any_surface() const { return any_surface_; }

  /// Whether optic `index` does more than a bare mirror, so that what it shows is a chain from the eye on.
  [[nodiscard]] bool is_special(std::size_t index) const { return special_[index] != 0; }
  [[nodiscard]] bool any_special() const { return any_special_; }

  /// The glass that rays meet before the t_max of `rays`, and before what lanes of `met` name already: sets
  /// those lanes. Faces that rays have just left, and one-sided ones from behind, are not there. Returns
  /// whether any lane was set.
  bool find_next(const optics::RayPacket16& rays, const LeftOptics& left, MetOptics& met) const;

  /// Meets the planes of the planar optics named; other lanes of `at` stay.
  void meet(const BeamLanes& beams, const int (&optic)[kLanes], MetLanes& at) const;

  /// The same for reflection in sample `sample` of a picture, where rough faces are tilted about their
  /// centres. A tilt that would turn the face's other side to the ray is left out.
  void meet_tilted(const BeamLanes& beams, const int (&optic)[kLanes], int sample, MetLanes& at) const;

  /// What passes the glass of the lanes named, which `beams` meet at `at`.
  void pass(const BeamLanes& beams, const MetLanes& at, const int (&optic)[kLanes], PassedBeams& out) const;

 private:
  const Scene& scene_;
  std::vector<optics::PlanarFace> faces_;  ///< by optic; of no use where it is not planar
  std::vector<std::uint8_t> special_;      ///< by optic
  std::vector<std::size_t> glass_;         ///< optics, by object number in `rays_`
  optics::RayScene rays_;                  ///< the meshes of the glass
  bool any_special_ = false, any_surface_ = false;
};

}  // namespace catoptra::render
