// Optics in optics: exact paths from one optic to the next, as far as RenderSettings::depth goes.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "optics/ray_scene.h"
#include "render/scene.h"
#include "render/src/ray_tracer_chain_lanes.h"
#include "render/src/ray_tracer_lens.h"
#include "render/src/ray_tracer_planar.h"
#include "render/src/shading.h"

namespace catoptra::render {

/// Follows rays that have left an optic. A path goes on where it meets the reflecting side of a mirror,
/// either side of a lens or planar glass, the optic that it has just left included, until
/// RenderSettings::depth optics lie along it; at planar glass it goes on both ways. After that a mirror is a
/// plain body of its reflectance, lenses and planar glass are absent, and the optic that was left last does
/// not hide anything: what a scene of depth 1 shows in its optics. The dark side of a mirror is a plain body
/// always, but an optic's own does not hide what it shows. Light splits into wavelengths at the first lens
/// along the path that has several.
class TracedChains {
 public:
  static constexpr int kLanes = LeftOptics::kLanes;

  /// Keeps references to all five, which must outlive it.
  TracedChains(const Scene& scene, const optics::RayScene& rays, const ShadingScene& shading,
               const TracedLenses& lenses, const TracedPlanars& planars);

  void optic_changed(std::size_t index);

  /// Whether any path can have two optics, as far as is known without tracing.
  [[nodiscard]] bool possible() const { return possible_; }
  /// Greatest number of optics along a path.
  [[nodiscard]] int depth() const { return scene_.settings.depth; }

  /// Whether a ray that leaves mirror `index` at that cosine to its normal may meet it again.
  [[nodiscard]] bool sees_own(std::size_t index, double cosine) const {
    return std::abs(cosine) < own_sine_[index];
  }

  /// The optics that rays meet which have left `left`. `hits`: nearest hits of query_past_own().
  bool find_next(const optics::RayPacket16& hits, const LeftOptics& left, MetOptics& met) const;

  /// Meets mirrors where `met` says (lanes of lenses are left out). `beams` start before them.
  void meet_mirrors(const BeamLanes& beams, const MetOptics& met, MetLanes& at) const;

  /// Follows the lanes of `from` that meet an optic, `depth` of them at most (1 or more): writes their
  /// radiance, and `ends` where given; other lanes stay. Returns the number of
  /// rays.
  std::size_t follow(const ChainLanes& from, const MetOptics& met, int depth, Float4 (&radiance)[kLanes],
                     ChainEnds* ends) const;

 private:
  std::size_t reflect(const ChainLanes& from, const MetOptics& met, int depth, Float4 (&radiance)[kLanes],
                      ChainEnds* ends) const;
  std::size_t refract(const ChainLanes& from, const MetOptics& met, int depth, Float4 (&radiance)[kLanes],
                      ChainEnds* ends) const;
  std::size_t pass_glass(const ChainLanes& from, const MetOptics& met, int depth, Float4 (&radiance)[kLanes],
                         ChainEnds* ends) const;
  void add_surfaces(const ChainLanes& from, const MetOptics& met, Float4 (&radiance)[kLanes]) const;
  std::size_t refract_pass(const ChainLanes& from, const LensLanes& lanes, std::size_t pass, int depth,
                           Float4 (&radiance)[kLanes], ChainEnds* ends) const;
  std::size_t leave(ChainLanes& to, int depth, Float4 (&seen)[kLanes], ChainEnds* ends) const;
  void shade(const ChainLanes& lanes, Float4 (&seen)[kLanes]) const;

  /// A mirror's patches, fitted when a path first meets it so.
  struct Mirror {
    std::once_flag fitted;
    std::unique_ptr<LensSidePatches> patches;
  };

  const Scene& scene_;
  const optics::RayScene& rays_;
  const ShadingScene& shading_;
  const TracedLenses& lenses_;
  const TracedPlanars& planars_;
  std::vector<std::unique_ptr<Mirror>> mirrors_;  ///< by optic; null: no mirror
  std::vector<double> own_sine_;                  ///< by optic, of mirrors
  bool possible_ = false;
};

}  // namespace catoptra::render
