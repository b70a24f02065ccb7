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

  /// Draws `scene` with a card that appears two `half_mm` wide at the optic's plane, which is `plane_mm` from
  /// the eye, and stands off the axis so that it does not hide its own image; and measures red and blue.
  void expect_sizes(Scene scene, double size, double half_mm, double plane_mm) {
    const double half = half_mm / std::abs(size);
    const double low = 0.8 * half, high = 1.4 * half;
    const double z = of().u_mm;
    add_card(scene, z, half, low, high);
    const Frame frame =
        Renderer(scene).render(std::get<1>(GetParam()), scene.camera, picture_of(scene, 16)).frame;
    const double per_mm = frame.height / (2 * std::tan(scene.camera.fov_rad / 2) * plane_mm);
    // Upright: above the middle; the mirror does not exchange sides, a lens seen from -z has +x at its left.
    const double right = scene.camera.eye_mm.z > 0 ? 1 : -1;
    const int row = int(std::lround(0.5 * frame.height - 1.1 * half_mm * (size > 0 ? 1 : -1) * per_mm));
    const auto red = extent_in_row(frame, row, 0), blue = extent_in_row(frame, row, 2);
    ASSERT_TRUE(red && blue);
    const double middle = 0.5 * (frame.width - 1);
    const double inverted = size > 0 ? 1 : -1;
    // 1 % of either half.
    const double expected = half_mm * per_mm, within = 0.01 * expected;
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
  expect_sizes(before_concave_mirror(of().eye_mm), size, 17, of().eye_mm);
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
  // By the thin lens; the cases are far from where the thickness decides.
  EXPECT_EQ(kLensRadius_mm / std::abs(kLensRadius_mm - of().u_mm) > 1, of().enlarged);
  expect_sizes(behind_plus_lens(of().eye_mm), size, 2.4, plane);
}

INSTANTIATE_TEST_SUITE_P(
    Focus201, ThickLens,
    ::testing::Combine(::testing::Values(TextbookCase{"Magnifier", 100, 400, true, true},
                                         TextbookCase{"MagnifierFromAfar", 120, 1000, true, true},
                                         TextbookCase{"BetweenFocusAndTwice", 300, 1000, false, true},
                                         TextbookCase{"BeyondTwiceTheFocus", 700, 1000, false, false}),
                       ::testing::Values(Mode::pvrr, Mode::exact, Mode::raytrace)),
    [](const auto& test) {
      return std::string(std::get<0>(test.param).name) + "_" +
             std::string(mode_name(std::get<1>(test.param)));
    });

/// Two plates that cross at x = 0, each `near` from the optic on one side and `far` on the other. The red one
/// is the nearer at x < 0, where it hides the blue one from the optic; seen from the viewpoint, farther off,
/// it would be the other way round.
void add_crossing_plates(Scene& scene, float half, float near, float far, float low, float height) {
  auto& mesh = scene.surroundings.at(0);
  add_quad(mesh, {-half, low, near}, {2 * half, 0, far - near}, {0, height, 0}, kRed);
  add_quad(mesh, {-half, low, far}, {2 * half, 0, near - far}, {0, height, 0}, kBlue);
}

/// The part of the picture, at the optic's plane `plane_mm` from the eye, in which both plates lie one behind
/// the other.
struct Overlap {
  double half_mm, low_mm, high_mm, plane_mm;
};

/// Of those pixels, how many show the plate that is nearer to the optic on their side of the crossing, and
/// how many do not, more than a pixel from it.
struct Order {
  std::size_t right = 0, wrong = 0;
};
Order order_of(const Scene& scene, const Frame& frame, const Overlap& overlap) {
  Order order;
  const double pixel = 2 * std::tan(scene.camera.fov_rad / 2) * overlap.plane_mm / frame.height;
  const double towards_x = scene.camera.eye_mm.z > 0 ? pixel : -pixel;
  for (int row = 0; row < frame.height; ++row)
    for (int column = 0; column < frame.width; ++column) {
      const auto i = std::size_t(row) * std::size_t(frame.width) + std::size_t(column);
      const double x = towards_x * (column - 0.5 * (frame.width - 1)),
                   y = pixel * (0.5 * (frame.height - 1) - row);
      if (y < overlap.low_mm || y > overlap.high_mm || std::abs(x) > overlap.half_mm) continue;
      if (std::abs(x) < pixel) continue;
      const glm::vec4& c = frame.color[i];
      const bool nearer = x < 0 ? c.r > 4 * c.b && c.r > 0.2f : c.b > 4 * c.r && c.b > 0.2f;
      nearer ? ++order.right : ++order.wrong;
    }
  return order;
}

