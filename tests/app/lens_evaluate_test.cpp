// catoptra lens evaluate: what it measures, and the shape of its reports.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <sstream>

#include "app/src/file_hash.h"
#include "tests/app/lens_evaluate_files.h"

namespace catoptra::test {
namespace {

using nlohmann::json;

/// Surfaces of made lenses are within 1e-7 mm of the ideal ones; what limits a reading is the B-spline's
/// curvature.
constexpr double kPower_d = 1e-3, kAxis_deg = 0.05, kPrism = 2e-3;

double at(const json& object, const char* key) {
  return object.at(key).get<double>();
}

TEST(LensEvaluate, MadeLensReadsBackItsPrescription) {
  const TemporaryFolder folder;
  const std::string file =
      make_lens(folder, {"--sph", "-4", "--cyl", "-1.5", "--axis", "20", "--material", "CR-39"});
  const json report = evaluate(file, {"--material", "CR-39"});
  EXPECT_NEAR(at(report.at("reference"), "sphere_d"), -4, kPower_d);
  EXPECT_NEAR(at(report.at("reference"), "cylinder_d"), -1.5, kPower_d);
  EXPECT_NEAR(at(report.at("reference"), "axis_deg"), 20, kAxis_deg);
  EXPECT_NEAR(at(report.at("reference"), "prism_d"), 0, kPrism);

  const json plus = evaluate(file, {"--material", "CR-39", "--cylinder", "plus", "--gaze", "0,0"});
  EXPECT_EQ(plus.at("cylinder"), "plus");
  for (const json& power : {plus.at("reference"), plus.at("points").at(0)}) {
    EXPECT_NEAR(at(power, "sphere_d"), -5.5, kPower_d);
    EXPECT_NEAR(at(power, "cylinder_d"), 1.5, kPower_d);
    EXPECT_NEAR(at(power, "axis_deg"), 110, kAxis_deg);
  }
}

/// The goldens G1 of high precision: n 1.5, F1 6, F2 -10, t 2, rotation centre 27; light from infinity.
TEST(LensEvaluate, AsWornGoldens) {
  const TemporaryFolder folder;
  const std::string file = make_lens(folder, {"--sph", "-3.951613", "--index", "1.5", "--front-curve", "6",
                                              "--center-thickness", "2", "--diameter", "70"});
  const json report = evaluate(file, {"--index", "1.5", "--mode", "as-worn", "--rotation-centre", "27",
                                      "--gaze", "0,15", "--gaze", "-30,0", "--gaze", "0,-40"});
  const double expected[3][3] = {
      {-3.89557, -3.90794, 16.50120}, {-3.67411, -3.76332, 33.20467}, {-3.35855, -3.59269, 44.55037}};
  ASSERT_EQ(report.at("points").size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const json& point = report.at("points").at(i);
    EXPECT_NEAR(at(point, "tangential_d"), expected[i][0], kPower_d);
    EXPECT_NEAR(at(point, "sagittal_d"), expected[i][1], kPower_d);
    EXPECT_NEAR(std::hypot(at(point, "object_h_deg"), at(point, "object_v_deg")), expected[i][2], 1e-3);
    EXPECT_NEAR(at(point, "mean_power_error_d"), 0.5 * (expected[i][0] + expected[i][1]) + 3.951613,
                kPower_d);
    EXPECT_NEAR(at(point, "oblique_astigmatism_d"), expected[i][0] - expected[i][1], kPower_d);
  }
  EXPECT_EQ(report.at("position").at("object_distance_mm"), nullptr) << "infinity";
  // 1 / (1 - t/n F1) / (1 - h F'v) with h = 12 + 3 mm.
  EXPECT_NEAR(at(report, "spectacle_magnification"), 1 / (1 - 0.002 / 1.5 * 6) / (1 + 0.015 * 3.951613),
              1e-4);
}

/// Straight ahead at 400 mm, the thick lens of G1 step by step: U = -2.5, U + F1 = 3.5, across 2 mm, + F2,
/// less U.
TEST(LensEvaluate, NearObject) {
  const TemporaryFolder folder;
  const std::string file = make_lens(
      folder, {"--sph", "-3.951613", "--index", "1.5", "--front-curve", "6", "--center-thickness", "2"});
  const json report =
      evaluate(file, {"--index", "1.5", "--mode", "as-worn", "--object-distance", "400", "--gaze", "0,0"});
  EXPECT_NEAR(at(report.at("points").at(0), "sphere_d"), 3.5 / (1 - 0.002 / 1.5 * 3.5) - 10 + 2.5, kPower_d);
  EXPECT_EQ(at(report.at("position"), "object_distance_mm"), 400);
  EXPECT_NEAR(at(report.at("reference"), "sphere_d"), -3.951613, kPower_d)
      << "the focimeter's light is parallel";
}

/// Martin's rule: S' = S (1 + sin^2 a / 2n), C' = S' tan^2 a about the axis of rotation. It is for thin
/// lenses of small tilt: at 15 degrees it leaves out terms of a^4, and the lens is 2 mm thick.
TEST(LensEvaluate, TiltMakesACylinderAboutItsAxis) {
  const TemporaryFolder folder;
  const std::string file = make_lens(folder, {"--sph", "-4", "--index", "1.5"});
  const double s = std::sin(15 * std::numbers::pi / 180), t = std::tan(15 * std::numbers::pi / 180);
  const double sphere = -4 * (1 + s * s / 3);
  for (const auto& [option, axis] : {std::pair{"--panto-deg", 180.0}, std::pair{"--wrap-deg", 90.0}}) {
    const json report =
        evaluate(file, {"--index", "1.5", "--mode", "as-worn", option, "15", "--gaze", "0,0"});
    const json& point = report.at("points").at(0);
    EXPECT_NEAR(at(point, "sphere_d"), sphere, 0.02) << option;
    EXPECT_NEAR(at(point, "cylinder_d"), sphere * t * t, 0.03) << option;
    EXPECT_NEAR(at(point, "axis_deg"), axis, kAxis_deg) << option;
  }
}

/// Behind a plane front the focimeter's ray, normal to the back, is turned by as much as the one along the
/// axis.
TEST(LensEvaluate, PrismAndItsBase) {
  const TemporaryFolder folder;
  const std::string file = make_lens(
      folder, {"--sph", "-2", "--front-curve", "0", "--prism", "3", "--base-deg", "150", "--index", "1.5"});
  for (const std::string eye : {"right", "left"}) {
    const json report = evaluate(file, {"--index", "1.5", "--gaze", "0,0", "--eye", eye});
    const json& reference = report.at("reference");
    EXPECT_NEAR(at(reference, "prism_d"), 3, kPrism);
    EXPECT_NEAR(at(reference, "prism_base_deg"), 150, kAxis_deg);
    EXPECT_NEAR(at(reference, "prism_h"), 3 * std::cos(150 * std::numbers::pi / 180), kPrism)
        << "base towards -x";
    EXPECT_NEAR(at(reference, "prism_v"), 1.5, kPrism) << "base up";
    // Facing the wearer, the right eye's temple is on the left: towards -x.
    EXPECT_NEAR(at(report.at("points").at(0), "base_out"), eye == "right" ? 2.598 : -2.598, kPrism);
  }
}

/// The front's own growth of power; the ray to the near point runs obliquely through the back, hence the 0.05
/// D.
/// What a focimeter reads on a prismatic lens with a curved front, by Coddington's scalar equations: the beam
/// leaves along the back's normal, so the back is met square and the front at a slant, which adds power
/// there. No wave matrix, no B-spline and no tracing is in it.
TEST(LensEvaluate, PrismaticLensReadsAsAFocimeterReadsIt) {
  constexpr double kIndex = 1.5, kThickness_m = 2e-3;
  const TemporaryFolder folder;
  double farthest = 0;
  for (const double front_d : {4.0, 8.0}) {
    const std::string file = (folder / "prismatic.step").string();
    const CommandResult made =
        run_catoptra({"lens", "make", "--sph", "-3.25", "--prism", "3", "--base-deg", "90", "--index", "1.5",
                      "--front-curve", std::to_string(front_d), "--center-thickness", "2", "-o", file});
    ASSERT_EQ(made.code, 0) << made.errors;
    double upright_mm = 0, level_mm = 0;  // the back's radii, in the plane of the prism and across it
    const std::string radii = "radii ";
    ASSERT_EQ(std::sscanf(made.output.c_str() + made.output.find(radii), "radii %lf and %lf", &level_mm,
                          &upright_mm),
              2);
    if (std::abs(level_mm) < std::abs(upright_mm)) std::swap(level_mm, upright_mm);

    const json reading = evaluate(file, {"--index", "1.5"}).at("reference");
    const double deviation = std::atan(at(reading, "prism_v") / 100);
    // sin(i) = n sin(i') and i - i' = deviation.
    const double inside = std::atan(std::sin(deviation) / (kIndex - std::cos(deviation))),
                 outside = inside + deviation;
    const double slant_d = (kIndex * std::cos(inside) - std::cos(outside)) / (kIndex - 1) * front_d;
    const auto left = [&](double power_d, double back_mm) {
      return power_d / (1 - kThickness_m / kIndex / std::cos(inside) * power_d) -
             (kIndex - 1) * 1000 / std::abs(back_mm);
    };
    const double tangential = slant_d / std::pow(std::cos(inside), 2), sagittal = slant_d;
    const double one = left(tangential, level_mm), other = left(sagittal, upright_mm);
    EXPECT_NEAR(at(reading, "sphere_d"), std::max(one, other), kPower_d) << front_d;
    EXPECT_NEAR(at(reading, "sphere_d") + at(reading, "cylinder_d"), std::min(one, other), kPower_d)
        << front_d;
    EXPECT_NEAR(at(reading, "prism_h"), 0, kPrism);
    farthest = std::max(farthest, at(reading, "sphere_d") + 3.25);
  }
  EXPECT_GT(farthest, 0.05) << "else nothing slants";
}

TEST(LensEvaluate, AdditionOfAProgressiveLens) {
  const TemporaryFolder folder;
  const std::string file = make_lens(folder, {"--sph", "1", "--add", "2", "--index", "1.6"});
  const json report = evaluate(file, {"--index", "1.6", "--near-point", "0,-14", "--gaze", "0,0"});
  const json& addition = report.at("addition");
  EXPECT_NEAR(at(addition, "addition_d"), 2, 0.05);
  EXPECT_EQ(addition.at("side"), "front");
  EXPECT_EQ(addition.at("near_point_mm"), json({0.0, -14.0}));
  EXPECT_NEAR(at(addition.at("near"), "sphere_d") - at(addition.at("distance"), "sphere_d"), 2, 0.15)
      << "the rest is unwanted cylinder";
  const json halfway = evaluate(file, {"--index", "1.6", "--near-point", "0,-7", "--gaze", "0,0"});
  EXPECT_GT(at(halfway.at("addition"), "addition_d"), 0.5);
  EXPECT_LT(at(halfway.at("addition"), "addition_d"), 1.5);
}

TEST(LensEvaluate, DispersionMakesColour) {
  const TemporaryFolder folder;
  const std::string file = make_lens(folder, {"--sph", "-6", "--material", "polycarbonate"});
  const json known = evaluate(file, {"--material", "polycarbonate", "--points", "0,10"});
  const json& point = known.at("points").at(0);
  const double prism = std::hypot(at(point, "prism_h"), at(point, "prism_v"));
  EXPECT_NEAR(at(point, "tca_d"), prism / 29, 0.02 * prism / 29 + 0.02) << "P / V, with V from 28 to 30";
  const json unknown = evaluate(file, {"--index", "1.586", "--points", "0,10"});
  EXPECT_EQ(unknown.at("dispersion"), false);
  EXPECT_EQ(at(unknown.at("points").at(0), "tca_d"), 0);
  const json abbe = evaluate(file, {"--index", "1.586", "--abbe", "29", "--points", "0,10"});
  EXPECT_NEAR(at(abbe.at("points").at(0), "tca_d"), prism / 29, 0.02 * prism / 29);
}

TEST(LensEvaluate, JsonHasEveryKeyOfTheInterface) {
  const TemporaryFolder folder;
  const std::string file = make_lens(folder, {"--sph", "-2"});
  const json report = evaluate(file, {"--material", "CR-39", "--mode", "as-worn", "--panto-deg", "8"});
  for (const char* key : {"lens", "material", "wavelength_nm", "mode", "reference", "points", "limits",
                          "inputs", "versions", "warnings"})
    EXPECT_TRUE(report.contains(key)) << key;
  EXPECT_EQ(report.at("lens"), "lens");
  EXPECT_EQ(report.at("material"), "CR-39");
  EXPECT_EQ(report.at("mode"), "as-worn");
  EXPECT_NEAR(at(report, "wavelength_nm"), 587.56, 0.01);
  EXPECT_NEAR(at(report.at("position"), "panto_deg"), 8, 1e-12);
  for (const char* key : {"sphere_d", "cylinder_d", "axis_deg", "prism_d", "prism_base_deg"})
    EXPECT_TRUE(report.at("reference").at(key).is_number()) << key;
  EXPECT_EQ(report.at("points").size(), 29u) << "30 degrees in steps of 10";
  for (const json& point : report.at("points"))
    for (const char* key : {"gaze_h_deg", "gaze_v_deg", "x_mm", "y_mm", "sphere_d", "cylinder_d", "axis_deg",
                            "mean_power_error_d", "oblique_astigmatism_d", "tangential_d", "sagittal_d",
                            "prism_h", "prism_v", "object_h_deg", "object_v_deg", "tca_d"})
      EXPECT_TRUE(point.at(key).is_number()) << key;
  EXPECT_EQ(report.at("limits"), json::array());
  EXPECT_EQ(report.at("inputs").at(0).at("sha256"), app::sha256(read_file(file)));
}

/// What a ray through the rim, or beside the lens, would have is null, and empty in a table.
TEST(LensEvaluate, PointsWithoutLight) {
  const TemporaryFolder folder;
  const std::string file = make_lens(folder, {"--sph", "-4", "--diameter", "60"});
  const std::string table = (folder / "points.csv").string();
  const json report = evaluate(
      file, {"--index", "1.5", "--points", "50,0", "--gaze", "80,0", "--gaze", "0,0", "--csv", table});
  ASSERT_EQ(report.at("points").size(), 3u);
  const json &beyond = report.at("points").at(0), &off = report.at("points").at(2);
  EXPECT_EQ(beyond.at("end"), "missed");
  EXPECT_NEAR(at(beyond, "gaze_h_deg"), 80, 1e-9);
  EXPECT_EQ(beyond.at("x_mm"), nullptr);
  EXPECT_EQ(beyond.at("sphere_d"), nullptr);
  EXPECT_EQ(off.at("end"), "missed");
  EXPECT_EQ(off.at("gaze_h_deg"), nullptr);
  EXPECT_EQ(at(off, "x_mm"), 50);
  std::istringstream lines(read_file(table));
  std::string header, first, second;
  std::getline(lines, header);
  std::getline(lines, first);
  std::getline(lines, second);
  EXPECT_EQ(
      header,
      "gaze_h_deg,gaze_v_deg,x_mm,y_mm,end,sphere_d,cylinder_d,axis_deg,mean_power_error_d,oblique_"
      "astigmatism_d,"
      "tangential_d,sagittal_d,prism_h_pd,prism_v_pd,base_out_pd,object_h_deg,object_v_deg,distortion_ratio,"
      "tca_pd");
  EXPECT_EQ(first, "80,0,,,missed,,,,,,,,,,,,,,");
  EXPECT_EQ(std::count(second.begin(), second.end(), ','), 18);
  EXPECT_FALSE(std::filesystem::exists(folder / "points.limits.csv")) << "no rule, no limits";
}

TEST(LensEvaluate, MapCoversTheLensAndNoMore) {
  const TemporaryFolder folder;
  const std::string outline = folder.write("frame.txt", "-25 -18\n25 -18\n25 18\n-25 18\n").string();
  const std::string file = make_lens(folder, {"--sph", "1", "--outline", outline});
  const json report = evaluate(file, {"--index", "1.5", "--map-step", "6"});
  std::size_t inside = 0;
  for (const json& point : report.at("points")) {
    EXPECT_NE(point.at("end"), "missed");
    EXPECT_LE(std::abs(at(point, "x_mm")), 25.01);
    EXPECT_LE(std::abs(at(point, "y_mm")), 18.01);
    if (std::abs(at(point, "x_mm")) < 24.9 && std::abs(at(point, "y_mm")) < 17.9) ++inside;
  }
  EXPECT_EQ(inside, 9u * 5u) << "x from -24 to 24, y from -12 to 12";
}

TEST(LensEvaluate, SameNumbersOnAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const std::string file = make_lens(folder, {"--sph", "-3", "--cyl", "-1", "--axis", "70"});
  const auto points = [&](const std::string& threads) {
    return evaluate(file,
                    {"--material", "CR-39", "--mode", "as-worn", "--gaze-step", "3", "--threads", threads})
        .at("points");
  };
  EXPECT_EQ(points("1"), points("16"));
}

TEST(LensEvaluate, TextTellsReadingAndTable) {
  const TemporaryFolder folder;
  const std::string file = make_lens(folder, {"--sph", "-4", "--cyl", "-1.5", "--axis", "20"});
  const CommandResult result =
      run_catoptra({"lens", "evaluate", file, "--index", "1.5", "--mode", "as-worn"});
  ASSERT_EQ(result.code, 0) << result.errors;
  for (const char* part : {"-4.000 / -1.500 x 20.0 D", "index 1.5", "as worn, right eye",
                           "object at infinity", "29 of 29 points"})
    EXPECT_NE(result.output.find(part), std::string::npos) << part << " in\n" << result.output;
  // Every row of the table is as wide as its heading.
  std::istringstream lines(result.output);
  std::vector<std::size_t> widths;
  bool table = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("gaze ") != std::string::npos) table = true;
    if (table && line.find("points transmit") == std::string::npos) widths.push_back(line.size());
  }
  ASSERT_EQ(widths.size(), 31u);
  for (const std::size_t width : widths) EXPECT_EQ(width, widths.front());
}

