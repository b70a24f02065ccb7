// How far a mesh strays from the exact surface.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "cad_import/cad_model.h"
#include "tessellate/src/mesh_draft.h"
#include "tessellate/src/sizing.h"

namespace catoptra::tessellate {

/// The deviation at one parameter point from the straight mesh point `flat`, along the surface's normal, as a
/// share of what `limits` allows: above 1 is too much.
[[nodiscard]] double chord_share(const cad_import::ExactSurface& surface, const glm::dvec2& uv,
                                 const glm::dvec3& flat, const StepLimits& limits);

/// The largest share over the middles and centres of triangles [begin, end) of the draft.
[[nodiscard]] double worst_chord_share(std::span<const DraftTriangle> triangles,
                                       std::span<const DraftVertex> vertices,
                                       const cad_import::ExactSurface& surface, const StepLimits& limits);

}  // namespace catoptra::tessellate
