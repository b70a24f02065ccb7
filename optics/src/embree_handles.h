// Owning handles of Embree's objects, and its errors as exceptions.
#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <string>

namespace catoptra::optics {

struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
  void operator()(RTCBuffer buffer) const { rtcReleaseBuffer(buffer); }
};

using EmbreeDevice = std::unique_ptr<RTCDeviceTy, EmbreeRelease>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, EmbreeRelease>;
using EmbreeGeometry = std::unique_ptr<RTCGeometryTy, EmbreeRelease>;
using EmbreeBuffer = std::unique_ptr<RTCBufferTy, EmbreeRelease>;

/// Throws catoptra::Error where Embree has reported an error since the last call; `doing` says what was under
/// way. A null device asks for the error of a failed rtcNewDevice.
void check_embree(RTCDevice device, const std::string& doing);

}  // namespace catoptra::optics
