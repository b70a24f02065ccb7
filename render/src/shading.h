// The one shading model of all modes (docs/decisions/0001), as the ray tracer computes it.
#pragma once

#include "optics/ray_scene.h"
#include "render/src/textures.h"

namespace catoptra::render {

/// Diffuse albedo of the side of an optic that does not reflect.
inline constexpr float kOpticBackAlbedo = 0.05f;

/// Whether a point of `mesh` is there: its alpha (material x texture, finest level, bilinear) reaches the
/// material's cutoff. The finest level in every mode, because a ray query knows no footprint. Empty where
/// nothing is cut. `textures` are those of `mesh`; both must outlive the function.
[[nodiscard]] optics::AlphaTest make_alpha_test(const cad_import::TriangleMesh& mesh,
                                                const std::vector<MipTexture>& textures);

}  // namespace catoptra::render
