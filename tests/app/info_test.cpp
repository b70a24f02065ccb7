// catoptra info and catoptra mirror make.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/command_runner.h"
#include "tests/app/test_scene.h"

namespace catoptra::test {
namespace {

using nlohmann::json;

TEST(Info, MirrorMadeIsTheMirrorRead) {
  const TemporaryFolder folder;
  const std::string file = (folder / "convex.step").string();
  const CommandResult made = run_catoptra({"mirror", "make", "--radius", "1200", "--width", "170", "--height",
                                           "110", "--thickness", "3", "-o", file});
  ASSERT_EQ(made.code, 0) << made.errors;
  EXPECT_EQ(files_in(folder.path()), 1u) << "no temporary file is left";

  const CommandResult result = run_catoptra({"info", file, "--json"});
  ASSERT_EQ(result.code, 0) << result.errors;
  const json info = json::parse(result.output).at("files").at(0);
  EXPECT_EQ(info.at("format"), "STEP");
  EXPECT_EQ(info.at("unit"), "mm");
  ASSERT_EQ(info.at("bodies").size(), 1u);
  EXPECT_TRUE(info.at("bodies").at(0).at("solid").get<bool>());
  EXPECT_FALSE(info.at("bodies").at(0).contains("lens")) << "a mirror glass is no lens";
  std::set<std::string> names;
  for (const json& face : info.at("bodies").at(0).at("faces")) {
    names.insert(face.at("name").get<std::string>());
    if (face.at("name") != "Glass") continue;
    EXPECT_EQ(face.at("surface"), "bspline");
    EXPECT_FALSE(face.at("planar").get<bool>());
    // Between the flat rectangle and the same with the slope of its corner (1 / cos 4.84 degrees) everywhere.
    EXPECT_GT(face.at("area_mm2").get<double>(), 170 * 110);
    EXPECT_LT(face.at("area_mm2").get<double>(), 170 * 110 * 1.0036);
  }
  EXPECT_EQ(names, (std::set<std::string>{"Glass", "Back", "Edge"}));
  // Sag at the corner of a sphere R 1200: r^2 / (R + sqrt(R^2 - r^2)), r^2 = 85^2 + 55^2.
  const double r2 = 85.0 * 85 + 55.0 * 55, sag = r2 / (1200 + std::sqrt(1200.0 * 1200 - r2));
  const json size = info.at("bounding_box_mm").at("size");
  EXPECT_NEAR(size.at(0).get<double>(), 170, 1e-3);
  EXPECT_NEAR(size.at(1).get<double>(), 110, 1e-3);
  EXPECT_NEAR(size.at(2).get<double>(), sag + 3, 1e-3);
}

TEST(Info, NegativeRadiusIsAnOptionValue) {
  const TemporaryFolder folder;
  const std::string file = (folder / "concave.step").string();
  ASSERT_EQ(run_catoptra({"mirror", "make", "--radius", "-600", "-o", file}).code, 0);
  const json info = json::parse(run_catoptra({"info", file, "--json"}).output).at("files").at(0);
  EXPECT_GT(info.at("bounding_box_mm").at("max").at(2).get<double>(), 1)
      << "the rim of a concave glass stands before its pole";
}

TEST(Info, OutlineFromFile) {
  const TemporaryFolder folder;
  const std::string outline = folder.write("outline.txt", "# a triangle\n-50 -30\n50 -30\n0 40\n").string();
  const std::string file = (folder / "triangle.step").string();
  const CommandResult made =
      run_catoptra({"mirror", "make", "--radius", "0", "--outline", outline, "-o", file});
  ASSERT_EQ(made.code, 0) << made.errors;
  const json info = json::parse(run_catoptra({"info", file, "--json"}).output).at("files").at(0);
  for (const json& face : info.at("bodies").at(0).at("faces"))
    if (face.at("name") == "Glass") {
      EXPECT_NEAR(face.at("area_mm2").get<double>(), 100 * 70 / 2, 0.01);
    }
}

TEST(Info, MeshesTellTrianglesAndMaterials) {
  const TemporaryFolder folder;
  write_test_wall(folder);
  const json info =
      json::parse(run_catoptra({"info", (folder / "wall.obj").string(), "--json"}).output).at("files").at(0);
  EXPECT_EQ(info.at("format"), "OBJ");
  EXPECT_EQ(info.at("triangles"), 4);
  EXPECT_GE(info.at("materials").size(), 2u);
  EXPECT_TRUE(info.at("textures").empty());
  EXPECT_NEAR(info.at("bounding_box_mm").at("size").at(0).get<double>(), 6000, 1e-3);
}

TEST(Info, OneBadFileHidesNoOther) {
  const TemporaryFolder folder;
  write_test_wall(folder);
  const std::string wall = (folder / "wall.obj").string(), empty = folder.write("empty.step", "").string();
  const CommandResult result = run_catoptra({"info", empty, wall, "--json"});
  EXPECT_EQ(result.code, 1);
  const json files = json::parse(result.output).at("files");
  ASSERT_EQ(files.size(), 2u);
  EXPECT_TRUE(files.at(0).contains("error"));
  EXPECT_EQ(files.at(1).at("triangles"), 4);
  EXPECT_NE(result.errors.find("empty.step"), std::string::npos);
  EXPECT_NE(run_catoptra({"info", empty, wall}).output.find("4 triangles"), std::string::npos);
}

TEST(Info, UnitCanBeOverridden) {
  const TemporaryFolder folder;
  write_test_wall(folder);
  const std::string wall = (folder / "wall.obj").string();
  const json info =
      json::parse(run_catoptra({"info", wall, "--unit", "cm", "--json"}).output).at("files").at(0);
  EXPECT_NEAR(info.at("bounding_box_mm").at("size").at(0).get<double>(), 60000, 1e-2);
  EXPECT_EQ(run_catoptra({"info", wall, "--unit", "ell"}).code, 2);
}

}  // namespace
}  // namespace catoptra::test