/// Distortion compares lines of sight: a focimeter's reading has none, and 0.00 would be a claim.
TEST(LensEvaluate, FocimeterHasNoDistortion) {
  const TemporaryFolder folder;
  const std::string file = make_lens(folder, {"--sph", "-4"});
  const auto last_row = [&](const char* mode) {
    const CommandResult result =
        run_catoptra({"lens", "evaluate", file, "--index", "1.5", "--mode", mode, "--gaze", "30,0"});
    EXPECT_EQ(result.code, 0) << result.errors;
    std::istringstream lines(result.output);
    std::vector<std::string> cells;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::vector<std::string> found{std::istream_iterator<std::string>(words), {}};
      if (!found.empty() && found[0] == "30.0") cells = found;
    }
    return cells;
  };
  ASSERT_EQ(last_row("lensmeter").size(), 17u);
  EXPECT_EQ(last_row("lensmeter")[15], "-");
  EXPECT_GT(std::stod(last_row("as-worn")[15]), 1);
  EXPECT_EQ(evaluate(file, {"--index", "1.5"}).at("points").at(0).at("distortion"), nullptr);
  EXPECT_TRUE(evaluate(file, {"--index", "1.5", "--mode", "as-worn"})
                  .at("points")
                  .at(0)
                  .at("distortion")
                  .is_number());
}

}  // namespace
}  // namespace catoptra::test
