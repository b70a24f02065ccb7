// What a batch computes: right numbers, the same for any number of threads and by any way.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "app/batch.h"
#include "cad_import/error.h"
#include "tests/app/batch_files.h"

namespace catoptra::test {
namespace {

using nlohmann::json;

json export_of(const std::filesystem::path& database, const TemporaryFolder& folder, bool points = true) {
  std::vector<std::string> words{"batch",           "export", "--db",
                                 database.string(), "-o",     (folder / "out.json").string()};
  if (points) words.push_back("--points");
  const CommandResult result = run_catoptra(words);
  EXPECT_EQ(result.code, 0) << result.errors;
  return json::parse(read_file(folder / "out.json")).at("cases");
}

// Lenses worn 27 mm before the rotation centre: tangential and sagittal power on the vertex sphere and object
// angle by an exact trace that shares no code with this one (front curve, back curve, thickness, index 1.5).
TEST(Batch, GivesTheOffAxisPowersOfAnIndependentTrace) {
  const TemporaryFolder folder;
  const auto plan =
      folder.write("plan.toml",
                   "[[prescriptions]]\nsph = -3.951612903225806\nfront_curve = 6\ncenter_thickness = 2\n"
                   "diameter = 60\nmaterial = 1.5\n"
                   "[[prescriptions]]\nsph = 4.916666666666667\nfront_curve = 10\ncenter_thickness = 6\n"
                   "diameter = 60\nmaterial = 1.5\n"
                   "[[poses]]\nmode = \"as-worn\"\nrotation_centre_mm = 27\n"
                   "[[gaze]]\ndirections_deg = [[0, 15], [0, 30]]\n");
  const auto database = folder / "r.sqlite";
  ASSERT_EQ(run_catoptra({"batch", "run", plan.string(), "--db", database.string()}).code, 0);
  const json cases = export_of(database, folder);
  ASSERT_EQ(cases.size(), 2u);
  struct Known {
    double tangential_d, sagittal_d, object_deg;
  };
  const std::vector<std::vector<Known>> known{
      {{-3.89557, -3.90794, 16.50120}, {-3.67411, -3.76332, 33.20467}},
      {{4.87847, 4.85828, 12.45187}, {4.71469, 4.67072, 24.69377}}};
  for (std::size_t lens = 0; lens < 2; ++lens) {
    EXPECT_NEAR(cases[lens]["summary"]["reference_sphere_d"].get<double>(), lens == 0 ? -3.951613 : 4.916667,
                2e-4);
    for (std::size_t i = 0; i < 2; ++i) {
      const json& point = cases[lens]["points"][i];
      // The made surfaces are B-splines: their second derivatives are within 3e-6 / mm, 0.0015 D at this
      // index.
      EXPECT_NEAR(point["tangential_d"].get<double>(), known[lens][i].tangential_d, 1e-4);
      EXPECT_NEAR(point["sagittal_d"].get<double>(), known[lens][i].sagittal_d, 1e-4);
      EXPECT_NEAR(point["object_v_deg"].get<double>(), known[lens][i].object_deg, 1e-4);
      EXPECT_TRUE(point["tca_pd"].is_null()) << "one index for all wavelengths has no transverse colour";
    }
  }
}

const std::string kMixed =
    "wavelengths_nm = [546.07, 587.56]\n"
    "[[prescriptions]]\nsph = [-4, 2]\ncyl = -0.75\naxis = 30\ndiameter = 44\nmaterials = [\"CR-39\", { nd = "
    "1.6, vd "
    "= 41 }]\n"
    "[[prescriptions]]\nsph = 60\nmaterial = 1.5\n"  // too steep for its diameter
    "[[poses]]\nmode = \"as-worn\"\npanto_deg = [0, 8]\nwrap_deg = 5\n[[poses]]\n"
    "[[gaze]]\nmax_deg = 40\nstep_deg = 20\n";

TEST(Batch, RowsAreTheSameForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const auto plan = folder.write("plan.toml", kMixed);
  const auto one = folder / "one.sqlite";
  ASSERT_EQ(run_catoptra({"batch", "run", plan.string(), "--db", one.string(), "--jobs", "1"}).code, 0);
  for (const std::string jobs : {"2", "7"}) {
    const auto several = folder / (jobs + ".sqlite");
    ASSERT_EQ(run_catoptra({"batch", "run", plan.string(), "--db", several.string(), "--jobs", jobs}).code,
              0);
    EXPECT_EQ(exported(several), exported(one));
    EXPECT_EQ(differing_table(several, one), "");
  }
}

// What workers on other machines do: lines of JSON in, lines of JSON out, put into the database in any order.
TEST(Batch, RowsOfWorkersAreThoseOfOneMachineBitForBit) {
  const TemporaryFolder folder;
  const auto plan_file = folder.write("plan.toml", kMixed);
  const auto local = folder / "local.sqlite", spread = folder / "spread.sqlite";
  ASSERT_EQ(run_catoptra({"batch", "run", plan_file.string(), "--db", local.string()}).code, 0);
  const CommandResult listed = run_catoptra({"batch", "run", plan_file.string(), "--list"});
  ASSERT_EQ(listed.code, 0) << listed.errors;
  std::vector<std::string> lines;
  std::istringstream stream(listed.output);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 2u * 2 * 2 * 3 + 2 * 3);
  {
    app::BatchStore store(spread);
    EXPECT_EQ(store.add(app::read_batch_plan(plan_file)), lines.size());
    for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
      const std::string answer = app::evaluate_case(*line);
      EXPECT_EQ(app::to_json(app::result_from_json(answer)), answer);
      store.put(app::result_from_json(answer));
      store.put(app::result_from_json(answer));  // a shard that was retried
    }
    app::BatchResult stranger = app::result_from_json(app::evaluate_case(lines.front()));
    stranger.key.front() = stranger.key.front() == '0' ? '1' : '0';
    EXPECT_THROW(store.put(stranger), Error);
  }
  EXPECT_EQ(differing_table(spread, local), "");
  EXPECT_EQ(exported(spread), exported(local));
}

