// Rays of a packet at one side of a lens, or at a mirror: where they meet it, and how they go on.
#pragma once

#include <cstdint>
#include <vector>

#include "optics/lens_path.h"
#include "render/src/ray_tracer_patches.h"
#include "render/src/sampling.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::render {

/// One vector per lane, structure of arrays.
struct alignas(64) LaneVectors {
  static constexpr int kLanes = 16;
  double x[kLanes], y[kLanes], z[kLanes];

  [[nodiscard]] glm::dvec3 at(int lane) const { return {x[lane], y[lane], z[lane]}; }
  void set(int lane, const glm::dvec3& value) {
    x[lane] = value.x;
    y[lane] = value.y;
    z[lane] = value.z;
  }
};

/// Rays, and how each changes towards the rays of the next pixel to the right and of the next one down.
/// Source: Igehy, Tracing ray differentials, SIGGRAPH 1999, 3.1 and 3.2.
struct BeamLanes {
  LaneVectors point, direction;         ///< mm; unit
  LaneVectors point_right, point_down;  ///< changes of `point`
  LaneVectors direction_right, direction_down;
};

/// Where beams meet a side. Changes of the point are in the tangent plane.
struct MetLanes {
  LaneVectors point, normal;  ///< mm; unit, out of the lens
  LaneVectors point_right, point_down, normal_right, normal_down;
  double distance[LaneVectors::kLanes];  ///< from the beams' points, mm
};

/// What refraction makes of beams: they start where they met the side.
struct RefractedBeams {
  BeamLanes beams;
  double transmittance[LaneVectors::kLanes];  ///< Fresnel, unpolarised
  bool possible[LaneVectors::kLanes];         ///< false: total reflection
};

/// The beams of an eye through pixel coordinates (column, row). `stretch`: how much longer their directions
/// are along the camera's axis.
void aim_beams(const CameraRays& camera, const double (&column)[LaneVectors::kLanes],
               const double (&row)[LaneVectors::kLanes], double (&stretch)[LaneVectors::kLanes],
               BeamLanes& beams);

/// Snell, Fresnel and their differentials at a side, for either sense of the normal; `eta` = n_from / n_to by
/// lane.
void refract_beams(const BeamLanes& beams, const MetLanes& met, const double (&eta)[LaneVectors::kLanes],
                   RefractedBeams& out);

/// Reflection and its differentials at a mirror, for either sense of the normal. Source: Igehy 1999, 3.3.
void reflect_beams(const BeamLanes& beams, const MetLanes& met, BeamLanes& out);

/// Area across each beam, mm^2, at `way_mm` along it. Source: Igehy 1999, 3.
void set_areas(const BeamLanes& beams, const float (&way_mm)[LaneVectors::kLanes],
               float (&area_mm2)[LaneVectors::kLanes]);

/// One lane's point of a surface, from its own evaluation: as meet() leaves it.
void meet_vertex(const tessellate::OpticVertex& vertex, const BeamLanes& beams, int lane, MetLanes& met);

/// The point of the side's exact surface that belongs to a hit on its mesh. Where the mesh reaches past the
/// trimmed face, which is by less than its chord error, the mesh's own point.
[[nodiscard]] tessellate::OpticVertex exact_side_point(const optics::LensSideView& side,
                                                       const optics::Ray& ray, const optics::Hit& mesh_hit);
[[nodiscard]] tessellate::OpticVertex exact_side_point(const optics::LensSideView& side,
                                                       const optics::ExactHit& hit);

/// One side of a lens, or a mirror, as polynomial patches. Near the outline of a face they do not say whether
/// it is met.
class LensSidePatches {
 public:
  /// `side` must outlive this and stay as it is.
  explicit LensSidePatches(const optics::LensSideView& side);

  /// The mesh's hits of the lanes. Inactive lanes are not looked at.
  struct MeshHits {
    bool active[LaneVectors::kLanes];
    double distance[LaneVectors::kLanes];  ///< from the beams' points, mm
    std::uint32_t triangle[LaneVectors::kLanes];
    float u[LaneVectors::kLanes], v[LaneVectors::kLanes];  ///< weights of its second and third vertex
  };

  /// Meets the active lanes' beams and sets `solved` where it could; other lanes of `met` stay.
  void meet(const BeamLanes& beams, const MeshHits& hits, MetLanes& met,
            bool (&solved)[LaneVectors::kLanes]) const;

  /// The same for every active lane: by the exact surface itself where the patches cannot.
  void meet_all(const BeamLanes& beams, const MeshHits& hits, MetLanes& met) const;

 private:
  [[nodiscard]] const SurfacePatch* patch_within(std::uint32_t triangle, double u, double v) const;

  optics::LensSideView side_;
  MeshPatches patches_;
  // By triangle: bit k: corner k lies on the outline of its face; 7: all of it may.
  std::vector<std::uint8_t> outline_corners_;
};

}  // namespace catoptra::render
