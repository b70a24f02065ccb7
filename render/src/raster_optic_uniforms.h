// The uniforms of raster_optic.glsl, which every way to draw an optic sets alike.
#pragma once

#include <cstddef>

#include "optics/optic.h"

namespace catoptra::render {

/// For the program in use: reflectance, reflecting side, albedo of the other side, and the optic's index.
void set_optic_uniforms(const optics::Optic& optic, std::size_t index);

}  // namespace catoptra::render