TEST(Batch, AFailedCaseIsARowAndTheRestGoOn) {
  const TemporaryFolder folder;
  folder.write("broken.step", "ISO-10303-21;\nHEADER;\nthis is no STEP file\n");
  const auto plan = folder.write("plan.toml", kMixed + "[[lenses]]\nfiles = [\"*.step\"]\nmaterial = 1.5\n");
  const auto database = folder / "r.sqlite";
  const CommandResult ran = run_catoptra({"batch", "run", plan.string(), "--db", database.string()});
  ASSERT_EQ(ran.code, 0) << ran.errors;
  EXPECT_NE(ran.output.find("36 computed, 12 of them failed"), std::string::npos) << ran.output;
  const json cases = export_of(database, folder);
  std::size_t failed = 0;
  for (const json& row : cases) {
    const bool bad = row["status"] == "failed";
    failed += bad;
    EXPECT_EQ(row["error"].is_null(), !bad);
    EXPECT_EQ(row["summary"].is_null(), bad);
    EXPECT_EQ(row["points"].empty(), bad);
    EXPECT_TRUE(!bad || row["error"].get<std::string>().find(folder.path().string()) == std::string::npos);
  }
  EXPECT_EQ(failed, 12u);

  const json status =
      json::parse(run_catoptra({"batch", "status", "--db", database.string(), "--json"}).output);
  EXPECT_EQ(status["done"], 24);
  EXPECT_EQ(status["failed"], 12);
  EXPECT_EQ(status["pending"], 0);
  ASSERT_EQ(status["failures"].size(), 2u);
  EXPECT_NE(status["failures"][0]["example"].get<std::string>().find("is cut off"), std::string::npos);
  EXPECT_NE(status["failures"][1]["example"].get<std::string>().find("radius"), std::string::npos);
  const std::string text = run_catoptra({"batch", "status", "--db", database.string()}).output;
  EXPECT_EQ(text.rfind("36 cases: 24 done, 12 failed, 0 pending\nfailed 6 x: ", 0), 0u) << text;

  const CommandResult again =
      run_catoptra({"batch", "run", plan.string(), "--db", database.string(), "--strict"});
  EXPECT_EQ(again.code, 3);
  EXPECT_NE(again.output.find("nothing to do"), std::string::npos) << again.output;
  const CommandResult retried =
      run_catoptra({"batch", "run", plan.string(), "--db", database.string(), "--retry-failed"});
  EXPECT_NE(retried.output.find("12 computed, 12 of them failed"), std::string::npos) << retried.output;
}

