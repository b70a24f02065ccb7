// catoptra lens evaluate: scenes, rules and exit codes, and every slip told.
#include <algorithm>
#include <cmath>

#include "tests/app/lens_evaluate_files.h"

namespace catoptra::test {
namespace {

using nlohmann::json;

/// A toric lens, made once.
class LensEvaluateInput : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    file_ = make_lens(*folder_, {"--sph", "-4", "--cyl", "-1.5", "--axis", "20", "--index", "1.5",
                                 "--center-thickness", "2"});
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static CommandResult run(const std::vector<std::string>& options) {
    return run_catoptra(joined({"lens", "evaluate", file_, "--index", "1.5", "--gaze", "0,0"}, options));
  }
  static std::vector<std::string> order(const std::string& sphere, const std::string& rule) {
    return {"--rule", rule, "--ordered-sph", sphere, "--ordered-cyl", "-1.5", "--ordered-axis", "20"};
  }
  static inline TemporaryFolder* folder_ = nullptr;
  static inline std::string file_;
};

constexpr char kTwoLenses[] =
    "[camera]\neye = [0, -60, 0]\ntarget = [0, 0, 0]\nup = [0, 0, 1]\n"
    "[[lens]]\nname = \"right\"\nfile = \"lens.step\"\nmaterial = { nd = 1.5, vd = 58 }\nrotate_deg = [82, "
    "0, 30]\n"
    "translate = [-32, 5, 100]\n"
    "[[lens]]\nname = \"left\"\nfile = \"lens.step\"\nmaterial = { nd = 1.6, vd = 41 }\nrotate_deg = [90, 0, "
    "0]\n";

TEST_F(LensEvaluateInput, LensOfASceneAsItIsPlaced) {
  const std::string scene = folder_->write("scene.toml", kTwoLenses).string();
  const json right = evaluate(scene, {"--lens", "right"});
  EXPECT_EQ(right.at("lens"), "right");
  EXPECT_NEAR(right.at("reference").at("sphere_d").get<double>(), -4, 1e-3);
  EXPECT_NEAR(right.at("reference").at("axis_deg").get<double>(), 20, 0.05)
      << "up is the lens's own, as turned";
  EXPECT_EQ(right.at("inputs").size(), 2u) << "the scene and the lens's file";
  const json left = evaluate(scene, {"--lens", "left"});
  EXPECT_LT(left.at("reference").at("sphere_d").get<double>(), -4.5) << "the scene's index 1.6";
  const json replaced = evaluate(scene, {"--lens", "left", "--index", "1.5"});
  EXPECT_NEAR(replaced.at("reference").at("sphere_d").get<double>(), -4, 1e-3);
  const json tilted = evaluate(scene, {"--lens", "right", "--up", "0,0,1"});
  EXPECT_NEAR(tilted.at("reference").at("axis_deg").get<double>(), 20, 0.05)
      << "the lens leans in its own vertical plane";

  const CommandResult which = run_catoptra({"lens", "evaluate", scene});
  EXPECT_EQ(which.code, 1);
  EXPECT_NE(which.errors.find("--lens: right, left"), std::string::npos) << which.errors;
  const CommandResult none = run_catoptra({"lens", "evaluate", scene, "--lens", "rigt"});
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.errors.find("did you mean 'right'?"), std::string::npos) << none.errors;
}

TEST_F(LensEvaluateInput, UpTurnsTheAxis) {
  const json turned = evaluate(file_, {"--index", "1.5", "--up", "1,0,0"});
  EXPECT_NEAR(turned.at("reference").at("axis_deg").get<double>(), 110, 0.05);
}

TEST_F(LensEvaluateInput, SidesByName) {
  const json exchanged =
      evaluate(file_, {"--index", "1.5", "--front-faces", "back", "--back-faces", "front"});
  EXPECT_NEAR(exchanged.at("reference").at("cylinder_d").get<double>(), -1.5, 0.05) << "front vertex power";
  EXPECT_NEAR(exchanged.at("back_curve_d").at(0).get<double>(),
              exchanged.at("back_curve_d").at(1).get<double>(), 1e-3);
}

TEST_F(LensEvaluateInput, LimitsPassAndFail) {
  const CommandResult good =
      run(joined(order("-4", "ansi-z80.1-2015"), {"--strict", "--ordered-thickness", "2.2"}));
  EXPECT_EQ(good.code, 0) << good.output << good.errors;
  EXPECT_NE(good.output.find("ANSI Z80.1-2015"), std::string::npos);
  EXPECT_NE(good.output.find("\n  passed\n"), std::string::npos) << good.output;

  const CommandResult bad = run(joined(order("-4.25", "ansi-z80.1-2015"), {"--strict"}));
  EXPECT_EQ(bad.code, 3) << bad.errors;
  EXPECT_NE(bad.output.find("FAIL  sphere within 0.13 D of -4.25 D"), std::string::npos) << bad.output;
  EXPECT_EQ(run(order("-4.25", "ansi-z80.1-2015")).code, 0) << "only --strict makes it an exit code";
}

