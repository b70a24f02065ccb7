// Exact hits on a mirror, and reflection there, for packets of rays.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "optics/optic.h"
#include "optics/ray_scene.h"
#include "render/src/ray_tracer_patches.h"

namespace catoptra::render {

/// Rays as a mirror sends them on. Structure of arrays.
struct alignas(64) MirrorRays {
  static constexpr int kLanes = 16;
  double surface_x[kLanes], surface_y[kLanes], surface_z[kLanes];        ///< exact hit, mm
  double reflected_x[kLanes], reflected_y[kLanes], reflected_z[kLanes];  ///< unit
  double distance[kLanes];                                               ///< eye to hit, mm
  /// Sum and product of the principal curvatures of the reflected wavefront at the hit, 1/mm and 1/mm^2, for
  /// a spherical wave from the eye; diverging positive.
  double wave_sum[kLanes], wave_product[kLanes];

  void copy_lane(const MirrorRays& from, int lane) {
    surface_x[lane] = from.surface_x[lane];
    surface_y[lane] = from.surface_y[lane];
    surface_z[lane] = from.surface_z[lane];
    reflected_x[lane] = from.reflected_x[lane];
    reflected_y[lane] = from.reflected_y[lane];
    reflected_z[lane] = from.reflected_z[lane];
    distance[lane] = from.distance[lane];
    wave_sum[lane] = from.wave_sum[lane];
    wave_product[lane] = from.wave_product[lane];
  }
};

/// Rays from one eye that hit the mesh of one optic, and what becomes of them.
struct alignas(64) MirrorLanes {
  static constexpr int kLanes = MirrorRays::kLanes;
  // In. Directions must be ordinary numbers in every lane, active or not.
  bool active[kLanes];
  double direction_x[kLanes], direction_y[kLanes], direction_z[kLanes];  ///< unit
  double start[kLanes];                                                  ///< distance of the mesh's hit, mm
  std::uint32_t triangle[kLanes];                                        ///< of the optic's mesh
  float u[kLanes], v[kLanes];  ///< weights of its second and third vertex
  // Out, for active lanes.
  MirrorRays out;
};

class ExactMirror {
 public:
  /// Fits the patches of every face. `optic` must outlive this object and stay as it is.
  explicit ExactMirror(const optics::Optic& optic);

  /// Hits and reflects the active lanes: on the patches, and by optics::exact_hit where they do not stand for
  /// the surface.
  void reflect(const glm::dvec3& eye_mm, MirrorLanes& lanes) const;

  /// Share of the mesh's triangles whose middle lies on a valid patch, and the number of patches.
  [[nodiscard]] double patched_share() const { return patches_.patched_share(); }
  [[nodiscard]] std::size_t patch_count() const { return patches_.patch_count(); }

 private:
  void reflect_on_patch(const SurfacePatch& patch, const glm::dvec3& eye_mm,
                        const bool (&chosen)[MirrorLanes::kLanes], MirrorLanes& lanes,
                        bool (&solved)[MirrorLanes::kLanes]) const;
  void reflect_by_newton(const glm::dvec3& eye_mm, int lane, MirrorLanes& lanes) const;

  const optics::Optic& optic_;
  MeshPatches patches_;
};

}  // namespace catoptra::render
