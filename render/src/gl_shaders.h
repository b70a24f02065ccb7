// The shader files of render/shaders, compiled into the program.
#pragma once

#include <string_view>

namespace catoptra::render {

/// Text of the file `name` ("raster_surface.frag.glsl"). Throws catoptra::Error where there is no such file.
[[nodiscard]] std::string_view shader_source(std::string_view name);

}  // namespace catoptra::render
