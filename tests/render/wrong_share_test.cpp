// What share of mode pvrr's pixels mode auto calls wrong, on frames made by hand.
#include "render/src/wrong_share.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "render/src/pixel_error.h"

namespace catoptra::render {
namespace {

constexpr int kWide = 20, kHigh = 10;
// From one pixel to the next the ray turns by so much.
constexpr double kPixel_rad = 10 / kArcminPerRad;

/// A mirror in the plane z = 0 fills the picture; each pixel's ray goes up from its own point, 1 mm from the
/// last, and meets a ceiling `height_mm` above.
Frame ceiling(double height_mm = 1000) {
  Frame frame;
  frame.width = kWide;
  frame.height = kHigh;
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x) {
      const glm::dvec3 surface(x, y, 0),
          direction = glm::normalize(glm::dvec3(kPixel_rad * x, kPixel_rad * y, 1));
      frame.color.emplace_back(0, 0, 0, 1);
      frame.surface.emplace_back(surface);
      frame.direction.emplace_back(direction);
      frame.position.emplace_back(glm::vec3(surface + height_mm / direction.z * direction), 1);
      frame.optic_id.push_back(0);
    }
  return frame;
}

/// Moves what pixel `i` shows along the ceiling, by `rad` as seen from the mirror.
void turn(Frame& frame, std::size_t i, double rad) {
  frame.position[i].x += float(rad * frame.position[i].z);
}

constexpr std::size_t kMiddle = 5 * kWide + 10;

TEST(WrongShare, TheSamePictureIsRight) {
  EXPECT_EQ(wrong_share(ceiling(), ceiling()), 0);
}

TEST(WrongShare, CountsWhatIsOffByMoreThanHalfAPixel) {
  // A pixel is 10 arcmin of direction, and another mm of the mirror: 3.4 arcmin at 1 m.
  Frame shown = ceiling();
  turn(shown, kMiddle, 0.3 * kPixel_rad);
  EXPECT_EQ(wrong_share(ceiling(), shown), 0);
  turn(shown, kMiddle, 1.0 * kPixel_rad);
  EXPECT_NEAR(wrong_share(ceiling(), shown), 1.0 / (kWide * kHigh), 1e-12);
}

TEST(WrongShare, CountsAnotherOpticAndNone) {
  Frame shown = ceiling();
  shown.optic_id[kMiddle] = -1;
  shown.optic_id[kMiddle + 2] = 1;
  EXPECT_NEAR(wrong_share(ceiling(), shown), 2.0 / (kWide * kHigh), 1e-12);
}

TEST(WrongShare, CountsWhatIsClearlyNearerOrFarther) {
  Frame shown = ceiling();
  const auto put_at = [&](double factor) {
    const glm::vec3 along = glm::vec3(ceiling().position[kMiddle]) - shown.surface[kMiddle];
    shown.position[kMiddle] = glm::vec4(shown.surface[kMiddle] + float(factor) * along, 1);
  };
  put_at(1.02);  // a surface at a grazing angle, half a pixel on
  EXPECT_EQ(wrong_share(ceiling(), shown), 0);
  for (const double factor : {0.5, 2.0}) {  // in the same direction
    put_at(factor);
    EXPECT_NEAR(wrong_share(ceiling(), shown), 1.0 / (kWide * kHigh), 1e-12) << factor;
  }
}

TEST(WrongShare, CountsSkyInPlaceOfThings) {
  Frame shown = ceiling();
  shown.position[kMiddle] = glm::vec4(shown.direction[kMiddle], 0);
  EXPECT_NEAR(wrong_share(ceiling(), shown), 1.0 / (kWide * kHigh), 1e-12);
}

TEST(WrongShare, OnlyPixelsOfOpticsCount) {
  Frame exact = ceiling(), shown = ceiling();
  for (std::size_t i = 0; i < exact.optic_id.size() / 2; ++i) exact.optic_id[i] = shown.optic_id[i] = -1;
  turn(shown, 0, 1);  // no pixel of an optic
  EXPECT_EQ(wrong_share(exact, shown), 0);
  turn(shown, kMiddle, kPixel_rad);
  EXPECT_NEAR(wrong_share(exact, shown), 2.0 / (kWide * kHigh), 1e-12);
  exact.optic_id.assign(exact.optic_id.size(), -1);
  EXPECT_EQ(wrong_share(exact, shown), 0) << "without optics nothing is wrong";
}

}  // namespace
}  // namespace catoptra::render