void expect_order(const Scene& scene, const Overlap& overlap) {
  Renderer renderer(scene);
  for (const Mode mode : {Mode::pvrr, Mode::exact, Mode::raytrace}) {
    const Order order =
        order_of(scene, renderer.render(mode, scene.camera, picture_of(scene)).frame, overlap);
    EXPECT_GT(order.right, 1000u) << mode_name(mode);
    EXPECT_EQ(order.wrong, 0u) << mode_name(mode);
  }
}

// Between the far plate's lower and the near plate's upper edge, and as wide as the near one, within a pixel
// or two.
TEST(ZoomingRegion, OfTwoCrossingPlatesTheOneNearerToTheMirrorIsSeen) {
  Scene scene = before_concave_mirror(1500);
  add_crossing_plates(scene, 8, 150, 210, 7, 5);
  const double near = size_on_mirror(150, 1500), far = size_on_mirror(210, 1500);
  expect_order(scene, {8 * near - 0.5, 7 * far + 0.5, 12 * near - 0.5, 1500});
}

TEST(ZoomingRegion, OfTwoCrossingPlatesTheOneNearerToTheLensIsSeen) {
  Scene scene = behind_plus_lens(600);
  add_crossing_plates(scene, 2, 60, 180, -2, 4);
  const double near = size_on_lens(60, 600);
  expect_order(scene, {2 * near - 0.1, -2 * near + 0.1, 2 * near - 0.1, 596});
}

// Seen from behind, as the map is drawn, a surface still shows the side that the optic sees, in the light
// that falls there: the light shines from the mirror, and the box's other sides are dark.
TEST(ZoomingRegion, IsLitOnTheSideThatTheOpticSees) {
  Scene scene = before_concave_mirror(1500);
  scene.environment.ambient = 0.1f;
  scene.lights = {
      {LightKind::directional, glm::normalize(glm::dvec3(0.1, 0.5, 1)), {}, glm::vec3(1), 0.8f, 0, true}};
  add_box(scene.surroundings[0], {-8, 8, 150}, {8, 12, 200}, kYellow);
  Renderer renderer(scene);
  const Frame exact = renderer.render(Mode::raytrace, scene.camera, picture_of(scene)).frame,
              frame = renderer.render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
  std::size_t lit = 0, wrong = 0;
  for (std::size_t i = 0; i < frame.color.size(); ++i) {
    if (exact.optic_id[i] != 0 || exact.position[i].w == 0 || exact.color[i].r < 0.3f) continue;
    ++lit;
    wrong += std::abs(frame.color[i].r - exact.color[i].r) > 0.02f;
  }
  EXPECT_GT(lit, 2000u);
  EXPECT_LT(wrong, lit / 50);  // outlines
}

/// Pixels of the optic that show something with this much red and blue: magenta.
std::size_t magenta_pixels(const Frame& frame) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < frame.color.size(); ++i) {
    const glm::vec4& c = frame.color[i];
    count += frame.optic_id[i] == 0 && c.r > 0.2f && c.b > 0.2f && c.g < 0.1f;
  }
  return count;
}

// The box reaches from close behind the glass far back, and is wider than it; a card before the glass is
// there so that the zooming region is drawn at all.
TEST(ZoomingRegion, NothingBehindTheMirrorShows) {
  for (const double eye : {500.0, 1500.0}) {
    Scene scene = before_concave_mirror(eye);
    add_card(scene, 150, 5, 8, 14);
    add_box(scene.surroundings[0], {-60, -60, -200}, {60, 60, -1}, kMagenta);
    EXPECT_EQ(magenta_pixels(Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene)).frame), 0u);
  }
}

// The eye's side of the lens, and what touches its rim from the side.
TEST(ZoomingRegion, NothingBeforeTheLensShowsThroughIt) {
  Scene scene = behind_plus_lens(600);
  add_card(scene, 80, 1, 1, 2);
  add_quad(scene.surroundings[0], {-20, -20, -kLensThickness_mm - 10}, {14.5f, 0, 0}, {0, 40, 0}, kMagenta);
  add_quad(scene.surroundings[0], {5.5f, -20, -kLensThickness_mm - 10}, {14.5f, 0, 0}, {0, 40, 0}, kMagenta);
  const Frame frame = Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene)).frame;
  EXPECT_EQ(magenta_pixels(frame), 0u);
}

}  // namespace
}  // namespace catoptra::render
