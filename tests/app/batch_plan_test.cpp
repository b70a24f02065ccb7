// From a plan to cases: how many, in which order, with which keys; and what is wrong with a plan.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "app/batch.h"
#include "cad_import/error.h"
#include "tests/app/batch_plans.h"
#include "tests/app/temporary_folder.h"

namespace catoptra::test {
namespace {

using nlohmann::json;

const std::string kOneLens = "[[prescriptions]]\nsph = -4\nmaterial = \"CR-39\"\n";

TEST(BatchPlan, IsTheCrossProductInThePlansOrder) {
  const app::BatchPlan plan = read(
      "wavelengths_nm = [486.13, 656.27]\n"
      "[[prescriptions]]\nsph = [-2, 2]\ncyl = { from = -1, to = -0.5, step = 0.25 }\naxis = 30\n"
      "materials = [\"CR-39\", 1.6]\n"
      "[[poses]]\n[[poses]]\nmode = \"as-worn\"\npanto_deg = [0, 8]\n"
      "[[gaze]]\nmax_deg = 20\nstep_deg = 5\n[[gaze]]\ndirections_deg = [[0, 0]]\n");
  EXPECT_EQ(plan.cases.size(), 2u * 3 * 2 * 3 * 2 * 2);
  EXPECT_EQ(plan.repeated, 0u);
  const auto sph = column(plan, "sph_d"), cyl = column(plan, "cyl_d"), nm = column(plan, "wavelength_nm");
  EXPECT_EQ(sph.front(), -2);
  EXPECT_EQ(sph.back(), 2);
  EXPECT_EQ(std::set<double>(cyl.begin(), cyl.end()), (std::set<double>{-1, -0.75, -0.5}));
  EXPECT_EQ(nm[0], 486.13);
  EXPECT_EQ(nm[2], 656.27) << "gaze runs faster than wavelengths";
  std::set<std::string> keys;
  for (const auto& entry : plan.cases) keys.insert(entry.key);
  EXPECT_EQ(keys.size(), plan.cases.size());
}

TEST(BatchPlan, ALensThatIsTheSameIsOneCase) {
  // Without a cylinder its axis has no effect, and a number may be written in several ways.
  EXPECT_EQ(read("[[prescriptions]]\ncyl = 0\naxis = [0, 45, 90]\nmaterial = 1.5\n").cases.size(), 1u);
  EXPECT_EQ(read("[[prescriptions]]\ncyl = 0\naxis = [0, 45, 90]\nmaterial = 1.5\n").repeated, 2u);
  const auto written = [](const char* sph) {
    return read(std::string("[[prescriptions]]\nmaterial = \"cr-39\"\nsph = ") + sph + "\n").cases.at(0).key;
  };
  EXPECT_EQ(written("3"), written("3.0"));
  EXPECT_EQ(
      read("[[prescriptions]]\nmaterial = 1.5\nsph = { from = 0.1, to = 0.3, step = 0.1 }\n").cases.at(2).key,
      read("[[prescriptions]]\nmaterial = 1.5\nsph = 0.3\n").cases.at(0).key);
  EXPECT_EQ(read("[[prescriptions]]\nmaterial = 1.5\nsph = -0.0\n").cases.at(0).key,
            read("[[prescriptions]]\nmaterial = 1.5\nsph = 0\n").cases.at(0).key);
}

TEST(BatchPlan, AFileCountsByItsContent) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a");
  std::filesystem::create_directory(folder / "b");
  folder.write("a/lens.step", "same");
  folder.write("b/moved.step", "same");
  folder.write("b/other.step", "other");
  const auto read_here = [&](const std::string& pattern) {
    return app::read_batch_plan_text("[[lenses]]\nfiles = [\"" + pattern + "\"]\nmaterial = 1.5\n",
                                     "plan.toml", folder.path());
  };
  EXPECT_EQ(read_here("a/*.step").cases.at(0).key, read_here("b/moved.step").cases.at(0).key);
  const app::BatchPlan all = read_here("*/*.step");
  EXPECT_EQ(all.cases.size(), 2u);
  EXPECT_EQ(all.repeated, 1u);
  EXPECT_EQ(all.cases[0].source, (folder / "a/lens.step").string());
  EXPECT_EQ(all.cases[1].source, (folder / "b/other.step").string());
}

TEST(BatchPlan, KeysAreTheSameOnEveryMachine) {
  const app::BatchCase entry = read("[[prescriptions]]\nsph = -4\nmaterial = 1.5\n").cases.at(0);
  EXPECT_EQ(entry.inputs,
            R"({"add_d":0.0,"asphere_mm":[],"axis_deg":0.0,"back_conic":0.0,"base_deg":0.0,"center_thickn)"
            R"(ess_mm":null,"conic":0.0,"corridor_mm":14.0,"cyl_d":0.0,"diameter_mm":65.0,"edge_thickness)"
            R"(_mm":null,"evaluation":1,"eye":"right","front":"sphere","front_curve_d":null,"gaze_max_deg)"
            R"(":30.0,"gaze_step_deg":10.0,"index":1.5,"index_c":1.5,"index_f":1.5,"kind":"lens","materia)"
            R"(l":"","mode":"lensmeter","nd":1.5,"object_distance_mm":null,"panto_deg":0.0,"prism_pd":0.0)"
            R"(,"rotation_centre_mm":25.0,"sph_d":-4.0,"vd":null,"vertex_distance_mm":12.0,"wavelength_nm)"
            R"(":587.5618,"wrap_deg":0.0})");
  EXPECT_EQ(entry.key, "cb49516057ebdcd29f7b88e570436b3e84147d702c8d915f9893f9cf8d87fde8")
      << "sha256sum of the line above";
}

