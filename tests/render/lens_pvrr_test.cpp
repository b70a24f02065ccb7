// PVRR through lenses against exact paths computed here.
#include <gtest/gtest.h>

#include "optics/spectrum.h"
#include "tests/render/lens_pvrr_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

Frame pvrr(const Scene& scene) {
  return Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
}

// Seen through a plate everything is moved sideways by the same glass path, and nothing stands before the
// wall: what is left is the error of interpolation.
TEST(LensPvrr, PlateBeforeAWallIsExactToATenthOfAPixel) {
  Scene scene = wall_behind_lens(200, 0.4, 1500);
  scene.optics.push_back(lens_of(0, 0, 10, 60, 25));
  const auto errors = wall_errors_px(scene, pvrr(scene), 1500);
  ASSERT_GT(errors.size(), 30000u);
  EXPECT_LT(errors.back(), 0.1);
}

double quantile(const std::vector<double>& ascending, double share) {
  return ascending.at(std::size_t(share * double(ascending.size() - 1)));
}

// Radii in mm: front, back; distance of the eye, field of view.
struct LensCase {
  const char* name;
  double front, back, thickness, eye, fov;
};
// About -4 and +4 D near the eye, as the paper's Figure 12, and +4 D far from it, as Figure 13.
constexpr LensCase kConcave{"concave", 400, 95.2, 2, 70, 0.6}, kConvex{"convex", 95.2, 400, 6, 60, 0.6},
    kFar{"far", 95.2, 400, 6, 760, 0.07};

class LensPvrrCases : public ::testing::TestWithParam<LensCase> {
 protected:
  Scene on_wall(int per_side) const {
    const LensCase& c = GetParam();
    Scene scene = wall_behind_lens(c.eye, c.fov, 3000);
    scene.optics.push_back(lens_of(c.front, c.back, c.thickness, 60, per_side));
    return scene;
  }
};

TEST_P(LensPvrrCases, ErrorFallsWithTheSquareOfTheSpacing) {
  std::vector<double> medians;
  for (const int per_side : {9, 17, 33}) {
    const Scene scene = on_wall(per_side);
    const auto errors = wall_errors_px(scene, pvrr(scene), 3000, 2);
    ASSERT_GT(errors.size(), 5000u);
    medians.push_back(quantile(errors, 0.5));
    if (per_side == 33) {
      EXPECT_LT(quantile(errors, 0.99), 0.5);
    }
  }
  // Half the spacing should leave a quarter of the error, down to what floats resolve.
  for (int k = 0; k < 2; ++k) EXPECT_LT(medians[k + 1], std::max(0.32 * medians[k], 2e-3)) << medians[k];
}

TEST_P(LensPvrrCases, KeptRaysAndMapsChangeNoPicture) {
  const LensCase& c = GetParam();
  Scene scene = room_behind_lens(c.eye, c.fov);
  scene.optics.push_back(lens_of(c.front, c.back, c.thickness, 60, 17, 3, optics::abbe_medium(1.6, 30)));
  Renderer renderer(scene);
  FrameOptions options = picture_of(scene);
  const auto first = renderer.render(Mode::pvrr, scene.camera, options);
  EXPECT_GT(first.stats.rays, 600u);
  const auto kept = renderer.render(Mode::pvrr, scene.camera, options);
  EXPECT_EQ(kept.stats.rays, 0u);
  options.reuse_static = false;
  const auto anew = renderer.render(Mode::pvrr, scene.camera, options);
  EXPECT_EQ(anew.stats.rays, first.stats.rays);
  EXPECT_EQ(kept.frame.color, first.frame.color);
  EXPECT_EQ(anew.frame.color, first.frame.color);
  EXPECT_EQ(kept.frame.position, first.frame.position);
  // The eye turns where it is: the same rays. It moves: others.
  Camera turned = scene.camera;
  turned.target_mm.x += 3;
  options.reuse_static = true;
  EXPECT_EQ(renderer.render(Mode::pvrr, turned, options).stats.rays, 0u);
  turned.eye_mm.x += 3;
  EXPECT_GT(renderer.render(Mode::pvrr, turned, options).stats.rays, 600u);
}

INSTANTIATE_TEST_SUITE_P(Paper, LensPvrrCases, ::testing::Values(kConcave, kConvex, kFar),
                         [](const auto& test) { return std::string(test.param.name); });

/// Mean column of the pixels in the lens whose colour has `channel` above both others by half; -1: none.
double mean_column(const Frame& frame, int channel) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < frame.color.size(); ++i) {
    const glm::vec4& c = frame.color[i];
    if (frame.optic_id[i] < 0 || c[channel] < 2 * c[(channel + 1) % 3] ||
        c[channel] < 2 * c[(channel + 2) % 3])
      continue;
    sum += double(i % std::size_t(frame.width));
    ++count;
  }
  return count > 0 ? sum / count : -1;
}

// Blue is at +x, which this eye has at its left.
TEST(LensPvrr, FarConvexLensTurnsThePictureRound) {
  Scene scene = room_behind_lens(60, 0.9);
  scene.optics.push_back(lens_of(95.2, 400, 6, 60, 25));
  const Frame near = pvrr(scene);
  ASSERT_GT(mean_column(near, 2), 0);
  EXPECT_LT(mean_column(near, 2), mean_column(near, 0));
  scene.camera = room_behind_lens(760, 0.09).camera;
  const Frame far = pvrr(scene);
  ASSERT_GT(mean_column(far, 0), 0);
  EXPECT_GT(mean_column(far, 2), mean_column(far, 0));
}

