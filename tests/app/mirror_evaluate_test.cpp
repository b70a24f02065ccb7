// catoptra mirror evaluate, and the rules' zones.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/src/file_hash.h"
#include "app/src/mirror_evaluation.h"
#include "tests/app/command_runner.h"
#include "tests/app/test_scene.h"

namespace catoptra::test {
namespace {

using nlohmann::json;

/// A left door mirror on a car that is a side plane at x = -530: z up, the car drives towards +y.
struct DoorScene {
  std::string rotate = "[86.9, 0, 20.3]";
  std::string translate = "[-660, 560, 1020]";
  std::string evaluation = "left_side = [-530, 0, 0]\nright_side = [1270, 0, 0]\n";
  std::string more;
  cad_import::MirrorBlank blank;
};

std::string write_door(const TemporaryFolder& folder, const DoorScene& door) {
  cad_import::write_mirror_blank(door.blank, folder / "door.step");
  return folder
      .write("door.toml",
             "[camera]\neye = [0, 0, 1200]\ntarget = [-660, 560, 1020]\n" + door.more +
                 "[[mirror]]\nname = \"door\"\nfile = \"door.step\"\nfaces = [\"Glass\"]\nrotate_deg = " +
                 door.rotate + "\ntranslate = " + door.translate + "\nvertices = 100\n" +
                 "[evaluation]\nforward = [0, 1, 0]\n" + door.evaluation)
      .string();
}

json evaluate(const std::string& scene, std::vector<std::string> options) {
  options.insert(options.begin(), {"mirror", "evaluate", scene, "--json", "-"});
  const CommandResult result = run_catoptra(options);
  EXPECT_EQ(result.code, 0) << result.errors;
  return result.code == 0 ? json::parse(result.output) : json();
}

TEST(MirrorRules, ZonesHaveTheOfficialAreas) {
  const auto area = [](const std::string& rule) {
    double sum = 0;
    const app::RuleFile file = app::find_rule(rule, app::mirror_rule_words());
    for (const app::ZonePart& part : app::required_zone(file, {0.53, -1, 0, 100000}))
      sum += optics::polygon_area_mm2(part.polygon) * 1e-6;
    return sum;
  };
  EXPECT_NEAR(area("R46-IV"), 307.875, 1e-9);
  EXPECT_NEAR(area("R46-V"), 5.5, 1e-9);
  EXPECT_NEAR(area("R46-III"), 4 * 80 + 16, 1e-9);  // 4 m from 20 m to the cut, 1 m from 4 m on
  EXPECT_NEAR(area("R46-I"), 20 * 40, 1e-9);
  EXPECT_NEAR(area("R46-II"), 5 * 70 + 26, 1e-9);
  EXPECT_NEAR(area("FMVSS111-driver"), 2.4 * (100 - 10.7), 1e-9);
  EXPECT_EQ(area("FMVSS111-passenger"), 0);
  EXPECT_EQ(area("FMVSS111-inside"), 0);
}

TEST(MirrorRules, EveryFigureHasClauseSourceAndCertainty) {
  const auto ids = app::built_in_rules("mirror");
  EXPECT_EQ(ids.size(), 8u);
  for (const std::string& id : ids)
    for (const app::RuleFigure& figure : app::find_rule(id, app::mirror_rule_words()).figures) {
      EXPECT_FALSE(figure.clause.empty() || figure.source.empty()) << id << " " << figure.quantity;
      if (figure.certainty != app::Certainty::verified) continue;
      EXPECT_EQ(figure.source.find("not compared"), std::string::npos) << id << " " << figure.quantity;
    }
}

TEST(MirrorEvaluate, SphereOnADoorPassesAndItsReportHasTheAgreedKeys) {
  const TemporaryFolder folder;
  const json report = evaluate(write_door(folder, {}), {"--rule", "R46-III", "--strict"});
  EXPECT_EQ(report.at("mirror"), "door");
  EXPECT_NEAR(report.at("mean_radius_mm").get<double>(), 1200, 1.2);
  EXPECT_NEAR(report.at("radius_mm").at("min").get<double>(), 1200, 1.2);
  EXPECT_NEAR(report.at("radius_mm").at("max").get<double>(), 1200, 1.2);
  EXPECT_EQ(report.at("rule"), "R46-III");
  EXPECT_NEAR(report.at("field").at("required_m2").get<double>(), 336, 1e-6);
  EXPECT_NEAR(report.at("field").at("coverage").get<double>(), 1, 1e-3);
  EXPECT_NEAR(report.at("field").at("covered_m2").get<double>(), 336, 0.4);
  EXPECT_GE(report.at("clauses").size(), 9u);
  for (const json& clause : report.at("clauses")) {
    for (const char* key : {"clause", "requirement", "value", "limit", "pass"})
      EXPECT_TRUE(clause.contains(key)) << key;
    EXPECT_EQ(clause.at("pass"), true) << clause.dump();
  }
  EXPECT_EQ(report.at("rests_on_unverified"), true);
  // a = 130 / (1 + 1000 / 1200)
  for (const json& clause : report.at("clauses"))
    if (clause.at("requirement").get<std::string>().find("rectangle") != std::string::npos) {
      EXPECT_NEAR(clause.at("limit").get<double>(), 130 / (1 + 1000.0 / 1200), 1e-3);
    }
}

TEST(MirrorEvaluate, StrictFailsWithThreeAndSaysWhichClause) {
  const TemporaryFolder folder;
  DoorScene door;
  door.blank.radius_h_mm = door.blank.radius_v_mm = 900;  // below the least of class III
  const std::string scene = write_door(folder, door);
  const CommandResult strict = run_catoptra({"mirror", "evaluate", scene, "--rule", "r46-iii", "--strict"});
  EXPECT_EQ(strict.code, 3);
  EXPECT_NE(strict.output.find("FAIL  mean radius of curvature, at least: 900"), std::string::npos)
      << strict.output;
  EXPECT_NE(strict.output.find("does not pass (rests on figures that are not verified"), std::string::npos);
  EXPECT_EQ(run_catoptra({"mirror", "evaluate", scene, "--rule", "R46-III"}).code, 0);
}

TEST(MirrorEvaluate, AsphericGlassFollowsItsClothoid) {
  const TemporaryFolder folder;
  DoorScene door;
  door.blank.width_mm = 190;
  door.blank.aspheric = cad_import::AsphericPart{30, 250, true};
  door.rotate = "[90, 0, 0]";
  door.translate = "[0, 0, 0]";
  const auto scene = app::read_scene(write_door(folder, door));
  app::MirrorEvaluationOptions options;
  options.eye_mm = glm::dvec3(100, -800, 200);
  options.rule = app::find_rule("R46-III", app::mirror_rule_words());
  const app::MirrorEvaluation e = evaluate_mirror(scene, options);
  EXPECT_NEAR(e.map.min_mm / 250, 1, 5e-3);
  EXPECT_NEAR(e.readings.mean_mm, 1200, 1.2) << "read on the spherical part";
  EXPECT_NEAR(e.map.spherical_share, (95 + 30) / 190.0, 0.03);
  ASSERT_TRUE(e.spherical_field);
  EXPECT_LE(e.spherical_field->reflected_m2, e.field.reflected_m2);
  int compared = 0;
  for (const optics::GlassPoint& p : e.map.points) {
    const double x = -p.surface.point.x;  // the strip lies towards -x
    if (std::abs(p.surface.point.z) > 0.5 || x < 35 || x > 90) continue;
    // The curvature of the section through the pole grows linearly from the line to the edge.
    const double curvature = 1 / 1200.0 + (1 / 250.0 - 1 / 1200.0) * (x - 30) / (95 - 30);
    EXPECT_NEAR(p.curvatures.k1 / curvature, 1, 5e-3) << x;
    ++compared;
  }
  EXPECT_GT(compared, 5);
}

TEST(MirrorEvaluate, AimWrittenIntoTheSceneShowsWhatWasPromised) {
  const TemporaryFolder folder;
  DoorScene door;
  door.rotate = "[83.744, 0, 21.270]";
  const std::string scene = write_door(folder, door);
  const json before = evaluate(scene, {"--rule", "R46-III"});
  const json aimed =
      evaluate(scene, {"--rule", "R46-III", "--aim", "--aim-limits", "8,6", "--aim-pivot=-650,580,1010"});
  EXPECT_LT(before.at("field").at("coverage").get<double>(), 0.999);
  EXPECT_EQ(aimed.at("field").at("coverage").get<double>(), 1);
  EXPECT_NEAR(aimed.at("aim").at("limits_deg").at(0).get<double>(), 8, 1e-9);
  EXPECT_NEAR(aimed.at("aim").at("limits_deg").at(1).get<double>(), 6, 1e-9);
  const TemporaryFolder other;
  door.rotate = aimed.at("aim").at("rotate_deg").dump();
  door.translate = aimed.at("aim").at("translate").dump();
  const json after = evaluate(write_door(other, door), {"--rule", "R46-III"});
  EXPECT_NEAR(after.at("field").at("coverage").get<double>(), 1, 1e-9);
  EXPECT_NEAR(after.at("magnification").at("tangential").get<double>(),
              aimed.at("magnification").at("tangential").get<double>(), 1e-6);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(after.at("field").at("margins").at(i).at("margin_mm").get<double>(),
                aimed.at("field").at("margins").at(i).at("margin_mm").get<double>(), 2);
}

TEST(MirrorEvaluate, NamedVehicleHidesAndTheRestOfTheSceneDoesNot) {
  const TemporaryFolder folder;
  // A wall across the road 10 m behind, 3 m high: over all of class III's width.
  folder.write("wall.obj",
               "v -9000 -10000 0\nv 9000 -10000 0\nv 9000 -10000 3000\nv -9000 -10000 3000\nf 1 2 3 4\n");
  DoorScene door;
  door.more =
      "[[surrounding]]\nname = \"wall\"\nfile = \"wall.obj\"\n[[surrounding]]\nname = \"other\"\nfile = "
      "\"wall.obj\"\n"
      "translate = [0, -200000, 0]\n";
  const std::string own = door.evaluation;
  door.evaluation = own + "vehicle = [\"wall\"]\n";
  const json hidden = evaluate(write_door(folder, door), {"--rule", "R46-III"});
  // Of the 1 m strip 4 to 10 m behind remain visible; the 20 mm over the ground that hide nothing are 0.2 m
  // more.
  EXPECT_NEAR(hidden.at("field").at("covered_m2").get<double>(), 6, 0.3);
  EXPECT_NEAR(hidden.at("field").at("shown_m2").get<double>(), 336, 0.4);
  door.evaluation = own + "vehicle = [\"other\"]\n";
  const json open = evaluate(write_door(folder, door), {"--rule", "R46-III"});
  EXPECT_NEAR(open.at("field").at("covered_m2").get<double>(), 336, 0.4);
  door.evaluation = own + "vehicle = [\"wal\"]\n";
  const CommandResult wrong = run_catoptra({"mirror", "evaluate", write_door(folder, door)});
  EXPECT_EQ(wrong.code, 1);
  EXPECT_NE(wrong.errors.find("evaluation.vehicle: no surrounding is called 'wal' (did you mean 'wall'?)"),
            std::string::npos)
      << wrong.errors;
}

TEST(MirrorEvaluate, SameReportOnOneThreadAndTwo) {
  const TemporaryFolder folder;
  const std::string scene = write_door(folder, {});
  const auto run = [&](const char* threads) {
    return run_catoptra({"mirror", "evaluate", scene, "--rule", "R46-IV", "--aim", "--json", "-", "--threads",
                         threads})
        .output;
  };
  const std::string one = run("1");
  EXPECT_GT(one.size(), 1000u);
  EXPECT_EQ(one, run("2"));
}

TEST(MirrorEvaluate, PlaneInsideMirrorOfUnitMagnification) {
  const TemporaryFolder folder;
  DoorScene door;
  door.blank.radius_h_mm = door.blank.radius_v_mm = 0;
  door.blank.width_mm = 240;
  door.blank.height_mm = 62;
  door.translate = "[370, 450, 1300]";
  door.rotate = "[95.702, 0, -19.566]";  // its middle shows straight back, 1 degree down
  door.evaluation = "median = [370, 0, 0]\n";
  const json report = evaluate(write_door(folder, door), {"--rule", "FMVSS111-inside", "--strict"});
  EXPECT_TRUE(report.at("mean_radius_mm").is_null()) << "a plane has no radius";
  EXPECT_TRUE(report.at("field").at("required_m2").is_null());
  EXPECT_NEAR(report.at("magnification").at("least").get<double>(), 1, 1e-6);
  // 240 mm at 591 mm and 20 degrees of incidence.
  EXPECT_NEAR(report.at("field").at("horizon_angle_deg").get<double>(), 21.7, 0.3);
  EXPECT_EQ(report.at("pass"), true);
}

TEST(MirrorEvaluate, ErrorsNameWhatIsWrong) {
  const TemporaryFolder folder;
  const std::string scene = write_door(folder, {});
  const auto complains = [](const std::vector<std::string>& options, int code, const std::string& text) {
    const CommandResult result = run_catoptra(options);
    EXPECT_EQ(result.code, code) << text;
    EXPECT_NE(result.errors.find(text), std::string::npos) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  };
  complains({"mirror", "evaluate", scene, "--rule", "R46-II1"}, 2,
            "built in: FMVSS111-driver, FMVSS111-inside");
  complains({"mirror", "evaluate", scene, "--strict"}, 2, "--strict needs a rule");
  complains({"mirror", "evaluate", scene, "--mirror", "dor"}, 1, "did you mean 'door'?");
  complains({"mirror", "evaluate", scene, "--aim"}, 1, "there is no zone to aim at");
  complains({"mirror", "evaluate", scene, "--eye=-900,1200,1200"}, 1, "does not face the eye");
  complains({"mirror", "evaluate", scene, "--rule", "R46-III", "--far", "15000"}, 1, "beyond the far cut");
  complains({"mirror", "evaluate", (folder / "none.toml").string()}, 1, "cannot open the scene file");
  DoorScene door;
  door.evaluation = "left_side = [-530, 0, 0]\n";
  complains({"mirror", "evaluate", write_door(folder, door), "--rule", "R46-I"}, 1, "evaluation.median");
  door.evaluation = "ground = [0, 0, 1500]\n";
  complains({"mirror", "evaluate", write_door(folder, door)}, 1,
            "evaluation.ground: the eye is not above the ground");
  door.evaluation = "eye = [0, 0, 1]\nr_point = [0, 0, 1]\n";
  complains({"mirror", "evaluate", write_door(folder, door)}, 1, "exclude each other");
  door.evaluation = "ocular_points = [[0, 0, 1200]]\n";
  complains({"mirror", "evaluate", write_door(folder, door)}, 1, "expected two points");
  complains({"mirror", "evaluate", folder.write("none.toml", "[camera]\n").string()}, 1, "has no [[mirror]]");
}

TEST(MirrorEvaluate, ReportHasTheHashOfEachFileThatItRestsOn) {
  const TemporaryFolder folder;
  const auto wall = folder.write("wall.obj", "v 0 -1 0\nv 1 -1 0\nv 1 -1 1\nf 1 2 3\n");
  folder.write("other.obj", "v 0 -1 0\nv 1 -1 0\nv 1 -1 1\nf 1 2 3\n");
  DoorScene door;
  door.more =
      "[[surrounding]]\nname = \"wall\"\nfile = \"wall.obj\"\n[[surrounding]]\nname = \"far\"\n"
      "file = \"other.obj\"\n[[surrounding]]\nname = \"again\"\nfile = \"wall.obj\"\n";
  door.evaluation += "vehicle = [\"wall\", \"again\"]\n";
  const std::string scene = write_door(folder, door);
  const json report = evaluate(scene, {});
  json expected = json::array();
  for (const std::filesystem::path& file :
       {std::filesystem::path(scene), folder / "door.step", wall})  // what is not in the way has no say
    expected.push_back({{"file", file.string()}, {"sha256", app::sha256_of_file(file)}});
  EXPECT_EQ(report.at("inputs"), expected);
  const auto own = folder.write("own.toml",
                                "format = 1\nid = \"own\"\nkind = \"mirror\"\ntitle = \"t\"\nedition = "
                                "\"1\"\ndate = \"2026\"\nsource = \"s\"\n[[figure]]\nquantity = "
                                "\"mean_radius_min\"\nclause = \"1\"\nunit = \"mm\"\nvalue = 1000\n"
                                "certainty = \"verified\"\n");
  const json judged = evaluate(scene, {"--rule", own.string()});
  EXPECT_EQ(judged.at("inputs").size(), 4u);
  EXPECT_EQ(judged.at("inputs").back().at("sha256"), app::sha256_of_file(own));
}

TEST(MirrorEvaluate, MissingSidePlaneIsAssumedAndSaidWhere) {
  const TemporaryFolder folder;
  folder.write("car.obj", "v -500 -900 0\nv 1270 -900 0\nv 1270 -900 900\nv -500 -900 900\nf 1 2 3 4\n");
  const auto vehicle = [&](const std::string& evaluation, const std::string& more) {
    DoorScene door;
    door.more = more;
    door.evaluation = evaluation;
    const json report = evaluate(write_door(folder, door), {"--rule", "R46-III"});
    EXPECT_EQ(report.at("notes").dump().find("side plane") == std::string::npos,
              report.at("vehicle").at("side_plane_from") == "scene");
    return report.at("vehicle");
  };
  const std::string car = "[[surrounding]]\nname = \"car\"\nfile = \"car.obj\"\n";
  EXPECT_EQ(vehicle("left_side = [-530, 0, 0]\n", car).at("side_plane_from"), "scene");
  const json touched = vehicle("vehicle = [\"car\"]\n", car);
  EXPECT_EQ(touched.at("side_plane_from"), "vehicle");
  EXPECT_NEAR(touched.at("side_left_mm").get<double>(), 500, 1e-3);
  const json assumed = vehicle("", "");
  EXPECT_EQ(assumed.at("side_plane_from"), "mirror");
  // The glass, 170 mm wide and turned by 20.3 degrees, ends 85 cos 20.3 inwards of its pole.
  EXPECT_NEAR(assumed.at("side_left_mm").get<double>(), 660 - 85 * std::cos(20.3 * 3.14159265 / 180), 3);
}

TEST(MirrorEvaluate, EyesMayBeGivenInThreeWays) {
  const TemporaryFolder folder;
  const auto eyes = [&](const std::string& keys) {
    DoorScene door;
    door.evaluation = keys;
    return evaluate(write_door(folder, door), {}).at("vehicle").at("eyes_mm");
  };
  const json expected{{-32.5, 0.0, 1200.0}, {32.5, 0.0, 1200.0}};
  EXPECT_EQ(eyes(""), expected) << "the camera's eye";
  EXPECT_EQ(eyes("r_point = [0, 0, 565]\n"), expected) << "635 mm above the R point";
  EXPECT_EQ(eyes("ocular_points = [[32.5, 0, 1200], [-32.5, 0, 1200]]\n"), expected)
      << "the left one comes first";
  EXPECT_EQ(eyes("eye = [0, 0, 1200]\nocular_spacing = 0\n").size(), 1u);
}

}  // namespace
}  // namespace catoptra::test
