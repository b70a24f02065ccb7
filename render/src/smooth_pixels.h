// Outlines of optics in pictures with hardware multisampling, by as many rays a pixel.
#pragma once

#include <cstdint>
#include <span>

#include "render/frame.h"
#include "render/scene.h"
#include "render/src/ray_tracer.h"

namespace catoptra::render {

/// Sets the colours of the listed pixels in `frame` to the mean of `samples` exact rays each (sampling.h), so
/// that an optic which the ray tracer fills in ends as softly as what the rasteriser draws beside it. Leaves
/// geometry, which is that of the centres, as it is. Returns the number of rays.
std::size_t trace_smooth(const RayTracer& tracer, const Camera& camera, const FrameOptions& options,
                         int samples, std::span<const std::uint32_t> pixels, Frame& frame);

}  // namespace catoptra::render
