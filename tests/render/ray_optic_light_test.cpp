// Light by way of planar optics in the reference ray tracer, against the model worked out by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "render/src/scene_lights.h"
#include "tests/render/ray_light_scenes.h"

namespace catoptra {
namespace {

using optics::OpticKind;
using test::irradiance;

constexpr double kPlace_mm = 0.02;  ///< as in ray_shadow_test.cpp

/// Fresnel's reflectance of unpolarised light by tangents and sines of the two angles (Hecht 2017, 4.6.2):
/// another form than the one in optics/.
double reflectance(double a, double b) {
  const double s = std::sin(a - b) / std::sin(a + b), p = std::tan(a - b) / std::tan(a + b);
  return (s * s + p * p) / 2;
}

/// A mirror on the floor throws the sun, which stands at 45 degrees over +x, onto a wall at x = -500: a patch
/// from z = 400 to 600, with the shadow of a block in it twice: at 440 from before the mirror, at 520 from
/// behind it.
class MirrorPatch : public testing::Test {
 protected:
  static render::Scene scene(bool block) {
    render::Scene result = test::dark_scene();
    test::add_quad(result.surroundings[0], {-500, -1000, -200}, {0, 2000, 0}, {0, 0, 2000});
    if (block) test::add_box(result.surroundings[0], {-25, -50, 35}, {10, 100, 10});
    result.optics.push_back(test::square_optic(OpticKind::mirror, 100, {0, 0, 0}));
    result.lights.push_back(test::sun({1, 0, 1}));
    return result;
  }
  static constexpr double kDirect = 0.70710678118654752, kBoth = (1 + double(0.9f)) * kDirect;
  static double at(const test::TracedScene& traced, double y, double z) {
    return irradiance(traced, {-500, y, z}, {20, 0, 0});
  }
};

TEST_F(MirrorPatch, HasOutlineAndIrradiance) {
  const test::TracedScene traced(scene(false));
  EXPECT_NEAR(at(traced, 30, 470), kBoth, 1e-6);
  EXPECT_NEAR(at(traced, 0, 390), kDirect, 1e-6);
  EXPECT_NEAR(at(traced, 0, 610), kDirect, 1e-6);
  const double level = 0.5 * (kDirect + kBoth);
  const auto edge = [&](glm::dvec3 inside, glm::dvec3 outside) {
    return test::edge_between(traced, inside, outside, level, {20, 0, 0});
  };
  EXPECT_NEAR(edge({-500, 0, 500}, {-500, 0, 700}).z, 600, kPlace_mm);
  EXPECT_NEAR(edge({-500, 0, 500}, {-500, 0, 300}).z, 400, kPlace_mm);
  EXPECT_NEAR(edge({-500, 0, 500}, {-500, 200, 500}).y, 100, kPlace_mm);
  EXPECT_NEAR(edge({-500, 0, 500}, {-500, -200, 500}).y, -100, kPlace_mm);
}

TEST_F(MirrorPatch, HoldsTheShadowOfABlockTwice) {
  const test::TracedScene traced(scene(true));
  EXPECT_NEAR(at(traced, 0, 440), kDirect, 1e-6) << "before the mirror";
  EXPECT_NEAR(at(traced, 0, 520), kDirect, 1e-6) << "behind the mirror";
  EXPECT_NEAR(at(traced, 0, 480), kBoth, 1e-6) << "between";
  EXPECT_NEAR(at(traced, 70, 440), kBoth, 1e-6) << "beside";
  EXPECT_NEAR(at(traced, 0, -440 + 300), kDirect, 1e-6);
  // Corners (-25, 35) and (-15, 45) bound the first shadow: x - z = -60 +- ... : of (-25, 45) and (-15, 35).
  const double level = 0.5 * (kDirect + kBoth);
  EXPECT_NEAR(test::edge_between(traced, {-500, 0, 480}, {-500, 0, 440}, level, {20, 0, 0}).z, 450,
              kPlace_mm);
  EXPECT_NEAR(test::edge_between(traced, {-500, 0, 480}, {-500, 0, 520}, level, {20, 0, 0}).z, 510,
              kPlace_mm);
}

TEST(OpticLight, AMirrorsImageOfAPointLight) {
  render::Scene scene = test::dark_scene();
  test::add_quad(scene.surroundings[0], {-500, -1000, -200}, {0, 2000, 0}, {0, 0, 2000});
  test::add_quad(scene.surroundings[0], {-100, -500, 500}, {0, 1000, 0},
                 {0, 0, 500});  // hides the lamp itself
  scene.optics.push_back(test::square_optic(OpticKind::mirror, 100, {0, 0, 0}));
  scene.lights.push_back({render::LightKind::point, {}, {300, 0, 600}});
  const test::TracedScene traced(std::move(scene));
  // From the image at (300, 0, -600): P = (-500, 0, 1000) is reached over x = 0, 1600 up and 800 across.
  const double d2 = 800.0 * 800 + 1600.0 * 1600;
  EXPECT_NEAR(irradiance(traced, {-500, 0, 1000}, {20, 0, 0}), double(0.9f) * 1e6 / d2 * 800 / std::sqrt(d2),
              1e-6);
}

/// Two mirrors in sequence: see VirtualLights.TwoMirrorsInSequence in optics. The floor at 700 .. 800 lies in
/// the upper mirror's shadow.
TEST(OpticLight, TwoMirrorsInSequence) {
  for (const int depth : {1, 2}) {
    render::Scene scene = test::dark_scene();
    test::add_quad(scene.surroundings[0], {500, -500, 0}, {500, 0, 0}, {0, 1000, 0});
    scene.optics.push_back(test::square_optic(OpticKind::mirror, 100, {0, 0, 0}));
    scene.optics.push_back(test::square_optic(OpticKind::mirror, 100, {300, 0, 400}, {0, 0, -1}));
    scene.lights.push_back(test::sun({-1, 0, 1}));
    scene.settings.depth = depth;
    const test::TracedScene traced(std::move(scene));
    const double direct = std::sqrt(0.5), twice = depth == 2 ? double(0.9f) * double(0.9f) * direct : 0;
    EXPECT_NEAR(irradiance(traced, {750, 20, 0}), twice, 1e-6);
    EXPECT_NEAR(irradiance(traced, {690, 20, 0}), 0, 1e-6);
    EXPECT_NEAR(irradiance(traced, {810, 20, 0}), direct, 1e-6);
    if (depth == 2) {
      EXPECT_NEAR(test::edge_between(traced, {750, 20, 0}, {690, 20, 0}, twice / 2).x, 700, kPlace_mm);
    }
  }
}

TEST(OpticLight, APaneLetsItsSharePass) {
  render::Scene scene = test::dark_scene();
  test::add_quad(scene.surroundings[0], {-1000, -1000, -300}, {2000, 0, 0}, {0, 2000, 0});
  test::add_box(scene.surroundings[0], {70, -20, 100}, {20, 40, 20});
  scene.optics.push_back(test::square_optic(OpticKind::pane, 100, {0, 0, 0}));
  scene.optics[0].material.thickness_mm = 30;
  scene.optics[0].material.tint = glm::vec3(0.5f);
  const double a = 0.6, b = std::asin(std::sin(a) / 1.5), r = reflectance(a, b);
  scene.lights.push_back(test::sun({std::sin(a), 0, std::cos(a)}));
  const test::TracedScene traced(std::move(scene));
  const double shift = 300 * std::tan(a), passed = 0.5 * (1 - r) / (1 + r) * std::cos(a);
  EXPECT_NEAR(irradiance(traced, {-shift, 50, -300}), passed, 1e-6);
  EXPECT_NEAR(irradiance(traced, {-shift, 120, -300}), std::cos(a), 1e-6);
  EXPECT_NEAR(irradiance(traced, {80 - 410 * std::tan(a), 0, -300}), 0, 1e-6) << "the box before the pane";
  // Patch and shadow of the pane share their outline.
  EXPECT_NEAR(test::edge_between(traced, {-shift, 150, -300}, {-shift, 50, -300}, 0.6).y, 100, kPlace_mm);
}

TEST(OpticLight, GlassThrowsItsReflexion) {
  render::Scene scene = test::dark_scene();
  test::add_quad(scene.surroundings[0], {-500, -1000, -200}, {0, 2000, 0}, {0, 0, 2000});
  scene.optics.push_back(test::square_optic(OpticKind::refractor, 100, {0, 0, 0}));
  const double a = 1.0, r = reflectance(a, std::asin(std::sin(a) / 1.5));
  scene.lights.push_back(test::sun({std::sin(a), 0, std::cos(a)}));
  const test::TracedScene traced(std::move(scene));
  EXPECT_NEAR(irradiance(traced, {-500, 0, 500 / std::tan(a)}, {20, 0, 0}), (1 + r) * std::sin(a), 1e-6);
  EXPECT_NEAR(irradiance(traced, {-500, 150, 500 / std::tan(a)}, {20, 0, 0}), std::sin(a), 1e-6);
}

/// Figure 2 of Diefenbach and Badler 1994: boxes ("cubes") above a refracting face and boxes ("spheres")
/// below it, under an oblique sun, and the eight regions that they make on the ground 600 mm below.
TEST(OpticLight, TheEightRegionsOfARefractingFace) {
  constexpr double kAngle = 40 * 3.14159265358979323846 / 180, kTint = 0.75;
  const double b = std::asin(std::sin(kAngle) / 1.5);
  render::Scene scene = test::dark_scene();
  scene.environment.ambient = 0.125f;
  auto& mesh = scene.surroundings[0];
  test::add_quad(mesh, {-2000, -2000, -600}, {4000, 0, 0}, {0, 4000, 0});
  // Cast on the face at x - z tan 40 degrees: cube A to 112 .. 186 at y = 0, cube B to -138 .. -64 at y =
  // 150.
  test::add_box(mesh, {230, -30, 100}, {40, 60, 40});
  test::add_box(mesh, {-20, 120, 100}, {40, 60, 40});
  // Spheres in the refracted light, cast to -429 .. -370 on the ground, at y = -100 and y = 150.
  test::add_box(mesh, {-268, -130, -300}, {40, 60, 40});
  test::add_box(mesh, {-268, 120, -300}, {40, 60, 40});
  scene.optics.push_back(test::square_optic(OpticKind::refractor, 200, {0, 0, 0}));
  scene.optics[0].material.tint = glm::vec3(float(kTint));
  scene.lights.push_back(test::sun({std::sin(kAngle), 0, std::cos(kAngle)}));
  const test::TracedScene traced(std::move(scene));
  const auto at = [&](double x, double y) { return irradiance(traced, {x, y, -600}); };

  // The power on the face is that on the ground: cos a / cos b of brightening times the cosine b there.
  const double none = 0.125, primary = std::cos(kAngle),
               refracted =
                   kTint * (1 - reflectance(kAngle, b)) * std::cos(kAngle) / std::cos(b) * std::cos(b);
  EXPECT_NEAR(at(300, 0), none + primary, 1e-6) << "1: primary light";
  EXPECT_NEAR(at(-240, 0), none + primary + refracted, 1e-6) << "2: primary and refracted light";
  EXPECT_NEAR(at(-135, 0), none + primary, 1e-6) << "3: cube's refracted shadow and primary light";
  EXPECT_NEAR(at(-358, 150), none, 1e-6) << "4: cube's refracted shadow";
  EXPECT_NEAR(at(-400, 150), none, 1e-6) << "5: cube's refracted, sphere's shadow from refracted light";
  EXPECT_NEAR(at(-400, -100), none, 1e-6) << "6: sphere's shadow from refracted light";
  EXPECT_NEAR(at(-400, 0), none + refracted, 1e-6) << "7: refracted light";
  EXPECT_NEAR(at(-600, 0), none, 1e-6) << "8: the refracting surface's shadow";

  // And where they end. Face's shadow: -200 - 600 tan a; its light: +-200 - 600 tan b.
  const double middle = none + 0.5 * refracted;
  EXPECT_NEAR(test::edge_between(traced, {-400, 50, -600}, {-600, 50, -600}, middle).x,
              -200 - 600 * std::tan(b), kPlace_mm);
  EXPECT_NEAR(test::edge_between(traced, {-240, 60, -600}, {300, 60, -600}, none + primary + refracted / 2).x,
              200 - 600 * std::tan(b), kPlace_mm);
  EXPECT_NEAR(
      test::edge_between(traced, {-200, 50, -600}, {-400, 50, -600}, none + refracted + primary / 2).x,
      200 - 600 * std::tan(kAngle), kPlace_mm);
  // Cube A's refracted shadow ends where the ray by (270, 100) goes.
  EXPECT_NEAR(test::edge_between(traced, {-90, 0, -600}, {-135, 0, -600}, none + primary + refracted / 2).x,
              270 - 100 * std::tan(kAngle) - 600 * std::tan(b), kPlace_mm);
}

TEST(OpticLight, ALampUnderAFaceOfWater) {
  // From within (ior 1.5) straight up: to 1/1.5 of the depth, with 1/2.25 of the strength and Fresnel's 1 -
  // R.
  render::Scene scene = test::dark_scene();
  test::add_quad(scene.surroundings[0], {-500, 500, 400}, {0, -1000, 0}, {1000, 0, 0});
  scene.optics.push_back(test::square_optic(OpticKind::refractor, 100, {0, 0, 0}));
  scene.lights.push_back({render::LightKind::point, {}, {0, 0, -300}});
  const test::TracedScene traced(std::move(scene));
  EXPECT_NEAR(irradiance(traced, {1e-3, 0, 400}, {0, 0, -20}), 0.96 / 2.25 * 1e6 / (600.0 * 600), 1e-5);
}

/// Facing mirrors make two virtual lights of each point at every further reflection.
TEST(OpticLight, TooManyVirtualLightsEndAtALowerDepthAndAreReported) {
  render::Scene scene = test::dark_scene();
  scene.optics.push_back(test::square_optic(OpticKind::mirror, 500, {-300, 0, 0}, {1, 0, 0}));
  scene.optics.push_back(test::square_optic(OpticKind::mirror, 500, {300, 0, 0}, {-1, 0, 0}));
  render::Light lamp;
  lamp.kind = render::LightKind::area;
  lamp.position_mm = {20, 0, 0};
  lamp.radius_mm = 10;
  scene.lights.push_back(lamp);
  scene.settings.depth = 3;
  const auto lights_with = [&](int samples) {
    scene.settings.soft_shadow_samples = samples;
    return render::scene_lights(scene);
  };
  const render::SceneLights few = lights_with(10);
  EXPECT_EQ(few.depth, 3);
  EXPECT_EQ(few.points[0].virtual_lights.size(), 6u);
  EXPECT_FALSE(render::light_warning(scene, few));
  const render::SceneLights many = lights_with(400);
  EXPECT_EQ(many.depth, 1);
  EXPECT_EQ(many.points[0].virtual_lights.size(), 2u);
  const auto warning = render::light_warning(scene, many);
  ASSERT_TRUE(warning);
  EXPECT_NE(warning->find("over 1 instead of 3 planar optics"), std::string::npos) << *warning;
}

}  // namespace
}  // namespace catoptra
