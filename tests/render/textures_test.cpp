#include "render/src/textures.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "cad_import/error.h"
#include "render/src/textures_linear.h"
#include "tests/render/ray_scenes.h"

namespace catoptra {
namespace {

render::Scene scene_with(cad_import::Texture texture) {
  render::Scene scene;
  scene.surroundings.push_back(test::empty_mesh());
  scene.surroundings[0].file = "street.glb";
  scene.surroundings[0].textures.push_back(std::move(texture));
  return scene;
}

std::vector<std::byte> bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<std::byte> bytes;
  for (std::istreambuf_iterator<char> c(in), end; c != end; ++c) bytes.push_back(std::byte(*c));
  return bytes;
}

TEST(Textures, MipLevelsHalveInLinearLight) {
  const test::TemporaryImage image(
      "fine.png", test::painted(8, [](int column, int row) { return glm::vec3(float((column + row) % 2)); }));
  const auto loaded = render::load_textures(scene_with({"fine", image.path().string(), {}}));
  const auto& levels = loaded.textures.at(0).at(0).levels;
  ASSERT_EQ(levels.size(), 4u);
  EXPECT_EQ(levels[0].rgba[0], 0);
  EXPECT_EQ(levels[0].rgba[4], 255);
  for (std::size_t k = 1; k < 4; ++k) {
    EXPECT_EQ(levels[k].width, 8 >> k);
    // Half the light is sRGB 188 (IEC 61966-2-1), not 128.
    for (std::size_t i = 0; i < levels[k].rgba.size(); i += 4) EXPECT_EQ(levels[k].rgba[i], 188);
    EXPECT_EQ(levels[k].rgba[3], 255);
  }
}

TEST(Textures, OddSizesRoundDownAndKeepTheMean) {
  render::Frame picture =
      test::painted(5, [](int column, int) { return glm::vec3(0.1f * float(column + 1)); });
  const test::TemporaryImage image("odd.exr", picture);
  const auto loaded = render::load_textures(scene_with({"odd", image.path().string(), {}}));
  const auto& levels = loaded.textures[0][0].levels;
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[1].width, 2);
  EXPECT_EQ(levels[2].width, 1);
  EXPECT_NEAR(render::srgb_to_linear(float(levels[2].rgba[0]) / 255), 0.3, 0.003)
      << "the mean of 0.1 .. 0.5, in 8 bits";
}

TEST(Textures, TransparentTexelsDoNotBleedIntoMips) {
  render::Frame leaf = test::painted(
      4, [](int column, int) { return column % 2 ? glm::vec3(0) : glm::vec3(0.2f, 0.6f, 0.1f); });
  for (std::size_t i = 0; i < leaf.color.size(); ++i) leaf.color[i].a = i % 2 ? 0.0f : 1.0f;
  const test::TemporaryImage image("leaf.exr", leaf);
  const auto loaded = render::load_textures(scene_with({"leaf", image.path().string(), {}}));
  const auto& level = loaded.textures[0][0].levels.back();
  EXPECT_NEAR(render::srgb_to_linear(float(level.rgba[1]) / 255), 0.6, 0.005);
  EXPECT_EQ(level.rgba[3], 128);
}

TEST(Textures, EmbeddedImagesAreDecodedFromMemory) {
  const test::TemporaryImage image("embedded.png", test::checker(16, 4));
  const auto from_file = render::load_textures(scene_with({"a", image.path().string(), {}}));
  const auto from_memory = render::load_textures(scene_with({"no suffix", "", bytes_of(image.path())}));
  EXPECT_EQ(from_file.textures[0][0].levels[0].rgba, from_memory.textures[0][0].levels[0].rgba);
}

TEST(Textures, MissingImageIsAnErrorThatNamesIt) {
  try {
    (void)render::load_textures(scene_with({"gone.png", "/nowhere/gone.png", {}}));
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.file(), "street.glb");
    EXPECT_EQ(e.entity(), "gone.png");
    EXPECT_NE(e.reason().find("/nowhere/gone.png"), std::string::npos);
  }
}

TEST(Textures, MissingImageThatTheImportWarnedAboutIsWhite) {
  render::Scene scene = scene_with({"gone.png", "/nowhere/gone.png", {}});
  scene.surroundings[0].warnings.push_back("texture gone.png not found");
  const auto loaded = render::load_textures(scene);
  EXPECT_EQ(loaded.textures[0][0].levels[0].rgba, (std::vector<std::uint8_t>{255, 255, 255, 255}));
}

