// Planar optics in modes hybrid and exact: as the ray tracer shows them, and with lines of their own in a
// comparison.
#include <gtest/gtest.h>

#include "render/comparison.h"
#include "render/renderer.h"
#include "tests/render/ray_planar_scenes.h"

namespace catoptra {
namespace {

using namespace test;
using optics::OpticKind;

constexpr int kWidth = 96, kHeight = 72;

/// A pane, a refractor, a two-sided mirror seen from behind and one-sided glass seen from behind, side by
/// side before a wall of boxes.
render::Scene four_kinds() {
  render::Scene scene = dark_scene(3);
  scene.environment.color = {0.3f, 0.4f, 0.5f};
  scene.environment.ambient = 1;
  scene.optics.push_back(planar_optic(OpticKind::pane, {-600, 0, 0}, {0.3, 0, std::sqrt(0.91)}, 500));
  scene.optics[0].material.thickness_mm = 40;
  scene.optics.push_back(planar_optic(OpticKind::refractor, {0, 0, 0}, {0, 0.4, std::sqrt(0.84)}, 500));
  scene.optics.push_back(planar_optic(OpticKind::mirror, {600, 0, 0}, {0.3, 0, -std::sqrt(0.91)}, 500));
  scene.optics.push_back(planar_optic(OpticKind::pane, {0, 600, 0}, {0, 0, -1}, 400));
  scene.optics[3].one_sided = true;
  scene.optics[3].material.tint = glm::vec3(0);
  const char* names[] = {"pane", "refractor", "mirror", "one-sided"};
  for (std::size_t i = 0; i < 4; ++i) scene.optics[i].name = names[i];
  cad_import::TriangleMesh walls = empty_mesh();
  for (const float z : {-1500.f, 3000.f})
    for (int k = -4; k <= 4; ++k) {
      walls.materials.emplace_back().base_color = {0.1f * float(k + 5), 0.5f, 0.1f * float(5 - k)};
      add_quad(walls, {400 * float(k) - 190, -1500, z}, {380, 0, 0}, {0, 3000, 0},
               std::uint32_t(walls.materials.size() - 1));
    }
  scene.surroundings.push_back(walls);
  scene.camera = {{100, 200, 1500}, {0, 150, 0}, {0, 1, 0}, 0.9, {kWidth, kHeight}};
  return scene;
}

class PlanarModes : public testing::TestWithParam<render::Mode> {};

TEST_P(PlanarModes, ShowWhatTheRayTracerShows) {
  const render::Scene scene = four_kinds();
  render::Renderer renderer(scene);
  render::FrameOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.geometry = true;
  const render::Frame reference = renderer.render(render::Mode::raytrace, scene.camera, options).frame;
  const render::RenderResult shown = renderer.render(GetParam(), scene.camera, options);
  const render::Comparison comparison = render::compare(reference, shown.frame, scene);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(shown.stats.optics[i].kind, std::string(optics::kind_name(scene.optics[i].kind)));
    const render::OpticError& error = comparison.optics[i];
    EXPECT_EQ(error.outline_pixels, 0u);
    EXPECT_EQ(error.other_path_pixels, 0u);
    if (i == 3) {
      EXPECT_EQ(error.pixels, 0u) << "from behind it is not there";
      continue;
    }
    EXPECT_GT(error.pixels, 200u);
    EXPECT_LT(error.arcmin.max, 0.05) << "floats: 3 m to 2e-4 mm";
  }
  // Glass is traced and so the same; what stands around it rasterised: its edges alone differ.
  std::size_t different = 0;
  for (std::size_t i = 0; i < reference.color.size(); ++i) {
    const bool same = glm::length(reference.color[i] - shown.frame.color[i]) < 2e-3f;  // half floats
    if (reference.optic_id[i] == 0 || reference.optic_id[i] == 1)
      EXPECT_EQ(reference.color[i], shown.frame.color[i]);
    else if (!same)
      ++different;
  }
  EXPECT_LT(different, reference.color.size() / 200);
}

INSTANTIATE_TEST_SUITE_P(Tracing, PlanarModes, testing::Values(render::Mode::hybrid, render::Mode::exact),
                         [](const auto& mode) {
                           return mode.param == render::Mode::exact ? "Exact" : "Hybrid";
                         });

// All samples at once and one by one give the same picture, tilts of rough faces included.
TEST(PlanarModesRough, AccumulatedSamplesAreTheSamePicture) {
  render::Scene scene = four_kinds();
  for (auto& optic : scene.optics) optic.material.roughness_rad = {0.03, 0.01};
  render::Renderer renderer(scene);
  render::FrameOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.samples = 5;
  for (const render::Mode mode : {render::Mode::raytrace, render::Mode::hybrid, render::Mode::exact}) {
    const render::Frame whole = renderer.render(mode, scene.camera, options).frame;
    render::Frame step;
    for (int k = 0; k < 5; ++k) step = renderer.accumulate(mode, scene.camera, options, 1).frame;
    EXPECT_EQ(whole.color, step.color);
  }
}

}  // namespace
}  // namespace catoptra