TEST(Batch, AFinishedDatabaseStaysAndALargerPlanAddsToIt) {
  const TemporaryFolder folder;
  const auto plan = folder.write("plan.toml", many_poses_plan(1, 10));
  const auto database = folder / "r.sqlite";
  ASSERT_EQ(run_catoptra({"batch", "run", plan.string(), "--db", database.string()}).code, 0);
  const std::string before = read_file(database);
  const CommandResult again = run_catoptra({"batch", "run", plan.string(), "--db", database.string()});
  EXPECT_EQ(again.code, 0);
  EXPECT_NE(
      again.output.find("10 cases in the plan; all are in " + database.string() + " already, nothing to do"),
      std::string::npos)
      << again.output;
  EXPECT_EQ(read_file(database), before);
  const auto larger = folder.write("larger.toml", many_poses_plan(1, 15));
  const CommandResult more = run_catoptra({"batch", "run", larger.string(), "--db", database.string()});
  EXPECT_NE(more.output.find("15 cases in the plan, 5 computed, 0 of them failed"), std::string::npos)
      << more.output;
}

TEST(Batch, TheExampleRuns) {
  const TemporaryFolder folder;
  const auto database = folder / "r.sqlite";
  const CommandResult ran = run_catoptra(
      {"batch", "run", CATOPTRA_PLANS "/single_vision.toml", "--db", database.string(), "--strict"});
  EXPECT_EQ(ran.code, 0) << ran.output << ran.errors;
  // (6 spheres x 2 cylinders x 2 materials + 4 drawn) x 3 poses
  EXPECT_NE(ran.output.find("84 cases in the plan, 84 computed, 0 of them failed"), std::string::npos)
      << ran.output;
}

TEST(Batch, AFileThatChangedSinceThePlanIsAnError) {
  const TemporaryFolder folder;
  folder.write("lens.step", "first");
  const auto plan = folder.write("plan.toml", "[[lenses]]\nfiles = [\"lens.step\"]\nmaterial = 1.5\n");
  const app::BatchCase entry = app::read_batch_plan(plan).cases.at(0);
  folder.write("lens.step", "second");
  EXPECT_NE(app::evaluate_case(entry).error.find("is no longer what the plan was made from"),
            std::string::npos);
}

TEST(Batch, TablesNameTheirUnitsAndReadBackExactly) {
  const TemporaryFolder folder;
  const auto plan = folder.write("plan.toml", many_poses_plan(1, 3));
  const auto database = folder / "r.sqlite";
  ASSERT_EQ(run_catoptra({"batch", "run", plan.string(), "--db", database.string()}).code, 0);
  const json rows = export_of(database, folder);
  const std::string csv = run_catoptra({"batch", "export", "--db", database.string(), "-o", "-"}).output;
  std::istringstream lines(csv);
  std::string header, row;
  std::getline(lines, header);
  std::getline(lines, row);
  const auto names = csv_cells(header), cells = csv_cells(row);
  ASSERT_EQ(names.size(), cells.size());
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << "no name twice";
  const auto cell = [&](const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? "no column " + name : cells[std::size_t(found - names.begin())];
  };
  EXPECT_EQ(cell("sph_d"), "-1");
  EXPECT_EQ(cell("rotation_centre_mm"), "25");
  EXPECT_EQ(cell("object_distance_mm"), "") << "infinity";
  EXPECT_EQ(std::stod(cell("reference_sphere_d")), rows[0]["summary"]["reference_sphere_d"].get<double>());
  EXPECT_EQ(number_in_sqlite(database, "SELECT reference_sphere_d FROM lens_cases WHERE sph_d = -1"),
            rows[0]["summary"]["reference_sphere_d"].get<double>());
  EXPECT_EQ(ask_sqlite(database, "SELECT count(*) FROM points WHERE end = 0"), "63");
  EXPECT_EQ(run_catoptra({"batch", "export", "--db", database.string(), "-o", "x.xlsx"}).code, 2);
  EXPECT_EQ(run_catoptra({"batch", "report", "--db", database.string(), "-o", "-"})
                .output.rfind("<!doctype html>", 0),
            0u);
  EXPECT_EQ(run_catoptra({"batch", "run", plan.string()}).code, 2) << "--db is required";
}

}  // namespace
}  // namespace catoptra::test