TEST(Textures, BrokenImagesAreErrorsNotCrashes) {
  const test::TemporaryImage image("broken.png", test::checker(64, 4));
  std::vector<std::byte> half = bytes_of(image.path());
  half.resize(half.size() / 2);
  std::vector<std::byte> garbage(100, std::byte{42});
  EXPECT_THROW((void)render::load_textures(scene_with({"half", "", half})), Error);
  EXPECT_THROW((void)render::load_textures(scene_with({"garbage", "", garbage})), Error);
  render::Scene scene;
  scene.environment.sky = "/nowhere/sky.hdr";
  EXPECT_THROW((void)render::load_textures(scene), Error);
}

TEST(Textures, SkyIsFloatAndLinear) {
  const test::TemporaryImage image(
      "sky.exr", test::painted(4, [](int column, int) { return glm::vec3(float(column) * 3); }));
  render::Scene scene;
  scene.environment.sky = image.path().string();
  const render::SkyImage sky = render::load_textures(scene).sky;
  ASSERT_EQ(sky.width, 4);
  EXPECT_FLOAT_EQ(sky.rgb[9], 9);
}

class LinearTexture : public testing::Test {
 protected:
  /// 2 x 1 texels, black and white, with a 1 x 1 level of sRGB 188.
  LinearTexture() : texture_(make()) {}
  static render::MipTexture make() {
    render::MipTexture t;
    t.levels.push_back({2, 1, {0, 0, 0, 255, 255, 255, 255, 255}});
    t.levels.push_back({1, 1, {188, 188, 188, 255}});
    return t;
  }
  float red(float s, float lod, cad_import::TextureWrap wrap) const {
    render::TextureLanes lanes{};
    for (int i = 0; i < render::TextureLanes::kLanes; ++i) {
      lanes.texture[i] = i % 2 ? &texture_ : nullptr;
      lanes.s[i] = s;
      lanes.t[i] = 0.5f;
      lanes.lod[i] = lod;
      lanes.wrap[i] = wrap;
    }
    render::sample_textures(lanes);
    EXPECT_NEAR(lanes.color[0][0], 1, 1e-6) << "no texture: white";
    EXPECT_EQ(lanes.color[1][0], lanes.color[15][0]);
    return lanes.color[1][0];
  }
  render::LinearTexture texture_;
};

TEST_F(LinearTexture, InterpolatesInLinearLight) {
  using cad_import::TextureWrap;
  EXPECT_NEAR(red(0.25f, 0, TextureWrap::clamp), 0, 1e-6);
  EXPECT_NEAR(red(0.5f, 0, TextureWrap::clamp), 0.5, 1e-6);
  EXPECT_NEAR(red(0.75f, 0, TextureWrap::clamp), 1, 1e-6);
  EXPECT_NEAR(red(0.75f, 0.5f, TextureWrap::clamp), 0.75, 0.002)
      << "half way to the level of 188, which is 0.503";
  EXPECT_NEAR(red(0.75f, 9, TextureWrap::clamp), 0.503, 0.001);
}

TEST_F(LinearTexture, WrapsAsAsked) {
  using cad_import::TextureWrap;
  EXPECT_NEAR(red(0, 0, TextureWrap::repeat), 0.5, 1e-6) << "half way between the last and the first texel";
  EXPECT_NEAR(red(-0.25f, 0, TextureWrap::repeat), 1, 1e-6);
  EXPECT_NEAR(red(7.25f, 0, TextureWrap::repeat), 0, 1e-6);
  EXPECT_NEAR(red(-3, 0, TextureWrap::clamp), 0, 1e-6);
  EXPECT_NEAR(red(3, 0, TextureWrap::clamp), 1, 1e-6);
  EXPECT_NEAR(red(1.25f, 0, TextureWrap::mirror), 1, 1e-6);
  EXPECT_NEAR(red(-0.75f, 0, TextureWrap::mirror), 1, 1e-6);
  EXPECT_NEAR(red(2.25f, 0, TextureWrap::mirror), 0, 1e-6);
}

TEST_F(LinearTexture, StrangeCoordinatesAreNoCrash) {
  for (const float s :
       {1e30f, -1e30f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()})
    for (const float lod : {0.0f, 0.5f, s}) EXPECT_GE(red(s, lod, cad_import::TextureWrap::repeat), 0);
}

}  // namespace
}  // namespace catoptra
