// Lenses in the reference: exact paths of a packet's rays through them, one wavelength at a time.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <vector>

#include "optics/lens_path.h"
#include "optics/ray_scene.h"
#include "optics/spectrum.h"
#include "render/scene.h"
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
  BeamLanes beams;  ///< from the exact points of exit on
  float transmittance[kLanes];
  ShadeLanes shade;
};

/// The lenses of a scene. A lens is met at the side that is towards the eye, nearest lens first; behind it
/// there are no lenses.
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

  /// Wavelengths of the lens in `lanes` that has most of them; 0: no lens.
  [[nodiscard]] std::size_t sample_count(const LensLanes& lanes) const;

  /// Wavelengths of optic `index`, a lens.
  [[nodiscard]] std::size_t sample_count_of(std::size_t index) const {
    return by_optic_[index]->samples.size();
  }

  /// The rays behind the lenses at wavelength number `sample`; 0 is the one that geometry belongs to.
  void refract(const LensLanes& lanes, std::size_t sample, RefractedLanes& out) const;

  /// Adds to `lanes.radiance` what the shaded rays of wavelength number `sample` show.
  void add_colors(std::size_t sample, const RefractedLanes& out, LensLanes& lanes) const;

 private:
  struct Lens {
    std::size_t optic;  ///< index in Scene::optics
    optics::LensTracer tracer;
    std::vector<optics::SpectralSample> samples;
    std::vector<optics::LensIndices> indices;  ///< by sample
    optics::RayScene front, back;              ///< each side's mesh, for finding entries and exits
    // Fitted when a picture first asks: other modes do without.
    std::once_flag fitted;
    std::unique_ptr<LensSidePatches> front_patches, back_patches;

    Lens(std::size_t index, const optics::Optic& lens);
    void fit_patches(const optics::Optic& lens);
    [[nodiscard]] const optics::RayScene& scene(optics::LensSide side) const;
    [[nodiscard]] const LensSidePatches& patches(optics::LensSide side) const;
  };
  void meet_exits(const Lens& lens, const LensLanes& lanes, std::size_t sample, const RefractedBeams& inside,
                  MetLanes& exit, bool (&met)[LensLanes::kLanes]) const;

  const Scene& scene_;
  std::vector<std::unique_ptr<Lens>> lenses_;
  std::vector<const Lens*> by_optic_;  ///< null: a mirror
};

}  // namespace catoptra::render
