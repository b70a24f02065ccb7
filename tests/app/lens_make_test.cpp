// catoptra lens make, and what catoptra info says of its lenses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/command_runner.h"
#include "tests/app/test_scene.h"

namespace catoptra::test {
namespace {

using nlohmann::json;

TEST(LensMake, InfoSeesTheLensThatWasOrdered) {
  const TemporaryFolder folder;
  const std::string file = (folder / "minus.step").string();
  // Thick lens: F1 / (1 - t / n F1) + F2 with F1 = 6, F2 = -10, n = 1.5, t = 2 mm is -3.951613 D.
  const CommandResult made =
      run_catoptra({"lens", "make", "--sph", "-3.951613", "--index", "1.5", "--front-curve", "6",
                    "--center-thickness", "2", "--diameter", "60", "-o", file});
  ASSERT_EQ(made.code, 0) << made.errors;
  EXPECT_NE(made.output.find("thickness 2 mm at the center"), std::string::npos) << made.output;
  EXPECT_EQ(files_in(folder.path()), 1u) << "no temporary file is left";

  const CommandResult result = run_catoptra({"info", file, "--json"});
  ASSERT_EQ(result.code, 0) << result.errors;
  const json body = json::parse(result.output).at("files").at(0).at("bodies").at(0);
  std::set<std::string> names;
  for (const json& face : body.at("faces")) names.insert(face.at("name").get<std::string>());
  EXPECT_EQ(names, (std::set<std::string>{"front", "back", "rim"}));
  const json lens = body.at("lens");
  EXPECT_EQ(lens.at("axis"), json({0.0, 0.0, 1.0}));
  EXPECT_NEAR(lens.at("center_thickness_mm").get<double>(), 2, 1e-6);
  for (const std::size_t i : {0u, 1u}) {
    EXPECT_NEAR(lens.at("front_vertex_curvature").at(i).get<double>(), 6.0 / 500, 1e-6);
    EXPECT_NEAR(lens.at("back_vertex_curvature").at(i).get<double>(), -10.0 / 500, 1e-6);
  }
  EXPECT_NE(run_catoptra({"info", file}).output.find("looks like a lens"), std::string::npos);
}

TEST(LensMake, OptionsChooseMaterialOutlineAndForm) {
  const TemporaryFolder folder;
  const std::string outline = folder.write("frame.txt", "-25 -18\n25 -18\n25 18\n-25 18\n").string();
  const std::string file = (folder / "lens.step").string();
  const CommandResult made = run_catoptra(
      {"lens",    "make", "--sph",      "1",   "--cyl",      "-0.5",  "--axis",    "175",   "--add", "2",
       "--prism", "1",    "--base-deg", "270", "--material", "CR-39", "--outline", outline, "-o",    file});
  ASSERT_EQ(made.code, 0) << made.errors;
  const json info = json::parse(run_catoptra({"info", file, "--json"}).output).at("files").at(0);
  EXPECT_EQ(info.at("bodies").at(0).at("faces").size(), 6u) << "two sides and four straight walls";
  EXPECT_NEAR(info.at("bounding_box_mm").at("size").at(0).get<double>(), 50, 1e-3);
  const CommandResult asphere = run_catoptra({"lens", "make", "--sph", "5", "--front", "asphere", "--conic",
                                              "-0.8", "--asphere", "-1e-8,2e-12", "--back-conic", "-0.2",
                                              "--edge-thickness", "1.5", "--diameter", "56", "-o", file});
  ASSERT_EQ(asphere.code, 0) << asphere.errors;
  EXPECT_NE(asphere.output.find("1.5 to 1.5 mm at the edge"), std::string::npos) << asphere.output;
}

TEST(LensMake, BackIsToricUnlessAskedOtherwise) {
  const TemporaryFolder folder;
  const auto told = [&](std::vector<std::string> options) {
    std::vector<std::string> arguments{"lens", "make", "--sph", "-2", "-o", (folder / "lens.step").string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const CommandResult made = run_catoptra(arguments);
    EXPECT_EQ(made.code, 0) << made.errors;
    const auto at = made.output.find("back ");
    return made.output.substr(at, made.output.find(',', at) - at);
  };
  EXPECT_EQ(told({}), "back spherical");
  EXPECT_EQ(told({"--cyl", "-2"}), "back toric");
  EXPECT_EQ(told({"--cyl", "-2", "--back", "biconic"}), "back biconic");
  EXPECT_EQ(told({"--cyl", "-2", "--back-conic", "-0.5"}), "back biconic");
}

TEST(LensMake, WhatCannotBeMadeIsOneLineAndNoFile) {
  const TemporaryFolder folder;
  const std::string file = (folder / "bad.step").string();
  struct Wrong {
    std::vector<std::string> options;
    int code;  ///< 2: the value is wrong by itself; 1: no lens can be made of them together
    std::string part;
  };
  const std::vector<Wrong> wrong{
      {{"--index", "1"}, 2, "--index: 1 is not above 1"},
      {{"--index", "0.9"}, 2, "--index: 0.9 is not above 1"},
      {{"--center-thickness", "0"}, 2, "--center-thickness: 0 is not above 0"},
      {{"--center-thickness", "-2"}, 2, "--center-thickness: -2 is not above 0"},
      {{"--axis", "200", "--cyl", "-1"}, 2, "--axis: 200 is not between 0 and 180"},
      {{"--material", "CR-93"}, 2, "CR-39"},
      {{"--sph", "6", "--center-thickness", "1.5"}, 1, "cross"},
      {{"--front-curve", "20"}, 1, "radius of 25 mm"},
      {{"--front-curve", "10", "--sph", "-12", "--cyl", "-9"}, 1, "back curve: its radius of"},
      {{"--front", "sphere", "--add", "2"}, 1, "addition: 2"},
      {{"--outline", (folder / "none.txt").string()}, 1, "none.txt"},
  };
  for (const auto& [options, code, part] : wrong) {
    std::vector<std::string> arguments{"lens", "make"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.insert(arguments.end(), {"-o", file});
    const CommandResult result = run_catoptra(arguments);
    EXPECT_EQ(result.code, code) << part;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors << " should say " << part;
    EXPECT_EQ(files_in(folder.path()), 0u) << part;
  }
}

}  // namespace
}  // namespace catoptra::test
