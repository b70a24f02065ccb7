// Damaged scene files are read or refused in one line, never anything else.
#include <gtest/gtest.h>

#include <random>

#include "app/scene_file.h"
#include "cad_import/error.h"
#include "tests/app/test_scene.h"

namespace catoptra::app {
namespace {

constexpr const char* kScene =
    "units = \"cm\"\n[camera]\neye = [0, -70, 15]\nfov_deg = 40\nresolution = [64, 48]\n"
    "[environment]\ncolor = [0.45, 0.6, 0.85]\nambient = 0.3\n"
    "[[light]]\nkind = \"area\"\nposition = [0, 0, 3]\nradius = 0.5\nshadows = false\n"
    "[[surrounding]]\nfile = \"wall.obj\"\ntranslate = [1, 2, 3]\nrotate_deg = [90, 0, 0]\nscale = 2\ncolor "
    "= [1, 0, 0]\n"
    "[render]\nmode = \"pvrr\"\nchord_mm = 0.01\ndepth = 3\n";

/// Replaces, removes, repeats or inserts bytes at a few random places.
std::string damaged(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  const std::string letters = "[]{}\"=.,-+#\n\\0123456789eExnaif\x80\xff";
  for (std::size_t change = 0, changes = 1 + below(4); change < changes && !text.empty(); ++change) {
    const std::size_t at = below(text.size()),
                      length = 1 + below(std::min<std::size_t>(12, text.size() - at));
    const std::string piece = text.substr(at, length);
    switch (below(4)) {
      case 0:
        text[at] = letters[below(letters.size())];
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, piece);
        break;
      default:
        text.insert(at, 1, letters[below(letters.size())]);
    }
  }
  return text;
}

TEST(SceneMutation, DamagedFilesAreReadOrRefused) {
  const unsigned seed = 20261122;
  std::printf("seed %u\n", seed);
  std::mt19937 random(seed);
  const test::TemporaryFolder folder;
  test::write_test_wall(folder);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string text = damaged(kScene, random);
    try {
      const SceneFile file = read_scene_text(text, "scene.toml", folder.path());
      EXPECT_GT(file.scene.camera.resolution.x, 0);
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what() << "\nin\n" << text;
    } catch (const std::exception& other) {
      ADD_FAILURE() << "not a catoptra::Error: " << other.what() << "\nin\n" << text;
    }
  }
  EXPECT_GT(refused, 500);  // most slips are errors; the rest fell on numbers that may as well be others
}

}  // namespace
}  // namespace catoptra::app
