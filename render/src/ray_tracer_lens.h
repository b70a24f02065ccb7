// Lenses in the reference: exact paths of a packet's rays through them, one wavelength at a time.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <vector>

#include "cad_import/cad_model.h"
#include "optics/lens_path.h"
#include "optics/ray_scene.h"
#include "optics/spectrum.h"
#include "render/scene.h"
#include "render/src/ray_tracer_chain_lanes.h"
#include "render/src/ray_tracer_lens_side.h"
#include "render/src/sampling.h"
#include "render/src/shading.h"

namespace catoptra::render {

/// The lanes of a packet that show lenses.
struct LensLanes {
  static constexpr int kLanes = ShadeLanes::kLanes;
  bool any = false;
  int optic[kLanes];  ///< index in Scene::optics; -1: no lens; the others are set where there is one
  optics::LensSide entered[kLanes];
  // Hit on the mesh of the side entered: depth along the camera's axis, triangle, weights of its vertices.
  float depth[kLanes], u[kLanes], v[kLanes];
  std::uint32_t triangle[kLanes];
  BeamLanes eye;            ///< the pixels' beams from the eye
  MetLanes entry;           ///< the exact points of entry, the same at all wavelengths
  Float4 radiance[kLanes];  ///< sum over the wavelengths so far
};

/// What becomes of the lanes at one wavelength.
struct RefractedLanes {
  static constexpr int kLanes = LensLanes::kLanes;
  optics::RayPacket16 rays;  ///< active where the light passes; unit directions
  bool passed[kLanes];
  MetLanes exit;
  BeamLanes beams;  ///< from the exact points of exit on
  float transmittance[kLanes];
  ShadeLanes shade;
};

/// The lenses of a scene. From the eye a lens is met at the side that is towards the eye, nearest lens first;
/// rays that come from other optics may meet either side.
class TracedLenses {
 public:
  /// Keeps a reference to `scene`, which must outlive it. Throws catoptra::Error where a lens lacks a side.
  explicit TracedLenses(const Scene& scene);

  void optic_changed(std::size_t index);

  /// The side of each lens that is towards the eye; one entry per lens. Fits the patches of lenses that have
  /// changed.
  [[nodiscard]] std::vector<optics::LensSide> entered_from(const glm::dvec3& eye_mm) const;

  /// Finds the lanes of `first` before whose hits a lens stands, and takes those hits away. `entered`: from
  /// entered_from().
  void find(const std::vector<optics::LensSide>& entered, optics::RayPacket16& first, LensLanes& lanes) const;

  /// Exact points of entry of the rays through pixel coordinates (column, row).
  void enter(const CameraRays& camera, const double (&column)[LensLanes::kLanes],
             const double (&row)[LensLanes::kLanes], LensLanes& lanes) const;

  /// The same for beams on their way: `lanes` with its optics, sides, triangles and `eye` (the beams) set;
  /// the mesh's hits at `distance`, mm.
  void meet_entries(const double (&distance)[LensLanes::kLanes], LensLanes& lanes) const;

  /// The lenses that rays which have left `left` meet before the t_max of `rays`: sets those lanes of `met`.
  /// Returns whether there are any. Lanes of `met` that are set already count as hits at their distance.
  bool find_next(const optics::RayPacket16& rays, const LeftOptics& left, MetOptics& met) const;

  /// Whether a ray that leaves a lens there may meet the same side again.
  [[nodiscard]] bool sees_own(std::size_t index, optics::LensSide left, double cosine) const {
    return std::abs(cosine) < by_optic_[index]->own_sine[std::size_t(left)];
  }
  /// Whether rays that have left an optic may meet a lens.
  [[nodiscard]] bool possible_next() const;

  /// Wavelengths of the lens in `lanes` that has most of them; 0: no lens.
  [[nodiscard]] std::size_t sample_count(const LensLanes& lanes) const;

  /// Wavelengths of optic `index`, a lens.
  [[nodiscard]] std::size_t sample_count_of(std::size_t index) const {
    return by_optic_[index]->samples.size();
  }

  /// Where all lenses' wavelengths have numbers: that of wavelength `sample` of optic `index`; -1 where the
  /// lens has but one, which stands for all.
  [[nodiscard]] int wavelength(std::size_t index, std::size_t sample) const;
  /// What wavelength `sample` of optic `index` contributes to a colour; the identity where it has but one.
  [[nodiscard]] glm::mat3 weight(std::size_t index, std::size_t sample) const;
  /// Indices of optic `index` at its wavelength number `sample`; null where it has no such.
  [[nodiscard]] const optics::LensIndices* indices(std::size_t index, std::size_t sample) const;
  /// The same for light of a wavelength from the table; a lens with but one keeps it.
  [[nodiscard]] const optics::LensIndices* indices_at(std::size_t index, int wavelength) const;

  /// The rays behind the lenses at wavelength number `sample`; 0 is the one that geometry belongs to.
  void refract(const LensLanes& lanes, std::size_t sample, RefractedLanes& out) const;
  /// The same with indices by lane; null: the lane is left out.
  using IndexLanes = const optics::LensIndices * [LensLanes::kLanes];
  void refract(const LensLanes& lanes, const IndexLanes& indices, RefractedLanes& out) const;

  /// Adds to `lanes.radiance` what the shaded rays of wavelength number `sample` show.
  void add_colors(std::size_t sample, const RefractedLanes& out, LensLanes& lanes) const;

 private:
  struct Lens {
    std::size_t optic;  ///< index in Scene::optics
    optics::LensTracer tracer;
    std::vector<optics::SpectralSample> samples;
    std::vector<optics::LensIndices> indices;     ///< by sample
    std::vector<optics::LensIndices> indices_at;  ///< by number in the table of wavelengths
    std::vector<int> wavelengths;                 ///< numbers of the samples
    optics::RayScene front, back;                 ///< each side's mesh, for finding entries and exits
    cad_import::BoundingBox box;
    double own_sine[2];  ///< by side: own_sight_sine()
    // Fitted when a picture first asks: other modes do without.
    std::once_flag fitted;
    std::unique_ptr<LensSidePatches> front_patches, back_patches;

    Lens(std::size_t index, const optics::Optic& lens);
    void fit_patches(const optics::Optic& lens);
    [[nodiscard]] const optics::RayScene& scene(optics::LensSide side) const;
    [[nodiscard]] const LensSidePatches& patches(optics::LensSide side) const;
  };
  void meet_exits(const Lens& lens, optics::LensSide entered, const LensLanes& lanes,
                  const IndexLanes& indices, const RefractedBeams& inside, MetLanes& exit,
                  bool (&met)[LensLanes::kLanes]) const;
  void number_wavelengths();
  static bool find_side(const Lens& lens, optics::LensSide side, const optics::RayPacket16& rays,
                        const bool (&asked)[LensLanes::kLanes], MetOptics& met);

  const Scene& scene_;
  std::vector<std::unique_ptr<Lens>> lenses_;
  std::vector<const Lens*> by_optic_;   ///< null: a mirror
  std::vector<double> wavelengths_nm_;  ///< of all lenses, each once
};

}  // namespace catoptra::render
