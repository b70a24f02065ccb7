// What planar glass shows and where light falls in the example scenes, by exact rays against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "examples/plates/light_stage.h"
#include "examples/plates/stage.h"
#include "render/renderer.h"
#include "tests/support/planar_scene.h"

namespace catoptra::test {
namespace {

constexpr double kMetre = 1000;  // mm
constexpr glm::ivec2 kSize(1920, 1080);

render::Frame traced(const render::Scene& scene) {
  render::Renderer renderer(scene);
  render::FrameOptions options;
  options.width = kSize.x;
  options.height = kSize.y;
  options.geometry = true;
  return renderer.render(render::Mode::raytrace, scene.camera, options).frame;
}

std::size_t at(int x, int y) {
  return std::size_t(y) * kSize.x + std::size_t(x);
}

/// Angle in the second medium from the cosine in the first: Snell.
double refracted_cosine(double cosine, double ior) {
  return std::sqrt(1 - (1 - cosine * cosine) / (ior * ior));
}

/// Unpolarised reflectance of one surface, from air. Source: Hecht 2017, 4.6.
double fresnel(double cosine, double ior) {
  const double inside = refracted_cosine(cosine, ior);
  const double s = (cosine - ior * inside) / (cosine + ior * inside),
               p = (ior * cosine - inside) / (ior * cosine + inside);
  return (s * s + p * p) / 2;
}

/// Plate 1: through each face the wall is seen where Snell's law says.
TEST(Plate1, WallIsSeenWhereSnellsLawSays) {
  const render::Scene scene = example_scene("plate1").scene;
  const render::Frame frame = traced(scene);
  const double wall_mm = examples::kPlate1Wall_m * kMetre;
  for (int o = 0; o < int(scene.optics.size()); ++o) {
    const optics::Optic& optic = scene.optics[std::size_t(o)];
    const Rectangle face = upright_rectangle(optic);
    const glm::dvec3 n = face.normal();
    ASSERT_LT(n.y, 0) << "looks to the eye";
    int pixels = 0;
    double worst_mm = 0, farthest_mm = 0;
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) {
        const glm::dvec3 shown(frame.position[at(x, y)]);
        if (frame.optic_id[at(x, y)] != o || frame.position[at(x, y)].w == 0 ||
            std::abs(shown.y - wall_mm) > 0.1)
          continue;
        const StraightRay ray = pixel_ray(scene.camera, kSize, x, y);
        const auto q = face.meet(ray);
        ASSERT_TRUE(q);
        const double cosine = -glm::dot(ray.direction, n), eta = 1 / optic.material.ior;
        const glm::dvec3 bent =
            eta * (ray.direction + cosine * n) - refracted_cosine(cosine, optic.material.ior) * n;
        const glm::dvec3 expected = *q + (wall_mm - q->y) / bent.y * bent;
        const glm::dvec3 straight = *q + (wall_mm - q->y) / ray.direction.y * ray.direction;
        ++pixels;
        worst_mm = std::max(worst_mm, glm::distance(shown, expected));
        farthest_mm = std::max(farthest_mm, glm::distance(expected, straight));
      }
    EXPECT_GE(pixels, 3000) << optic.name;
    EXPECT_LE(worst_mm, 0.05) << optic.name;  // single precision at 5 m
    if (optic.material.ior == 1)
      EXPECT_LE(farthest_mm, 1e-6) << "nothing bends";
    else
      EXPECT_GE(farthest_mm, optic.name == "turned" ? 200 : 100)
          << optic.name << ": a square, and half a square";
  }
}

/// Plate 4 from a lower eye, so that what the panes reflect is the sky; against the scene without panes,
/// where nine pixels have one colour, for the panes shift what is behind them by a millimetre.
TEST(Plate4, PanesFadeByDistanceOrBlend) {
  render::Scene scene = example_scene("plate4").scene;
  scene.camera.eye_mm = {0, -5400, 100};
  scene.camera.target_mm = {0, 0, 560};
  const render::Frame frame = traced(scene);
  render::Scene open = scene;
  open.optics.clear();
  const render::Frame behind = traced(open);
  const double ambient = scene.environment.ambient;
  std::array<int, 3> pixels{};
  double worst = 0;
  for (int y = 1; y + 1 < kSize.y; ++y)
    for (int x = 1; x + 1 < kSize.x; ++x) {
      const int o = frame.optic_id[at(x, y)];
      if (o < 0 || behind.position[at(x, y)].w == 0) continue;
      // Through the edge of a pane one sees the back half of its frame, 15 mm thick, and reflected the front
      // half.
      if (frame.position[at(x, y)].y < 20) continue;
      const glm::dvec3 object(behind.color[at(x, y)]);
      bool plain = true;
      for (int j = y - 1; j <= y + 1; ++j)
        for (int i = x - 1; i <= x + 1; ++i)
          plain = plain && glm::distance(object, glm::dvec3(behind.color[at(i, j)])) < 1e-3;
      const StraightRay ray = pixel_ray(scene.camera, kSize, x, y);
      if (!plain || ray.direction.z <= 0) continue;
      const optics::PlanarMaterial& m = scene.optics[std::size_t(o)].material;
      const double r = fresnel(ray.direction.y, m.ior), reflected = 2 * r / (1 + r),
                   passed = (1 - r) / (1 + r);
      const double s_mm = (frame.position[at(x, y)].y) / ray.direction.y;  // the panes lie in y = 0
      const double fog = 1 - std::pow(1 - m.translucency, s_mm / kMetre);
      const glm::dvec3 color(m.color), sky(scene.environment.color);
      const glm::dvec3 through = passed * ((1 - fog) * object + fog * ambient * color) + reflected * sky;
      // The panes' own surface looks to the eye; the light comes from behind the eye.
      const auto& light = scene.lights[0];
      const double lit = ambient + light.intensity * std::max(0.0, light.direction.y);
      const glm::dvec3 expected = (1 - m.material_alpha) * through + m.material_alpha * lit * color;
      ++pixels[std::size_t(o)];
      worst = std::max(worst, glm::distance(expected, glm::dvec3(frame.color[at(x, y)])));
    }
  for (const int count : pixels) EXPECT_GE(count, 500);
  EXPECT_LE(worst, 0.004);  // twice the difference that "one colour" allows, and rounding
}

TEST(CarInterior, DoorMirrorIsSeenThroughTheSideWindow) {
  const render::Scene scene = example_scene("car_interior").scene;
  const render::Frame frame = traced(scene);
  const auto number = [&](const char* name) {
    return std::int32_t(&optic_named(scene, name) - scene.optics.data());
  };
  const std::uint32_t window_door =
      render::path_after(render::path_after(0, number("side window")), number("door"));
  const std::uint32_t interior_rear =
      render::path_after(render::path_after(0, number("interior")), number("rear window"));
  int door = 0, direct = 0, interior = 0;
  for (std::size_t i = 0; i < frame.path.size(); ++i) {
    door += frame.path[i] == window_door;
    interior += frame.path[i] == interior_rear;
    direct += frame.optic_id[i] == number("door");
  }
  EXPECT_GE(door, 1500);
  EXPECT_EQ(direct, 0) << "the window covers all of the door mirror";
  EXPECT_GE(interior, 500);
}

/// The floor of Figure 2, pixel by pixel: ambient light, the sun where it is seen, and what comes by way of
/// the face.
void judge_floor(const std::string& name, const examples::LightStage& stage) {
  const render::Scene scene = example_scene(name).scene;
  const render::Frame frame = traced(scene);
  const auto places = examples::label_places(stage);
  const glm::dvec3 from_face = examples::light_from_face(stage);
  const double cosine = stage.sun.x;  // on the face, which looks along -x
  // Irradiance on the floor by way of the face, of one on a plane square to the sun.
  const double by_face = stage.mirror
                             ? scene.optics[0].reflectance.x * -from_face.z
                             : (1 - fresnel(cosine, stage.ior)) * cosine / from_face.x * -from_face.z;
  // The floor's paint, sRGB 208 206 200 (IEC 61966-2-1).
  const auto linear = [](double c) { return std::pow((c / 255 + 0.055) / 1.055, 2.4); };
  const glm::dvec3 albedo(linear(208), linear(206), linear(200));
  // Glass reflects as well: the sun's mirror image, weak, on the floor before the face.
  examples::LightStage reflecting = stage;
  reflecting.mirror = true;
  const double by_glass = stage.mirror ? 0 : fresnel(cosine, stage.ior) * -stage.sun.z;
  std::array<int, 9> pixels{};
  double worst = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const glm::vec4& shown = frame.position[at(x, y)];
      if (frame.optic_id[at(x, y)] >= 0 || shown.w == 0 || std::abs(shown.z) > 0.01) continue;
      const glm::dvec2 p(shown.x / kMetre, shown.y / kMetre);
      // Beside a line of 7 mm, which coarser levels of the texture spread to a few pixels, or in a number:
      // not plain.
      constexpr double kBesideLine = 0.02;
      const int region = examples::floor_region(stage, p);
      bool plain = true;
      for (const glm::dvec2& to :
           {glm::dvec2(-1, -1), {-1, 0}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}, {1, 0}, {1, 1}})
        plain =
            plain && examples::floor_region(stage, p + kBesideLine * to) == region &&
            examples::floor_region(reflecting, p + kBesideLine * to) == examples::floor_region(reflecting, p);
      for (const auto& place : places) {
        const double number =
            std::min(examples::kLargestNumber_m, examples::kNumberShare * 2 * place.half_side);
        const glm::dvec2 off = glm::abs(p - place.middle);
        plain = plain && std::max(off.x, off.y) > 0.625 * number;
      }
      if (!plain) continue;
      const examples::FloorLight light = examples::floor_light(stage, p);
      const double irradiance =
          scene.environment.ambient +
          scene.lights[0].intensity * (light.primary * -stage.sun.z + light.secondary() * by_face +
                                       examples::floor_light(reflecting, p).secondary() * by_glass);
      ++pixels[std::size_t(region)];
      worst = std::max(worst, glm::distance(glm::dvec3(frame.color[at(x, y)]), irradiance * albedo));
      ASSERT_LE(worst, 0.004) << "region " << region << " at " << p.x << ' ' << p.y
                              << " m: " << frame.color[at(x, y)].x << " for " << irradiance * albedo.x;
    }
  for (std::size_t region = 1; region <= 8; ++region) EXPECT_GE(pixels[region], 5) << "region " << region;
}

TEST(Figure2, EightRegionsHaveTheirLight) {
  judge_floor("figure2", examples::refraction_stage());
}

TEST(Figure2, EightRegionsOfAMirrorHaveTheirLight) {
  judge_floor("figure2_mirror", examples::reflection_stage());
}

}  // namespace
}  // namespace catoptra::test
