// What a packet of rays that has left optics meets, the own optic excepted or not.
#pragma once

#include <cstdint>
#include <span>

#include "optics/ray_scene.h"
#include "render/src/ray_tracer_chain_lanes.h"
#include "render/src/shading.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::render {

/// Rays for queries along the beams of the active lanes.
void load_rays(ChainLanes& lanes);

/// Lane `i` leaves optic `optic`, the next one on its path.
void set_left(const ChainLanes& from, int i, int optic, optics::LensSide side, ChainLanes& to);

/// One lane's ray and hit.
void copy_hit(const optics::RayPacket16& from, int lane, optics::RayPacket16& to);

/// All lanes' hits for shading, but for their footprint.
void copy_hits(const optics::RayPacket16& from, ShadeLanes& to);

/// The hit of one lane is where it meets that side of optic `optic` next.
void set_met(const optics::RayPacket16& hits, int lane, int optic, optics::LensSide entered, MetOptics& met);

/// Nearest hits among everything but the own optic of each lane (object number first_optic + optic), which
/// rays pass through. Lanes with t_max < t_min are inactive.
void query_past_own(const optics::RayScene& scene, std::uint32_t first_optic,
                    const int (&optic)[LeftOptics::kLanes], optics::RayPacket16& packet);

/// Upper bound of the sine between the tangent plane and a ray that leaves `mesh` on the side of its normals
/// (`sense` = 1) or on the other (-1) and meets it again there: rays that leave at a larger angle cannot.
/// -1: no ray can (a plane, a surface that is convex on that side). From pairs of vertices, with a margin.
[[nodiscard]] double own_sight_sine(const tessellate::OpticArrays& mesh, double sense);

/// One side of an optic as rays meet it that have left it.
struct OwnSide {
  const optics::RayScene& scene;  ///< that holds its mesh
  std::uint32_t object;           ///< its number there
  optics::LensSideView side;
  double sense;  ///< 1: rays leave along its normals, -1: against them
};

/// Where the lanes `asked`, which have left `own`, meet the same side again before the t_max of `rays`: found
/// on the mesh, and believed where the exact surface agrees (rays start on the exact surface, before or
/// behind the chords of the mesh). Sets those lanes of `met` to `optic` and returns whether there are any.
bool find_own(const OwnSide& own, int optic, optics::LensSide entered, const optics::RayPacket16& rays,
              const bool (&asked)[LeftOptics::kLanes], MetOptics& met);

}  // namespace catoptra::render
