// Rays of a packet on their way from optic to optic.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "optics/lens_path.h"
#include "optics/ray_scene.h"
#include "render/src/ray_tracer_lens_side.h"

namespace catoptra::render {

/// The optic that each lane has left last; of rays from the eye none.
struct LeftOptics {
  static constexpr int kLanes = LaneVectors::kLanes;
  bool active[kLanes];
  int optic[kLanes];              ///< index in Scene::optics; -1 in lanes that are not active
  optics::LensSide side[kLanes];  ///< of a lens: through which the ray left
  bool sees_own[kLanes];          ///< may meet the same side again: see own_sight_sine()
};

/// The optic that each lane meets next, before anything else, and where on its mesh.
struct MetOptics {
  static constexpr int kLanes = LaneVectors::kLanes;
  int optic[kLanes];                 ///< index in Scene::optics; -1: none
  optics::LensSide entered[kLanes];  ///< of a lens
  float distance[kLanes];            ///< from the packet's origins, mm
  float u[kLanes], v[kLanes];        ///< weights of the triangle's second and third vertex
  std::uint32_t triangle[kLanes];
};

/// Rays that leave optics.
struct ChainLanes {
  static constexpr int kLanes = LaneVectors::kLanes;
  LeftOptics left;
  BeamLanes beams;           ///< from the exact points of the last surfaces on
  optics::RayPacket16 rays;  ///< the same for queries; unit directions
  double offset_mm = 0;      ///< how far along the beams the packet's rays start
  int wavelength[kLanes];    ///< number in the table of TracedLenses; -1: of all wavelengths together
  std::uint8_t bounces[kLanes];
  std::uint32_t path[kLanes];  ///< see path_after()
  float next_mm[kLanes];       ///< once followed: from the packet's origins to what is met next
  int sample = 0;              ///< of the picture: see normal_pair()
};

/// What lanes show at last: geometry as in Frame, and the unit normal of the triangle met.
struct ChainEnds {
  static constexpr int kLanes = LaneVectors::kLanes;
  glm::vec4 position[kLanes];
  glm::vec3 surface[kLanes], direction[kLanes], normal[kLanes];
  std::uint8_t bounces[kLanes];
  std::uint32_t path[kLanes];
};

}  // namespace catoptra::render