TEST(BatchPlan, SamplesComeFromTheirSeed) {
  const auto sample = [](const std::string& seed, const std::string& more) {
    return read(
        "[[prescriptions]]\nsample = { count = 50, seed = " + seed +
        " }\nsph = { from = -8, to = 8, step = 0.25 }\ncyl = { from = -2, to = 0 }\nmaterial = 1.6\n" + more);
  };
  const app::BatchPlan plan = sample("7", "");
  EXPECT_EQ(plan.cases.size() + plan.repeated, 50u);
  const auto sph = column(plan, "sph_d"), cyl = column(plan, "cyl_d");
  EXPECT_GT(std::set<double>(sph.begin(), sph.end()).size(), 20u);
  for (const double value : sph) EXPECT_EQ(value * 4, std::round(value * 4));
  for (const double value : cyl) EXPECT_TRUE(value >= -2 && value <= 0);
  EXPECT_EQ(column(sample("7", ""), "cyl_d"), cyl);
  EXPECT_NE(column(sample("8", ""), "cyl_d"), cyl);
  EXPECT_EQ(column(sample("7", "diameter = [50, 55, 60]\n"), "sph_d"), sph)
      << "one key more changes no other";
}

TEST(BatchPlan, CasesAreLinesOfJson) {
  const app::BatchCase entry = read(kOneLens).cases.at(0);
  const std::string line = app::to_json(entry);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const app::BatchCase again = app::case_from_json(line);
  EXPECT_EQ(again.key, entry.key);
  EXPECT_EQ(again.inputs, entry.inputs);
  json changed = json::parse(line);
  changed["inputs"]["sph_d"] = -5.0;
  EXPECT_THROW((void)app::case_from_json(changed.dump()), Error) << "the key holds the inputs together";
  EXPECT_THROW((void)app::case_from_json("{"), Error);
  EXPECT_THROW((void)app::case_from_json("{\"key\": 1}"), Error);
}

TEST(BatchPlan, WhatIsWrongIsToldWithItsLine) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"", "has no case"},
      {"[[poses]]\npanto_deg = 8\n", "has no case"},
      {"nonsense = 1\n" + kOneLens, "line 1, nonsense: unknown key"},
      {kOneLens + "sphere = 2\n", "line 4, prescriptions.sphere: unknown key"},
      {kOneLens + "cyl = \"1\"\n", "line 4, prescriptions.cyl: expected a number, a list or a range"},
      {kOneLens + "cyl = []\n", "line 4, prescriptions.cyl: the list is empty"},
      {kOneLens + "cyl = { from = 0, to = 1 }\n", "the range has no 'step'"},
      {kOneLens + "cyl = { from = 1, to = 0, step = 1 }\n", "ends before it begins"},
      {kOneLens + "cyl = { from = 0, to = 1, step = 0 }\n", "must be greater than 0"},
      {kOneLens + "cyl = { from = 0, to = 1e9, step = 1 }\n", "more than 100000 values"},
      {kOneLens + "cyl = nan\n", "must be a finite number"},
      {kOneLens + "sample = { count = 3 }\n", "seed: this key is required"},
      {kOneLens + "sample = { count = 0, seed = 1 }\n", "out of range"},
      {"[[prescriptions]]\nsph = 1\n", "prescriptions.material: this key is required"},
      {"[[prescriptions]]\nmaterial = \"CR-93\"\n", "line 2, prescriptions.material"},
      {"[[prescriptions]]\nmaterial = { nd = 1.6 }\n", "has nd and vd"},
      {"[[prescriptions]]\nmaterial = 0.9\n", "line 2, prescriptions.material"},
      {"[[lenses]]\nfiles = [\"none*.step\"]\nmaterial = 1.5\n", "line 2, lenses.files: no file matches"},
      {"[[lenses]]\nfiles = []\nmaterial = 1.5\n", "line 2, lenses.files"},
      {kOneLens + "[[poses]]\nmode = \"worn\"\n", "line 5, poses.mode"},
      {kOneLens + "[[poses]]\nrotation_centre_mm = 0\n", "line 5, poses.rotation_centre_mm"},
      {kOneLens + "[[gaze]]\nmax_deg = 90\n", "line 5, gaze.max_deg"},
      {kOneLens + "[[gaze]]\nmax_deg = 80\nstep_deg = 0.01\n", "more than 100000 directions"},
      {kOneLens + "[[gaze]]\ndirections_deg = [[1, 2, 3]]\n", "line 5, gaze.directions_deg"},
      {"wavelengths_nm = 300\n" + kOneLens, "line 1, wavelengths_nm: 300 is out of range"},
      {"[[prescriptions]\n", "line 1"},
      {"[[prescriptions]]\nmaterial = 1.5\nsph = { from = 0, to = 9, step = 0.01 }\ncyl = { from = 0, to = "
       "9, step = "
       "0.001 }\n",
       "more than 1000000 cases"},
  };
  for (const auto& [text, reason] : wrong) {
    const std::string told = refusal(text);
    EXPECT_EQ(told.rfind("plan.toml: ", 0), 0u) << text << told;
    EXPECT_NE(told.find(reason), std::string::npos) << text << told;
  }
}

}  // namespace
}  // namespace catoptra::test
