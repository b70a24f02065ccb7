// What the eye sees of each optic, told before a picture is made: a picture without it looks like a right
// one.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "optics/optic.h"
#include "render/scene.h"

namespace catoptra::app {

/// Whether `point_mm` lies in the glass: between front and back along the lens's axis.
[[nodiscard]] bool inside_lens(const optics::Optic& lens, const glm::dvec3& point_mm);

/// One line for each optic that the picture cannot show as such: one that lies outside the picture, a mirror
/// that turns its back to the eye, a lens that lets no ray from the eye pass. Judged by
/// rays to the vertices of its mesh and over the picture; what stands before an optic is not considered.
/// Nothing is said of an optic that another one may show within `scene.settings.depth`, by where both lie,
/// and planar optics that work from both sides have no back.
/// Throws catoptra::Error(`scene.file`, lens, ...) where the eye lies inside a lens.
[[nodiscard]] std::vector<std::string> optic_view_warnings(const render::Scene& scene);

}  // namespace catoptra::app