// An even wall, since a map of a slightly other size has its edges between other texels.
TEST(LensPvrr, SixteenWavelengthsLeaveColoursAloneWithoutDispersion) {
  Scene scene = wall_behind_lens(70, 0.9, 3000);
  scene.surroundings[0].materials[0].base_color = {0.9f, 0.5f, 0.2f};
  scene.optics.push_back(lens_of(400, 95.2, 2, 60, 17, 1));
  const Frame one = pvrr(scene);
  for (const int wavelengths : {3, 16, 21}) {
    scene.optics[0].wavelengths = wavelengths;
    const Frame many = pvrr(scene);
    for (std::size_t i = 0; i < one.color.size(); ++i)
      for (int c = 0; c < 3; ++c)
        // Half floats are added up to six times.
        ASSERT_NEAR(many.color[i][c], one.color[i][c], 0.003) << wavelengths << ", pixel " << i;
  }
}

/// The column, to a fraction, at which `channel` rises through its middle value along the middle row.
double edge_column(const Frame& frame, int channel) {
  const auto value = [&](int x) {
    return frame.color[std::size_t(frame.height / 2) * std::size_t(frame.width) + std::size_t(x)][channel];
  };
  const int from = frame.width / 16, to = frame.width * 15 / 16;
  const float half = 0.5f * (value(from) + value(to));
  for (int x = from; x < to; ++x)
    if ((value(x) - half) * (value(x + 1) - half) <= 0)
      return x + double((half - value(x)) / (value(x + 1) - value(x)));
  return -1;
}

// A black panel that ends at x = -edge: seen through the lens off its axis, where it acts as a prism. The
// exact path of each mask's wavelength tells in which column the edge stands.
TEST(LensPvrr, ThreeMasksSplitAnEdgeAsTheExactPathsDo) {
  constexpr double kWall = 3000, kEdge = -700;
  Scene scene = wall_behind_lens(70, 0.6, float(kWall));
  scene.camera.target_mm = {-13, 0, 0};
  scene.camera.resolution = {1600, 200};
  scene.camera.fov_rad = 0.025;
  add_quad(scene.surroundings[0], {float(kEdge), -9000, float(kWall) - 1}, {-9000, 0, 0}, {0, 18000, 0},
           glm::vec3(0.02f));
  scene.optics.push_back(lens_of(400, 60, 2, 60, 81, 3, optics::abbe_medium(1.6, 30)));
  const Frame frame = pvrr(scene);
  const ExactPaths exact(scene);
  const auto samples = optics::spectral_samples(3);
  std::vector<double> wanted, seen;
  for (int channel = 0; channel < 3; ++channel) {
    double low = 0, high = 1599;  // the exact column by bisection
    while (high - low > 1e-6) {
      const double middle = 0.5 * (low + high);
      const auto at = exact.on_wall(middle, 100, kWall - 1, samples[std::size_t(channel)].wavelength_nm);
      ASSERT_TRUE(at);
      (at->x > kEdge ? low : high) = middle;
    }
    wanted.push_back(low);
    seen.push_back(edge_column(frame, channel));
    // A texel of the largest map spans 1.7 of these pixels, and its edge is the same in all three colours.
    EXPECT_NEAR(seen.back(), wanted.back(), 1.7) << channel;
  }
  // A diverging lens draws the picture towards its axis, and blue, which is bent most, the farthest.
  EXPECT_GT(seen[0], seen[1]);
  EXPECT_GT(seen[1], seen[2]);
  EXPECT_NEAR(seen[0] - seen[2], wanted[0] - wanted[2], 0.02 * (wanted[0] - wanted[2]));
  EXPECT_GT(wanted[0] - wanted[2], 10);
}

// A pair of plates side by side before one eye, a mirror between and beyond them: each lens shows the wall,
// and at 16 wavelengths in several draws neither takes the other's pixels.
TEST(LensPvrr, SeveralLensesAndAMirrorShareAScene) {
  Scene scene = wall_behind_lens(200, 0.5, 1500);
  for (const double x : {-30.0, 30.0}) {
    auto lens = lens_of(0, 0, 2, 100, 9, 16);
    // The exact planes go on beyond the part that each mesh shows.
    for (auto* mesh : {&lens.mesh, &lens.back.mesh}) {
      for (auto& v : mesh->vertices) {
        v.position_mm.x = 0.19 * v.position_mm.x + x;
        v.uv.x = v.position_mm.x;
      }
      for (auto& t : mesh->triangles)
        for (int k = 0; k < 3; ++k) t.uv[k] = mesh->vertices[t.vertices[k]].uv;
    }
    scene.optics.push_back(std::move(lens));
  }
  scene.optics.push_back(conic_mirror(0, 0, 20, 20, 3, 3));
  for (auto& v : scene.optics[2].mesh.vertices) v.position_mm.z += 600;
  for (const Mode mode : {Mode::pvrr, Mode::cubemap}) {
    const Frame frame = Renderer(scene).render(mode, scene.camera, picture_of(scene)).frame;
    std::array<int, 2> pixels{};
    for (std::size_t i = 0; i < frame.color.size(); ++i) {
      const int id = frame.optic_id[i];
      if (id != 0 && id != 1) continue;
      ++pixels[std::size_t(id)];
      // +x is at the left of this eye.
      EXPECT_EQ(id == 1, i % 320 < 160);
      // Two surfaces of index 1.5 let 92 % of the wall's 0.5 through.
      ASSERT_NEAR(frame.color[i].g, 0.46f, 0.01f) << mode_name(mode) << " pixel " << i;
    }
    EXPECT_GT(pixels[0], 3000);
    EXPECT_NEAR(pixels[0], pixels[1], 0.02 * pixels[0]);
  }
}

}  // namespace
}  // namespace catoptra::render
