// The paper's claim: every vertex shows exactly what its own ray hits.
#include <gtest/gtest.h>

#include <algorithm>

#include "optics/map_coordinates.h"
#include "optics/reflection.h"
#include "render/comparison.h"
#include "render/renderer.h"
#include "render/src/pvrr_map.h"
#include "tests/render/raster_test_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

/// The angle between the exact outgoing ray of vertex `index` and what the picture shows there, and half a
/// map texel, both in arcmin. The camera aims at the vertex, which so lies at the centre of the picture's
/// middle pixel.
struct VertexError {
  double shown_arcmin, half_texel_arcmin;
};

VertexError error_at_vertex(Renderer& renderer, const Scene& scene, std::size_t index) {
  const auto& vertex = scene.optics[0].mesh.vertices[index];
  Camera camera = scene.camera;
  camera.target_mm = vertex.position_mm;
  camera.resolution = {321, 241};
  FrameOptions options = picture_of(scene);
  options.width = 321;
  options.height = 241;
  const RenderResult result = renderer.render(Mode::pvrr, camera, options);
  const std::size_t middle = 120 * 321 + 160;
  EXPECT_EQ(result.frame.optic_id.at(middle), 0);
  EXPECT_LT(glm::distance(glm::dvec3(result.frame.surface[middle]), vertex.position_mm), 1e-3);
  const glm::dvec3 exact = optics::reflect(glm::normalize(vertex.position_mm - camera.eye_mm),
                                           vertex.normal);  // closed-form normal
  // The map is at least as fine as the picture's pixels by area (1.5 texels a pixel); its texel is taken from
  // its field of view and the smallest number of texels that settings allow for this picture: that of its
  // pixels on the screen.
  const PatchStats& patch = result.stats.optics.at(0).patches.at(0);
  const RasterView view = camera_view(camera, {321, 241});
  double left = 1e9, right = -1e9;
  for (const auto& v : scene.optics[0].mesh.vertices) {
    left = std::min(left, view.pixel(v.position_mm).x);
    right = std::max(right, view.pixel(v.position_mm).x);
  }
  const double texels = scene.settings.texels_per_pixel * (right - left);
  return {angle_arcmin(exact, shown_direction(result.frame, middle, vertex.position_mm)),
          0.5 * patch.fov_rad[0] / texels * 180 * 60 / 3.14159265358979};
}

class PvrrVertices : public ::testing::TestWithParam<double> {};

TEST_P(PvrrVertices, ShowTheirExactHitWithinHalfATexel) {
  Scene scene = room();
  scene.camera.eye_mm = {-150, 60, 800};
  scene.optics.push_back(conic_mirror(GetParam(), 0, 170, 110, 7, 7));
  Renderer renderer(scene);
  // Inner vertices; on the border a pixel's centre may fall beside the optic.
  for (int row = 1; row < 6; ++row)
    for (int column = 1; column < 6; ++column) {
      const std::size_t index = std::size_t(7 * row + column);
      const VertexError error = error_at_vertex(renderer, scene, index);
      EXPECT_LT(error.shown_arcmin, error.half_texel_arcmin) << "vertex " << index;
    }
}

INSTANTIATE_TEST_SUITE_P(Radii, PvrrVertices, ::testing::Values(0.0, 3000.0, 1200.0, 300.0, -3000.0),
                         [](const auto& suite) {
                           return (suite.param < 0 ? "Concave" : "R") +
                                  std::to_string(int(std::abs(suite.param)));
                         });

TEST(PvrrMapSize, FollowsTheOpticsSizeOnTheScreen) {
  const optics::Optic optic = conic_mirror(0, 0, 100, 50, 2, 2);
  optics::VirtualView view;
  view.left = -0.2, view.right_side = 0.2, view.bottom = -0.1, view.top = 0.1;
  const std::vector<glm::dvec3> coordinates{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  const auto size_for = [&](double width, double height, double texels_per_pixel) {
    const std::vector<glm::dvec3> pixels{
        {10, 10, 1}, {10 + width, 10, 1}, {10, 10 + height, 1}, {10 + width, 10 + height, 1}};
    return choose_map_size(optic, pixels, coordinates, view, {4000, 4000}, texels_per_pixel);
  };
  // Rounded up to steps of 32 texels.
  EXPECT_EQ(size_for(320, 160, 1).texels, glm::ivec2(320, 160));
  EXPECT_EQ(size_for(320, 160, 2).texels, glm::ivec2(640, 320));
  EXPECT_NEAR(size_for(320, 160, 2).texels_per_pixel, 2, 1e-12);
  // Beyond the cap the map gets coarser than asked for, and says so.
  EXPECT_EQ(size_for(3200, 1600, 3).texels, glm::ivec2(4096, 4096));
  EXPECT_EQ(size_for(0, 0, 1).texels, glm::ivec2(16, 16)) << "not on the screen";
}

TEST(PvrrOverlay, RedBallsLieOnTheVerticesInTheMirror) {
  Scene scene = room();
  scene.camera.eye_mm = {-150, 60, 800};
  scene.optics.push_back(conic_mirror(1200, 0, 170, 110, 5, 5));
  FrameOptions options = picture_of(scene);
  options.overlay_vertices = true;
  const Frame frame = Renderer(scene).render(Mode::pvrr, scene.camera, options).frame;
  const RasterView view = camera_view(scene.camera, {options.width, options.height});
  int red = 0;
  for (int row = 1; row < 4; ++row)
    for (int column = 1; column < 4; ++column) {
      const glm::dvec3 pixel =
          view.pixel(scene.optics[0].mesh.vertices[std::size_t(5 * row + column)].position_mm);
      // To the lower right, where no mesh line runs, the ball of four pixels' radius is plain.
      const std::size_t i = std::size_t(pixel.y + 1.5) * std::size_t(frame.width) + std::size_t(pixel.x + 2);
      red += frame.color[i].r > 3 * frame.color[i].g && frame.color[i].r > 3 * frame.color[i].b;
    }
  EXPECT_EQ(red, 9);
}

TEST(PvrrMovedOptic, IsDrawnWhereItIsNow) {
  Scene scene = room();
  scene.optics.push_back(conic_mirror(1200, 0, 170, 110, 5, 5));
  Renderer renderer(scene);
  (void)renderer.render(Mode::pvrr, scene.camera, picture_of(scene));
  scene.optics[0] = conic_mirror(600, 0, 120, 90, 6, 6);
  renderer.optic_changed(0);
  const Frame after = renderer.render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
  const Frame fresh = Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
  EXPECT_EQ(after.color, fresh.color);
  EXPECT_EQ(after.optic_id, fresh.optic_id);
}

}  // namespace
}  // namespace catoptra::render
