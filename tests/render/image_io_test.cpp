#include "render/image_io.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "cad_import/error.h"
#include "tests/support/temporary_folder.h"

namespace catoptra {
namespace {

/// A folder of its own for each test, gone afterwards.
class ImageIo : public testing::Test {
 protected:
  static render::Frame frame(bool geometry) {
    render::Frame f;
    f.width = 7;
    f.height = 5;
    for (int i = 0; i < 35; ++i) {
      const auto x = float(i);
      f.color.emplace_back(x / 34, 1 - x / 34, 0.25f, 1);
      if (!geometry) continue;
      f.position.emplace_back(1000.125f * x, -x, 3 * x, i % 3 ? 1 : 0);
      f.surface.emplace_back(x, 2 * x, 0.1f * x);
      f.direction.emplace_back(0.6f, 0, 0.8f);
      f.optic_id.push_back(i % 4 - 1);
    }
    return f;
  }
  std::size_t files() const { return test::files_in(folder_.path()); }

  const test::TemporaryFolder folder_;
};

TEST_F(ImageIo, PngKeepsColorToHalfAStepOfItsEncoding) {
  const render::Frame written = frame(false);
  render::write_image(written, folder_ / "a.png");
  const render::Frame read = render::read_image(folder_ / "a.png");
  ASSERT_EQ(read.width, 7);
  ASSERT_EQ(read.height, 5);
  for (std::size_t i = 0; i < read.color.size(); ++i)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(render::linear_to_srgb(read.color[i][k]), render::linear_to_srgb(written.color[i][k]),
                  0.501 / 255);
  EXPECT_TRUE(read.position.empty());
}

TEST_F(ImageIo, PngClampsColor) {
  render::Frame bright = frame(false);
  bright.color[0] = {7, -3, 0, 1};
  render::write_image(bright, folder_ / "a.png");
  EXPECT_EQ(render::read_image(folder_ / "a.png").color[0], glm::vec4(1, 0, 0, 1));
}

TEST_F(ImageIo, ExrKeepsEverything) {
  const render::Frame written = frame(true);
  render::write_image(written, folder_ / "a.exr", true);
  const render::Frame read = render::read_image(folder_ / "a.exr");
  for (std::size_t i = 0; i < read.color.size(); ++i)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(read.color[i][k], written.color[i][k], 0.0005) << "half floats have 11 bits";
  EXPECT_EQ(read.position, written.position);
  EXPECT_EQ(read.surface, written.surface);
  EXPECT_EQ(read.direction, written.direction);
  EXPECT_EQ(read.optic_id, written.optic_id);
}

TEST_F(ImageIo, ExrWithoutGeometryHasColorOnly) {
  render::write_image(frame(true), folder_ / "a.exr");
  const render::Frame read = render::read_image(folder_ / "a.exr");
  EXPECT_EQ(read.color.size(), 35u);
  EXPECT_TRUE(read.optic_id.empty());
}

TEST_F(ImageIo, ReplacesTheTargetAndLeavesNothingElse) {
  render::write_image(frame(false), folder_ / "a.png");
  render::write_image(frame(false), folder_ / "a.png");
  EXPECT_EQ(files(), 1u);
}

TEST_F(ImageIo, FailuresAreErrorsAndLeaveNothing) {
  EXPECT_THROW(render::write_image(frame(false), folder_ / "a.jpg"), Error);
  EXPECT_THROW(render::write_image(frame(false), folder_ / "no" / "such" / "folder" / "a.png"), Error);
  EXPECT_THROW(render::write_image(frame(false), folder_ / "a.exr", true), Error) << "no geometry to write";
  EXPECT_THROW(render::write_image(render::Frame{}, folder_ / "a.png"), Error);
  EXPECT_THROW((void)render::read_image(folder_ / "gone.png"), Error);
  EXPECT_EQ(files(), 0u);
}

// IEC 61966-2-1: the curve's joint, and a value from its table.
TEST(SrgbTransfer, IsTheStandardsAndItsOwnInverse) {
  EXPECT_NEAR(render::linear_to_srgb(0.0031308f), 0.04045, 1e-6);
  EXPECT_NEAR(render::srgb_to_linear(0.5f), 0.21404, 1e-5);
  for (int i = 0; i <= 255; ++i) {
    const float x = float(i) / 255;
    EXPECT_NEAR(render::linear_to_srgb(render::srgb_to_linear(x)), x, 1e-6);
  }
}

}  // namespace
}  // namespace catoptra
