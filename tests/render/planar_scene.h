// Planar optics for tests: rectangles of a plane, without a CAD kernel.
#pragma once

#include "tests/render/bounce_scene.h"

namespace catoptra::test {

/// A rectangle at `middle_mm` whose front looks towards `towards`.
inline optics::Optic planar_optic(optics::OpticKind kind, const glm::dvec3& middle_mm,
                                  const glm::dvec3& towards, double width_mm, double height_mm) {
  optics::Optic optic = PlacedMirror::facing(middle_mm, towards, width_mm, height_mm).optic(2);
  optic.kind = kind;
  optic.planar = true;
  optic.two_sided = kind == optics::OpticKind::mirror;
  return optic;
}

}  // namespace catoptra::test
