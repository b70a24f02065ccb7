// The stages of the paper's plates, and where light falls on the floor of Figure 2.
#include "examples/plates/stage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "examples/plates/light_stage.h"
#include "examples/street/palette.h"
#include "tests/support/sound_model.h"

namespace catoptra::examples {
namespace {

TEST(Stage, ModelsAreSoundAndSmall) {
  Palette palette = make_palette(CATOPTRA_SIGN_FONT);
  add_stage_paints(palette, CATOPTRA_SIGN_FONT);
  for (const Model& model :
       {make_refraction_stage(), make_mirror_room(), make_light_stage(refraction_stage()),
        make_light_stage(reflection_stage()), make_caustic_stage(refraction_stage()),
        make_translucency_stage(), make_combined_stage(), make_mirror_stand()}) {
    test::expect_sound(model, palette, 1e-7f);
    EXPECT_LE(model.triangle_count(), 8000u);
  }
}

TEST(LightStage, LightThatPassesTheFaceObeysSnell) {
  const LightStage stage = refraction_stage();
  const glm::dvec3 out = light_from_face(stage);
  EXPECT_NEAR(glm::length(out), 1, 1e-15);
  EXPECT_NEAR(stage.ior * std::sqrt(1 - out.x * out.x), std::sqrt(1 - stage.sun.x * stage.sun.x), 1e-15);
}

/// Along the floor's middle line the limits are heights of the face and of the cube times the slope of the
/// light.
TEST(LightStage, LimitsOfRefractedLightAndShadowsFollowFromSlopes) {
  const LightStage stage = refraction_stage();
  const double steep = -stage.sun.x / stage.sun.z;  // metres along the floor for each of height
  const double sin_b = -stage.sun.z / stage.ior, flat = std::sqrt(1 - sin_b * sin_b) / sin_b;
  constexpr double kBeside = 1e-6, y = -0.5;  // clear of cube and sphere
  const auto changes = [&](double x, int before, int after) {
    EXPECT_EQ(floor_region(stage, {x - kBeside, y}), before) << x;
    EXPECT_EQ(floor_region(stage, {x + kBeside, y}), after) << x;
  };
  changes(stage.low * steep, 1, 8);
  changes(stage.low * flat, 8, 7);
  changes(stage.high * steep, 7, 2);
  changes(stage.high * flat, 2, 1);
  // The cube's lowest shadow on the face comes from its far lower edge, the highest from its near upper one.
  const double lowest = stage.cube_low.z + stage.cube_low.x / steep,
               highest = stage.cube_high.z + stage.cube_high.x / steep;
  const double beyond_sphere = -0.1;
  EXPECT_EQ(floor_region(stage, {lowest * flat + kBeside, beyond_sphere}), 4);
  EXPECT_EQ(floor_region(stage, {lowest * flat - kBeside, beyond_sphere}), 7);
  EXPECT_EQ(floor_region(stage, {highest * flat - kBeside, beyond_sphere}), 3);
  EXPECT_EQ(floor_region(stage, {highest * flat + kBeside, beyond_sphere}), 2);
}

/// The sphere's shadow in parallel light is an ellipse: half as wide as the sphere, longer by the light's
/// slope.
TEST(LightStage, SpheresShadowIsAnEllipse) {
  for (const LightStage& stage : {refraction_stage(), reflection_stage()}) {
    const glm::dvec3 d = light_from_face(stage), c = stage.sphere_centre;
    const glm::dvec2 middle = glm::dvec2(c) - c.z / d.z * glm::dvec2(d);
    const double half = stage.sphere_radius / -d.z;
    for (const double side : {-1.0, 1.0}) {
      EXPECT_TRUE(floor_light(stage, middle + glm::dvec2(side * (half - 1e-6), 0)).sphere_shadow);
      EXPECT_FALSE(floor_light(stage, middle + glm::dvec2(side * (half + 1e-6), 0)).sphere_shadow);
      EXPECT_TRUE(
          floor_light(stage, middle + glm::dvec2(0, side * (stage.sphere_radius - 1e-6))).sphere_shadow);
      EXPECT_FALSE(
          floor_light(stage, middle + glm::dvec2(0, side * (stage.sphere_radius + 1e-6))).sphere_shadow);
    }
  }
}

TEST(LightStage, MirrorThrowsTheLightWhereItsImageWouldBeShadow) {
  // Light from the mirror falls on the mirror image of the mirror's own shadow.
  const LightStage stage = reflection_stage();
  for (double x = 0.01; x < 2; x += 0.01)
    EXPECT_EQ(floor_light(stage, {x, 0.5}).face_shadow, floor_light(stage, {-x, 0.5}).from_face) << x;
}

TEST(LightStage, EachNumberStandsInItsRegion) {
  for (const LightStage& stage : {refraction_stage(), reflection_stage()}) {
    const auto places = label_places(stage);
    for (std::size_t i = 0; i < places.size(); ++i) {
      ASSERT_GE(places[i].half_side, 0.03) << "region " << i + 1 << " is too small to be seen";
      const double half = kNumberShare * places[i].half_side;
      for (const glm::dvec2& corner : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}, {0, 0}})
        EXPECT_EQ(floor_region(stage, places[i].middle + half * corner), int(i) + 1);
    }
  }
}

}  // namespace
}  // namespace catoptra::examples
