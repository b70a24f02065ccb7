// What stands on the stages of the paper's plates: floors and walls with patterns, cubes, spheres, letters.
// The planar optics themselves are corners in the scene files. Metres, z up; the eye looks along +y.
#pragma once

#include <filesystem>

#include "examples/plates/light_stage.h"
#include "examples/street/model.h"

namespace catoptra::examples {

/// Adds the paints of all stages. Throws std::runtime_error where `font` is none.
void add_stage_paints(Palette& palette, const std::filesystem::path& font);

/// Plate 1: a wall of named squares of 0.2 m at y = 1.6, a cube before it, frames for three faces of 0.7 x
/// 0.9 m at x = -1, 0 and 1, turned by x times kPlate1Turn_deg about the upright through their middle.
[[nodiscard]] Model make_refraction_stage();
inline constexpr float kPlate1Turn_deg = 35;
inline constexpr double kPlate1Wall_m = 1.6;

/// Plate 2: a closed room of 4 x 3 x 2.4 m, x from -2 to 2, y from -1.5 to 1.5, z from 0, with frames for
/// mirrors of 2.2 x 1.5 m in the middle of the walls x = -2, x = 2 and y = 1.5, 1 cm before them.
[[nodiscard]] Model make_mirror_room();

/// Figure 2: floor with the regions' outlines and numbers, cube and sphere.
[[nodiscard]] Model make_light_stage(const LightStage& stage);

/// Plate 3: cube and sphere of `stage` over a chequered floor, before a wall.
[[nodiscard]] Model make_caustic_stage(const LightStage& stage);

/// Plate 4: at x = -1, 0 and 1 the same three things 0.05, 0.35 and 0.95 m behind the plane y = 0, and frames
/// for panes of 0.8 x 1 m in that plane.
[[nodiscard]] Model make_translucency_stage();

/// Plate 5: floor and two walls; cube, sphere, vase and letters between a mirror, a refractor and a pane,
/// whose frames stand here.
[[nodiscard]] Model make_combined_stage();

/// A large mirror's frame, 2.4 x 1.6 m, on two feet: its mirror lies in y = 0, the middle at z =
/// kStandMiddle, and looks towards +y.
inline constexpr float kStandMiddle = 1.15f;
[[nodiscard]] Model make_mirror_stand();

}  // namespace catoptra::examples
