// The arrangement of Figure 2 of the 1994 paper: sunlight, an upright face that refracts or reflects, a cube
// before it, a sphere in the light that comes from it, and the floor on which eight kinds of light and shadow
// fall. Metres, z up. What falls where follows from rays against box and sphere, so that pictures can be
// judged by it.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace catoptra::examples {

struct LightStage {
  bool mirror = false;       ///< the face; else a refractor whose front looks towards -x
  double ior = 1.5;          ///< of the refractor, behind the face
  glm::dvec3 sun{0};         ///< unit direction in which the light travels, with x > 0 and z < 0
  double half_width = 0;     ///< of the face: x = 0, |y| <= half_width, low <= z <= high
  double low = 0, high = 0;  ///< of the face
  glm::dvec3 cube_low{0}, cube_high{0};
  glm::dvec3 sphere_centre{0};
  double sphere_radius = 0;
  glm::dvec2 floor_low{0}, floor_high{0};  ///< z = 0
};

/// The scenes figure2.toml and figure2_mirror.toml.
[[nodiscard]] LightStage refraction_stage();
[[nodiscard]] LightStage reflection_stage();

/// Direction of the light that has passed the face, or that it reflects; unit.
[[nodiscard]] glm::dvec3 light_from_face(const LightStage& stage);

/// What a point of the floor gets.
struct FloorLight {
  bool primary = false;        ///< straight light
  bool face_shadow = false;    ///< the face stands in the way of the straight light
  bool from_face = false;      ///< lies where light from the face falls, were there neither cube nor sphere
  bool cube_shadow = false;    ///< the cube stands in the light from the face, before the face or after it
  bool sphere_shadow = false;  ///< so does the sphere
  [[nodiscard]] bool secondary() const { return from_face && !cube_shadow && !sphere_shadow; }
};
[[nodiscard]] FloorLight floor_light(const LightStage& stage, const glm::dvec2& point);

/// The paper's number: 1 primary light; 2 primary light and light from the face; 3 the cube's shadow in the
/// light from the face, and primary light; 4 the same without primary light; 5 both cube's and sphere's
/// shadow in the light from the face; 6 the sphere's alone; 7 light from the face alone; 8 the face's shadow.
/// 0: none of these (the plain shadow of cube or sphere).
[[nodiscard]] int floor_region(const LightStage& stage, const glm::dvec2& point);

/// Height of a number against the square that it stands in, and at most, m.
inline constexpr double kNumberShare = 0.7, kLargestNumber_m = 0.16;

/// Middle and half side of the largest square of each region: where its number stands. Index: number - 1.
/// A half side of 0: the region does not occur.
struct LabelPlace {
  glm::dvec2 middle{0};
  double half_side = 0;
};
[[nodiscard]] std::array<LabelPlace, 8> label_places(const LightStage& stage);

}  // namespace catoptra::examples
