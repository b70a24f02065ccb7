// Lenses in the reference: exact paths of a packet's rays through them, one wavelength at a time.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "optics/lens_path.h"
#include "optics/ray_scene.h"
#include "optics/spectrum.h"
#include "optics/vertex_hits.h"
#include "render/scene.h"
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
  tessellate::OpticVertex entry[kLanes];                     ///< the exact point of entry
  glm::dvec3 pixel_right_mm[kLanes], pixel_down_mm[kLanes];  ///< from there to the next pixels' rays
  Float4 radiance[kLanes];                                   ///< sum over the wavelengths so far
};

/// How a pixel's beam leaves a lens: how the ray's origin and direction (by mm of way) change from this pixel
/// to the next one.
struct LensBeam {
  glm::dvec3 direction{0}, right_mm{0}, down_mm{0}, right_per_mm{0}, down_per_mm{0};

  /// Area across the ray after `way_mm`, mm^2. Source: Igehy 1999, 3.
  [[nodiscard]] double area_mm2(double way_mm) const;
};

/// What becomes of the lanes at one wavelength.
struct RefractedLanes {
  static constexpr int kLanes = LensLanes::kLanes;
  optics::RayPacket16 rays;  ///< active where the light passes; unit directions
  bool passed[kLanes];
  glm::dvec3 exit_mm[kLanes];
  LensBeam beam[kLanes];
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

  /// The side of each lens that is towards the eye; one entry per lens.
  [[nodiscard]] std::vector<optics::LensSide> entered_from(const glm::dvec3& eye_mm) const;

  /// Finds the lanes of `first` before whose hits a lens stands, and takes those hits away. `entered`: from
  /// entered_from().
  void find(const std::vector<optics::LensSide>& entered, optics::RayPacket16& first, LensLanes& lanes) const;

  /// Exact points of entry of the rays through pixel coordinates (column, row).
  void enter(const CameraRays& camera, const double (&column)[LensLanes::kLanes],
             const double (&row)[LensLanes::kLanes], LensLanes& lanes) const;

  /// Wavelengths of the lens in `lanes` that has most of them; 0: no lens.
  [[nodiscard]] std::size_t sample_count(const LensLanes& lanes) const;

  /// The rays behind the lenses at wavelength number `sample`; 0 is the one that geometry belongs to.
  void refract(const glm::dvec3& eye_mm, const LensLanes& lanes, std::size_t sample,
               RefractedLanes& out) const;

  /// Adds to `lanes.radiance` what the shaded rays of wavelength number `sample` show.
  void add_colors(std::size_t sample, const RefractedLanes& out, LensLanes& lanes) const;

 private:
  struct Lens {
    std::size_t optic;  ///< index in Scene::optics
    optics::LensTracer tracer;
    optics::RayScene front, back;  ///< each side's mesh, for finding entries
    std::vector<optics::SpectralSample> samples;
    std::vector<optics::LensIndices> indices;  ///< by sample
  };
  [[nodiscard]] std::unique_ptr<Lens> make_lens(std::size_t optic) const;

  const Scene& scene_;
  std::vector<std::unique_ptr<Lens>> lenses_;
  std::vector<const Lens*> by_optic_;  ///< null: a mirror
};

}  // namespace catoptra::render
