// What a concave mirror and a plus lens show of things on both sides of where their rays converge, against
// the mirror equation and Gaussian optics.
#include <gtest/gtest.h>

#include "tests/render/zooming_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

struct TextbookCase {
  const char* name;
  double u_mm, eye_mm;     // thing and eye, from the mirror, or from the lens's front
  bool upright, enlarged;  // as the textbook has it
};

void PrintTo(const TextbookCase& c, std::ostream* out) {
  *out << c.name;
}

class Textbook : public ::testing::TestWithParam<std::tuple<TextbookCase, Mode>> {
 protected:
  const TextbookCase& of() const { return std::get<0>(GetParam()); }

  /// Draws `scene` with a card that appears 34 mm wide at the optic's plane and stands off the axis so that
  /// it does not hide its own image, and measures red and blue.
  void expect_sizes(Scene scene, double size, double plane_mm) {
    const double half = 17 / std::abs(size);
    const double low = 13 / std::abs(size), high = 24 / std::abs(size);
    const double z = of().u_mm;
    add_card(scene, z, half, low, high);
    const Frame frame =
        Renderer(scene).render(std::get<1>(GetParam()), scene.camera, picture_of(scene, 16)).frame;
    const double per_mm = frame.height / (2 * std::tan(scene.camera.fov_rad / 2) * plane_mm);
    // Upright: above the middle; the mirror does not exchange sides, a lens seen from -z has +x at its left.
    const double right = scene.camera.eye_mm.z > 0 ? 1 : -1;
    const int row = int(std::lround(0.5 * frame.height - 18.5 * (size > 0 ? 1 : -1) * per_mm));
    const auto red = extent_in_row(frame, row, 0), blue = extent_in_row(frame, row, 2);
    ASSERT_TRUE(red && blue);
    const double middle = 0.5 * (frame.width - 1);
    const double inverted = size > 0 ? 1 : -1;
    // 1 % of either half's 17 mm.
    const double expected = 17 * per_mm, within = 0.01 * expected;
    EXPECT_NEAR(red->right - red->left, expected, within);
    EXPECT_NEAR(blue->right - blue->left, expected, within);
    EXPECT_NEAR(0.5 * (red->left + red->right) - middle, -0.5 * inverted * right * expected, within);
    EXPECT_NEAR(0.5 * (blue->left + blue->right) - middle, 0.5 * inverted * right * expected, within);
  }
};

class MirrorEquation : public Textbook {};

TEST_P(MirrorEquation, SizesWithinOnePercent) {
  const double size = size_on_mirror(of().u_mm, of().eye_mm);
  ASSERT_NEAR(1 / size, mirror_height(of().u_mm, of().eye_mm), 1e-12);
  const double magnification = kZoomFocus_mm / (kZoomFocus_mm - of().u_mm);
  EXPECT_EQ(std::abs(magnification) > 1, of().enlarged);
  EXPECT_EQ(size > 0, of().upright);
  expect_sizes(before_concave_mirror(of().eye_mm), size, of().eye_mm);
}

INSTANTIATE_TEST_SUITE_P(
    Focus300, MirrorEquation,
    ::testing::Combine(::testing::Values(TextbookCase{"InsideFocus", 200, 1500, true, true},
                                         TextbookCase{"CloseToTheGlass", 150, 1500, true, true},
                                         TextbookCase{"BetweenFocusAndCentre", 400, 2400, false, true},
                                         TextbookCase{"BeforeItsImage", 400, 700, true, true},
                                         TextbookCase{"BeyondCentre", 900, 1500, false, false}),
                       ::testing::Values(Mode::pvrr, Mode::exact, Mode::raytrace)),
    [](const auto& test) {
      return std::string(std::get<0>(test.param).name) + "_" +
             std::string(mode_name(std::get<1>(test.param)));
    });

class ThickLens : public Textbook {};

TEST_P(ThickLens, SizesWithinOnePercent) {
  const double size = size_on_lens(of().u_mm, of().eye_mm);
  EXPECT_EQ(size > 0, of().upright);
  const double plane = of().eye_mm - kLensThickness_mm;
  EXPECT_EQ(std::abs(size) > plane / (plane + kLensThickness_mm + of().u_mm), of().enlarged);
  expect_sizes(behind_plus_lens(of().eye_mm), size, plane);
}

INSTANTIATE_TEST_SUITE_P(
    Focus201, ThickLens,
    ::testing::Combine(::testing::Values(TextbookCase{"Magnifier", 100, 400, true, true},
                                         TextbookCase{"MagnifierFromAfar", 120, 1000, true, true},
                                         TextbookCase{"BetweenFocusAndTwice", 300, 1000, false, true},
                                         TextbookCase{"BeyondTwiceTheFocus", 700, 1000, false, true}),
                       ::testing::Values(Mode::pvrr, Mode::exact, Mode::raytrace)),
    [](const auto& test) {
      return std::string(std::get<0>(test.param).name) + "_" +
             std::string(mode_name(std::get<1>(test.param)));
    });

}  // namespace
}  // namespace catoptra::render
