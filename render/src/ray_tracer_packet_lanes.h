// A packet of pixels on its way, for the parts of PacketTracer.
#pragma once

#include <cstddef>

#include "render/src/ray_tracer_packet.h"

namespace catoptra::render {

inline std::size_t index_of(const PixelPacket& pixels, int lane, const Frame& frame) {
  return std::size_t(pixels.row[lane]) * std::size_t(frame.width) + std::size_t(pixels.column[lane]);
}

/// All that is known of 16 pixels on their way.
struct alignas(64) PacketTracer::Packet {
  int sample = 0;  ///< of the picture: see normal_pair()
  optics::RayPacket16
      first;  ///< from the eye; directions have length 1 along the camera's axis, so t_max is a depth
  optics::RayPacket16 second;  ///< reflected; unit directions
  MirrorLanes mirror;
  ShadeLanes shade;
  double column[PixelPacket::kLanes], row[PixelPacket::kLanes];  ///< with the sample's offset
  double stretch[PixelPacket::kLanes];  ///< length of the first direction, of mirror lanes
  int optic[PixelPacket::kLanes];       ///< whose reflecting side the pixel shows; -1: none
  bool any_mirror;
  LensLanes lens;
  MetOptics planar;  ///< planar optics that are followed from the eye on; set where there are any
  bool any_planar;
  MapLanes found;                    ///< of the mirrored hits
  bool traced[PixelPacket::kLanes];  ///< an optic shows what maps do not know
  Float4 color[PixelPacket::kLanes];
};

}  // namespace catoptra::render