TEST_F(LensEvaluateInput, UnverifiedFiguresSaySoEverywhere) {
  const std::string table = (*folder_ / "limits.csv").string();
  const auto options = joined(order("-4", "iso-8980-1-2004"), {"--csv", table});
  const CommandResult text = run(options);
  EXPECT_EQ(text.code, 0) << text.errors;
  EXPECT_NE(text.output.find("resting on figures that are unverified"), std::string::npos) << text.output;
  const std::string limits = read_file(*folder_ / "limits.limits.csv");
  EXPECT_NE(limits.find(",unverified,"), std::string::npos) << limits;

  const json report = evaluate(file_, joined({"--index", "1.5"}, order("-4", "iso-8980-1-2004")));
  EXPECT_EQ(report.at("rule").at("certainty"), "unverified");
  EXPECT_EQ(report.at("rule").at("pass"), true);
  ASSERT_EQ(report.at("limits").size(), 6u) << "two meridians, cylinder, axis, two prisms";
  for (const json& limit : report.at("limits")) {
    EXPECT_EQ(limit.at("certainty"), "unverified");
    for (const char* key : {"clause", "requirement", "value", "limit", "pass", "unit", "source"})
      EXPECT_TRUE(limit.contains(key)) << key;
  }
  EXPECT_EQ(report.at("limits_not_judged").at(0).at("quantity"), "center_thickness");
}

TEST_F(LensEvaluateInput, BothTablesOnStandardOutput) {
  const CommandResult tables = run(joined(order("-4", "ansi-z80.1-2015"), {"--csv", "-"}));
  ASSERT_EQ(tables.code, 0) << tables.errors;
  EXPECT_EQ(tables.output.find("gaze_h_deg,"), 0u) << "no text besides";
  EXPECT_NE(tables.output.find("\n\nrule,clause,quantity"), std::string::npos) << tables.output;
}

TEST_F(LensEvaluateInput, BodyByName) {
  const json info = json::parse(run_catoptra({"info", file_, "--json"}).output);
  const std::string body = info.at("files").at(0).at("bodies").at(0).at("name");
  const json report = evaluate(file_, {"--index", "1.5", "--lens", body});
  EXPECT_EQ(report.at("lens"), body);
  EXPECT_NEAR(report.at("reference").at("sphere_d").get<double>(), -4, 1e-3);
}

TEST_F(LensEvaluateInput, RuleOfTheUser) {
  const std::string rule = folder_
                               ->write("mine.toml",
                                       "format = 1\nid = \"mine\"\nkind = \"lens\"\ntitle = "
                                       "\"Mine\"\nedition = \"1\"\ndate = \"2026\"\n"
                                       "source = \"me\"\n[[figure]]\nquantity = \"sphere\"\nclause = "
                                       "\"1\"\nunit = \"D\"\nvalue = 0.01\n"
                                       "certainty = \"verified\"\n")
                               .string();
  EXPECT_EQ(run(joined(order("-4", rule), {"--strict"})).code, 0);
  const auto inputs =
      nlohmann::json::parse(run(joined(order("-4", rule), {"--json", "-"})).output).at("inputs");
  EXPECT_EQ(inputs.back().at("file"), rule) << "a verdict rests on its figures";
  EXPECT_EQ(run(joined(order("-4.02", rule), {"--strict"})).code, 3);
  const std::string broken = folder_->write("broken.toml", "format = 1\nid = 3\n").string();
  const CommandResult result = run(order("-4", broken));
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.errors.find("broken.toml: line 1, kind"), std::string::npos) << result.errors;
}

TEST_F(LensEvaluateInput, AdditionIsJudged) {
  const std::string lens =
      make_lens(*folder_, {"--sph", "1", "--add", "2", "--index", "1.5"}, "progressive.step");
  const auto judged = [&](const std::string& add) {
    return run_catoptra({"lens", "evaluate", lens, "--index", "1.5", "--rule", "ansi-z80.1-2015",
                         "--ordered-sph", "1", "--ordered-add", add, "--strict"});
  };
  const CommandResult good = judged("2");
  EXPECT_EQ(good.code, 0) << good.output;
  EXPECT_NE(good.output.find("pass  addition within 0.12 D of 2 D"), std::string::npos) << good.output;
  EXPECT_EQ(judged("2.25").code, 3);
}

