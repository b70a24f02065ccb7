#include "app/src/error_picture.h"

#include <gtest/gtest.h>

namespace catoptra::app {
namespace {

render::Frame grey_frame(int width, int height) {
  render::Frame frame;
  frame.width = width;
  frame.height = height;
  frame.color.assign(std::size_t(width) * std::size_t(height), glm::vec4(0.5f, 0.5f, 0.5f, 1));
  return frame;
}

TEST(ErrorPicture, ColoursRunFromBlueOverGreenToRed) {
  const glm::vec3 low = error_color(0.03), middle = error_color(1), high = error_color(50);
  EXPECT_GT(low.b, low.r);
  EXPECT_GT(middle.g, middle.r);
  EXPECT_GT(middle.g, middle.b);
  EXPECT_GT(high.r, high.g);
  EXPECT_GT(high.r, high.b);
}

TEST(ErrorPicture, ErrorsBeyondTheScaleTakeItsEnds) {
  EXPECT_EQ(error_color(0), error_color(kErrorScaleMin_arcmin));
  EXPECT_EQ(error_color(1e6), error_color(kErrorScaleMax_arcmin));
}

TEST(ErrorPicture, PixelsWithoutErrorStayGrey) {
  std::vector<float> errors(16, -1.0f);
  errors[5] = 1;
  const render::Frame picture = error_picture(grey_frame(4, 4), errors);
  EXPECT_EQ(glm::vec3(picture.color[5]), error_color(1));
  EXPECT_EQ(picture.color[0].r, picture.color[0].g);
  EXPECT_EQ(picture.color[0].g, picture.color[0].b);
  EXPECT_LT(picture.color[0].g, 0.5f);
}

/// The bar's left end is drawn in the lowest colour, and no letter is drawn where the picture has no room for
/// it.
TEST(ErrorPicture, LegendShowsTheScaleWhereThereIsRoom) {
  const auto with_color = [](const render::Frame& frame, glm::vec3 color) {
    std::size_t count = 0;
    for (const glm::vec4& c : frame.color) count += glm::vec3(c) == color;
    return count;
  };
  const render::Frame large = error_picture(grey_frame(640, 480), std::vector<float>(640 * 480, -1.0f));
  EXPECT_GT(with_color(large, glm::vec3(1)), 100u);
  const render::Frame small = error_picture(grey_frame(64, 48), std::vector<float>(64 * 48, -1.0f));
  EXPECT_EQ(with_color(small, glm::vec3(1)), 0u);
}

}  // namespace
}  // namespace catoptra::app
