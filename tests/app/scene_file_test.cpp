#include "app/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "app/src/mirror_faces.h"
#include "cad_import/import.h"
#include "tests/app/test_scene.h"

namespace catoptra::app {
namespace {

using test::TemporaryFolder;

render::Scene read(const std::string& text, const TemporaryFolder& folder) {
  return read_scene_text(text, "scene.toml", folder.path()).scene;
}

TEST(SceneFile, EmptyFileHasTheDocumentedDefaults) {
  const TemporaryFolder folder;
  const render::Scene scene = read("", folder);
  EXPECT_EQ(scene.camera.eye_mm, glm::dvec3(0, -700, 150));
  EXPECT_EQ(scene.camera.resolution, glm::ivec2(1280, 720));
  EXPECT_EQ(scene.settings.mode, "pvrr");
  EXPECT_EQ(scene.settings.chord_mm, 0.01);
  EXPECT_FLOAT_EQ(scene.environment.ambient, 0.3f);
  EXPECT_TRUE(scene.optics.empty());
}

TEST(SceneFile, LengthsAreInItsUnit) {
  const TemporaryFolder folder;
  const render::Scene scene = read(
      "units = \"m\"\n[camera]\neye = [0, -0.7, 0.15]\ntarget = [0.1, 0, 0]\nfov_deg = 30\n"
      "[[light]]\nkind = \"area\"\nposition = [0, 0, 2]\nradius = 0.5\n",
      folder);
  EXPECT_NEAR(glm::distance(scene.camera.eye_mm, glm::dvec3(0, -700, 150)), 0, 1e-9);
  EXPECT_NEAR(scene.camera.target_mm.x, 100, 1e-9);
  EXPECT_NEAR(scene.camera.fov_rad, glm::radians(30.0), 1e-12);
  EXPECT_NEAR(scene.lights.at(0).position_mm.z, 2000, 1e-9);
  EXPECT_NEAR(scene.lights.at(0).radius_mm, 500, 1e-9);
}

TEST(SceneFile, LightDirectionIsMadeUnit) {
  const TemporaryFolder folder;
  const render::Scene scene =
      read("[[light]]\ndirection = [0, 3, -4]\nintensity = 2\nshadows = false\n", folder);
  EXPECT_NEAR(glm::distance(scene.lights.at(0).direction, glm::dvec3(0, 0.6, -0.8)), 0, 1e-12);
  EXPECT_FLOAT_EQ(scene.lights.at(0).intensity, 2);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(SceneFile, LightWithShadowsSaysWhatItLeavesOut) {
  const TemporaryFolder folder;
  test::write_test_mirror(folder, 400);
  const std::string mirror =
      "[[mirror]]\nname = \"door\"\nfile = \"mirror.step\"\nfaces = [\"Glass\"]\n";
  const auto warned = [&](const std::string& text) {
    const render::Scene scene = read(text, folder);
    return std::ranges::count(scene.warnings, "light reflected or refracted by door is not simulated");
  };
  EXPECT_EQ(warned("[[light]]\n[[light]]\n" + mirror), 1);
  EXPECT_EQ(warned("[[light]]\nshadows = false\n" + mirror), 0);
  EXPECT_TRUE(read("[[light]]\nradius = 3\n[render]\nsoft_shadow_samples = 4\n", folder).warnings.empty());
}

/// A triangle with a corner at (1, 0, 0): turned by 90 degrees about x (no change), then y (to -z), then z
/// (no change), scaled by 2 and moved. About x last it would end at +y.
TEST(SceneFile, RotatesAboutXThenYThenZThenMoves) {
  const TemporaryFolder folder;
  folder.write("t.obj", "v 1 0 0\nv 1 1 0\nv 1 0 1\nf 1 2 3\n");
  const render::Scene scene = read(
      "[[surrounding]]\nfile = \"t.obj\"\nscale = 2\nrotate_deg = [90, 90, 90]\ntranslate = [10, 20, "
      "30]\nunit = \"cm\"\n",
      folder);
  // x: (1,0,0) -> (1,0,0); y: -> (0,0,-1); z: -> (0,0,-1). Times 2 cm = 20 mm.
  const glm::vec3 expected(10, 20, 30 - 20);
  float nearest = 1e9f;
  for (const glm::vec3& p : scene.surroundings.at(0).positions)
    nearest = std::min(nearest, glm::distance(p, expected));
  EXPECT_LT(nearest, 1e-4f);  // float positions of tens of mm
}

TEST(SceneFile, MirrorTakesNamedFacesAndLeavesTheRestToTheSurroundings) {
  const TemporaryFolder folder;
  test::write_test_mirror(folder, 400);
  const SceneFile file = read_scene_text(
      "[[mirror]]\nname = \"door\"\nfile = \"mirror.step\"\nfaces = [\"Glass\"]\nreflectance = [0.9, 0.8, "
      "0.7]\ngrid = [7, 7]\n"
      "flip = true\n",
      "scene.toml", folder.path());
  const auto& optic = file.scene.optics.at(0);
  EXPECT_EQ(optic.name, "door");
  ASSERT_EQ(optic.faces.size(), 1u);
  EXPECT_EQ(optic.faces[0].name, "Glass");
  EXPECT_EQ(optic.mesh.vertices.size(), 49u);
  EXPECT_EQ(optic.reflectance, glm::vec3(0.9f, 0.8f, 0.7f));
  EXPECT_TRUE(optic.flip);
  EXPECT_EQ(file.scene.surroundings.size(), 1u);
  EXPECT_EQ(file.optic_sources.at(0).faces.size(), 1u);
}

TEST(SceneFile, TwoMirrorsOfOneFileShareItsRemainingFaces) {
  const TemporaryFolder folder;
  test::write_test_mirror(folder, 400);
  const render::Scene scene = read(
      "[[mirror]]\nfile = \"mirror.step\"\nfaces = [\"Glass\"]\n[[mirror]]\nfile = \"mirror.step\"\nfaces = "
      "[\"Back\"]\n",
      folder);
  ASSERT_EQ(scene.optics.size(), 2u);
  EXPECT_NE(scene.optics[0].name, scene.optics[1].name);
  EXPECT_EQ(scene.surroundings.size(), 1u);  // the edge, once
}

TEST(SceneFile, CoatingByName) {
  const TemporaryFolder folder;
  test::write_test_mirror(folder, 400);
  const render::Scene scene =
      read("[[mirror]]\nfile = \"mirror.step\"\nfaces = [\"Glass\"]\nreflectance = \"chromium\"\n", folder);
  EXPECT_NEAR(scene.optics.at(0).reflectance.g, 0.555, 1e-3);  // Johnson and Christy 1974
}

/// By default the largest curved group: front and back of a thin glass are nearly equal, which the warning
/// says.
TEST(SceneFile, DefaultMirrorIsTheLargestCurvedGroup) {
  const TemporaryFolder folder;
  test::write_test_mirror(folder, 400);
  const render::Scene scene = read("[[mirror]]\nfile = \"mirror.step\"\n", folder);
  ASSERT_EQ(scene.optics.at(0).faces.size(), 1u);
  EXPECT_EQ(scene.optics[0].faces[0].name, "Glass");
  bool told = false;
  for (const std::string& warning : scene.warnings)
    told = told || warning.find("nearly as large") != std::string::npos;
  EXPECT_TRUE(told);
}

TEST(SceneFile, FlatGlassTakesItsLargestFace) {
  const TemporaryFolder folder;
  test::write_test_mirror(folder, 0);
  const render::Scene scene = read("[[mirror]]\nfile = \"mirror.step\"\n", folder);
  ASSERT_EQ(scene.optics.at(0).faces.size(), 1u);
  EXPECT_NEAR(scene.optics[0].faces[0].area_mm2, 80 * 60, 1e-3);
}

TEST(MirrorFaces, SelectedByNameIdIndexAndBody) {
  const TemporaryFolder folder;
  const auto model = cad_import::import_cad(test::write_test_mirror(folder, 400));
  for (const auto& face : model.faces) {
    const FaceSelector by_id = face.id, by_index = face.index;
    EXPECT_EQ(select_faces(model, {&by_id, 1}), std::vector<int>{face.index});
    EXPECT_EQ(select_faces(model, {&by_index, 1}), std::vector<int>{face.index});
  }
  const std::vector<FaceSelector> both{std::string("Glass"), std::string("Back")};
  EXPECT_EQ(select_faces(model, both).size(), 2u);
}

}  // namespace
}  // namespace catoptra::app