TEST_F(LensEvaluateInput, WrongUsageIsToldBeforeAnythingIsRead) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{}, "--index N or --material"},
      {{"--index", "0.9"}, "--index 0.9"},
      {{"--index", "1.5", "--rule", "iso-8980"}, "did you mean 'iso-8980-1-2004' or 'iso-8980-2-2004'?"},
      {{"--index", "1.5", "--rule", "R46-VI"}, "built in: ansi-z80.1-2015"},
      {{"--index", "1.5", "--rule", "R46-III"}, "R46-III is a rule for a mirror, not for a lens"},
      {{"--index", "nan"}, "--index"},
      {{"--index", "1.5", "--material", "CR-39"}, "excludes"},
      {{"--material", "CR-93"}, "CR-39"},
      {{"--abbe", "30", "--material", "CR-39"}, "--abbe belongs"},
      {{"--index", "1.5", "--mode", "worn"}, "--mode"},
      {{"--index", "1.5", "--eye", "middle"}, "--eye"},
      {{"--index", "1.5", "--cylinder", "cross"}, "--cylinder"},
      {{"--index", "1.5", "--gaze", "10"}, "has 1 numbers"},
      {{"--index", "1.5", "--gaze", "10,x"}, "'x' is not a number"},
      {{"--index", "1.5", "--gaze", "85,0"}, "--gaze 85"},
      {{"--index", "1.5", "--gaze", "5,0", "--gaze-max", "20"}, "excludes"},
      {{"--index", "1.5", "--gaze-max", "-1"}, "--gaze-max"},
      {{"--index", "1.5", "--gaze-step", "0"}, "--gaze-step"},
      {{"--index", "1.5", "--points", "1e300,0"}, "--points 1e+300"},
      {{"--index", "1.5", "--map-step", "0"}, "--map-step"},
      {{"--index", "1.5", "--map-step", "2", "--points", "1,1"}, "excludes"},
      {{"--index", "1.5", "--rotation-centre", "0"}, "--rotation-centre"},
      {{"--index", "1.5", "--vertex-distance", "-3"}, "--vertex-distance"},
      {{"--index", "1.5", "--panto-deg", "60"}, "--panto-deg"},
      {{"--index", "1.5", "--wrap-deg", "inf"}, "--wrap-deg"},
      {{"--index", "1.5", "--object-distance", "400"}, "as-worn"},
      {{"--index", "1.5", "--mode", "as-worn", "--object-distance", "near"}, "'near'"},
      {{"--index", "1.5", "--mode", "as-worn", "--object-distance", "-1"}, "--object-distance"},
      {{"--index", "1.5", "--wavelength", "10600"}, "--wavelength"},
      {{"--index", "1.5", "--up", "0,0,0"}, "--up"},
      {{"--index", "1.5", "--unit", "ell"}, "'ell'"},
      {{"--index", "1.5", "--json", "-", "--csv", "-"}, "only one of"},
      {{"--index", "1.5", "--html", "-", "--csv", "-"}, "only one of"},
      {{"--index", "1.5", "--strict"}, "--rule"},
      {{"--index", "1.5", "--ordered-sph", "-4"}, "--rule"},
      {{"--index", "1.5", "--rule", "iso-8980-1-2004"}, "--ordered-sph"},
      {{"--index", "1.5", "--rule", "iso-8980-1-2005", "--ordered-sph", "1"}, "iso-8980-1-2004"},
      {{"--index", "1.5", "--rule", "iso-8980-1-2004", "--ordered-sph", "1", "--ordered-cyl", "1"},
       "--ordered-axis"},
      {{"--index", "1.5", "--rule", "iso-8980-1-2004", "--ordered-sph", "1", "--ordered-prism", "1"},
       "--ordered-base-deg"},
      {{"--index", "1.5", "--distance-point", "0,3"}, "--near-point"},
      {{"--index", "1.5", "--no-such-option"}, "--no-such-option"},
  };
  for (const auto& [options, part] : wrong) {
    const CommandResult result = run_catoptra(joined({"lens", "evaluate", "/no/such/lens.step"}, options));
    EXPECT_EQ(result.code, 2) << part << ": " << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors << " should say " << part;
    EXPECT_EQ(result.output, "") << part;
  }
  EXPECT_EQ(run_catoptra({"lens", "evaluate"}).code, 2);
  EXPECT_EQ(run({"--map-step", "0.01"}).code, 2) << "42 million points";
}

TEST_F(LensEvaluateInput, BadFilesFailInOneLine) {
  const std::vector<std::pair<std::string, std::string>> bad{
      {(*folder_ / "none.step").string(), "none.step"},
      {folder_->write("empty.step", "").string(), "empty.step"},
      {folder_->write("text.step", "not a lens\n").string(), "text.step"},
      {folder_->write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").string(), "exact surfaces"},
      {folder_->write("no_lens.toml", "[camera]\neye = [0, -9, 0]\ntarget = [0, 0, 0]\n").string(),
       "no [[lens]]"},
      {(*folder_ / "none.toml").string(), "none.toml"},
  };
  for (const auto& [file, part] : bad) {
    const CommandResult result = run_catoptra({"lens", "evaluate", file, "--index", "1.5"});
    EXPECT_EQ(result.code, 1) << file << ": " << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
  }
  EXPECT_EQ(run({"--json", "/no/such/folder/r.json"}).code, 1);
  EXPECT_EQ(run({"--front-faces", "frnt"}).code, 1);
  const CommandResult body = run({"--lens", "nobody"});
  EXPECT_EQ(body.code, 1);
  EXPECT_NE(body.errors.find("body 'nobody': is not in this file"), std::string::npos) << body.errors;
}

}  // namespace
}  // namespace catoptra::test
