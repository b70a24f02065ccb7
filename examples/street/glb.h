// Binary glTF 2.0: one file with geometry, materials and PNG textures inside.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "examples/street/model.h"

namespace catoptra::examples {

/// The bytes of a .glb file with `model` as one node called `name`, turned to glTF's axes: (x, y, z) becomes
/// (x, z, -y), so that +y is up; lengths stay metres. Only the paints and textures in use are written. Throws
/// std::out_of_range for a material that `palette` lacks. Source: Khronos Group 2021, glTF 2.0 specification,
/// 3 and 4.
[[nodiscard]] std::vector<std::byte> write_glb(const Model& model, const Palette& palette,
                                               std::string_view name);

}  // namespace catoptra::examples
