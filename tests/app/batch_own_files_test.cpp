// What a plan may bring along: glasses of one's own, the sides of a lens, outlines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/batch.h"
#include "cad_import/error.h"
#include "tests/app/batch_files.h"

namespace catoptra::test {
namespace {

using nlohmann::json;

/// BK7 by the formula and coefficients that its maker publishes (Schott 2017).
constexpr const char* kOwnGlass =
    "NM MINE 2 517642 1.5168 64.17 0 0 0\n"
    "CD 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653\nLD 0.3 2.5\n";

app::BatchPlan read(const TemporaryFolder& folder, const std::string& text) {
  return app::read_batch_plan_text(text, "plan.toml", folder.path());
}

std::string refusal(const TemporaryFolder& folder, const std::string& text) {
  try {
    (void)read(folder, text);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

double value_of(const app::BatchResult& result, const std::string& name) {
  const auto& names = app::batch_columns().summary;
  const auto found = std::find(names.begin(), names.end(), name);
  return result.summary.at(std::size_t(found - names.begin()));
}

const std::string kLens = "[[prescriptions]]\nsph = -4\ndiameter = 44\n";

TEST(BatchOwnGlass, ComesFromAFileBesideThePlanAndTravelsWithTheCase) {
  const TemporaryFolder folder;
  folder.write("mine.agf", kOwnGlass);
  const std::string plan =
      "wavelengths_nm = 550\n" + kLens + "catalogue = \"mine.agf\"\nmaterials = [\"mine\", \"N-BK7\"]\n";
  const auto cases = read(folder, plan).cases;
  ASSERT_EQ(cases.size(), 2u);
  const json inputs = json::parse(cases[0].inputs);
  EXPECT_NEAR(inputs["index"].get<double>(), 1.51852238762, 1e-11) << "by 30-digit arithmetic";
  EXPECT_EQ(inputs["material"], "MINE");
  EXPECT_FALSE(json::parse(cases[1].inputs).contains("glass")) << "a built-in glass keeps its key";
  EXPECT_EQ(cases[1].key,
            read(folder, "wavelengths_nm = 550\n" + kLens + "material = \"N-BK7\"\n").cases[0].key);

  std::filesystem::remove(folder / "mine.agf");  // as on another machine
  const auto own = app::result_from_json(app::evaluate_case(app::to_json(cases[0])));
  const auto built_in = app::evaluate_case(cases[1]);
  ASSERT_EQ(own.error, "");
  EXPECT_EQ(app::evaluate_case(cases[0]).summary, own.summary);
  // The same glass by its maker and by the catalogue, to the sixth digit of the index.
  EXPECT_NEAR(value_of(own, "reference_sphere_d"), value_of(built_in, "reference_sphere_d"), 1e-4);
  EXPECT_NEAR(value_of(own, "tca_max_pd"), value_of(built_in, "tca_max_pd"),
              1e-3 * value_of(built_in, "tca_max_pd"));

  folder.write("mine.agf", std::string("CC another file\n") + kOwnGlass);
  EXPECT_NE(read(folder, plan).cases[0].key, cases[0].key) << "the content is part of the key";
}

TEST(BatchOwnGlass, IsToldWhereItIsWrong) {
  const TemporaryFolder folder;
  folder.write("mine.agf", kOwnGlass);
  folder.write("bad.agf", "NM X 99 1 1 1\n");
  // A resonance at 500 nm: no index there.
  folder.write("pole.agf", "NM POLE 2 517642 1.5168 64.17 0 0 0\nCD 1 0.25 0 0 0 0\nLD 0.6 2.5\n");
  const auto with = [&](const std::string& file, const std::string& material) {
    return refusal(folder, kLens + "catalogue = \"" + file + "\"\nmaterial = \"" + material + "\"\n");
  };
  EXPECT_NE(with("none.agf", "mine").find("line 4, prescriptions.catalogue: '"), std::string::npos);
  EXPECT_NE(with("bad.agf", "mine").find("bad.agf': line 1"), std::string::npos) << with("bad.agf", "mine");
  EXPECT_NE(with("mine.agf", "mien").find("MINE"), std::string::npos) << with("mine.agf", "mien");
  EXPECT_NE(with("pole.agf", "pole").find("has no index of 1 to 5 at "), std::string::npos)
      << with("pole.agf", "pole");
}

TEST(BatchSides, AreChosenByTheirNames) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_catoptra({"lens", "make", "--sph", "-4", "--index", "1.5", "--diameter", "44", "-o",
                          (folder / "lens.step").string()})
                .code,
            0);
  const auto with = [&](const std::string& faces) {
    return read(folder, "[[lenses]]\nfiles = [\"lens.step\"]\nmaterial = 1.5\n" + faces).cases.at(0);
  };
  const auto recognised = with(""), named = with("front_faces = [\"front\"]\nback_faces = [\"back\"]\n"),
             exchanged = with("front_faces = [\"back\"]\nback_faces = [\"front\"]\n"),
             misspelt = with("front_faces = [\"frnt\"]\nback_faces = [\"back\"]\n");
  EXPECT_NE(recognised.key, named.key);
  // One after another on one thread: the lens that it keeps must be that of the case.
  const auto line = [](const app::BatchCase& c) {
    return app::result_from_json(app::evaluate_case(app::to_json(c)));
  };
  const auto a = line(recognised), b = line(named), c = line(exchanged), d = line(misspelt);
  const auto numbers = [](app::BatchResult result) {
    result.key.clear();
    return app::to_json(result);  // where no value equals no value
  };
  EXPECT_EQ(numbers(a), numbers(b));
  EXPECT_NE(numbers(a), numbers(c)) << "other sides, another lens";
  EXPECT_NE(d.error.find("did you mean 'front'?"), std::string::npos) << d.error;
  EXPECT_NE(refusal(folder, "[[lenses]]\nfiles = [\"lens.step\"]\nmaterial = 1.5\nfront_faces = 3\n")
                .find("line 4, lenses.front_faces"),
            std::string::npos);
}

TEST(BatchOutline, GivesTheLensOfLensMake) {
  const TemporaryFolder folder;
  const auto outline = folder.write("shape.txt", "-20 -12\n20 -12\n18 14\n-18 14\n");
  ASSERT_EQ(run_catoptra({"lens", "make", "--sph", "-4", "--index", "1.5", "--outline", outline.string(),
                          "-o", (folder / "lens.step").string()})
                .code,
            0);
  const std::string pose = "[[gaze]]\nmax_deg = 40\nstep_deg = 10\n";
  const auto ordered =
      read(folder, "[[prescriptions]]\nsph = -4\nmaterial = 1.5\noutline = \"shape.txt\"\n" + pose)
          .cases.at(0);
  const auto filed = read(folder, "[[lenses]]\nfiles = [\"lens.step\"]\nmaterial = 1.5\n" + pose).cases.at(0);
  std::filesystem::remove(outline);
  const auto a = app::evaluate_case(ordered), b = app::evaluate_case(filed);
  ASSERT_EQ(a.error + b.error, "");
  EXPECT_LT(value_of(a, "points_passed"), value_of(a, "points")) << "some gazes pass beside this small lens";
  for (std::size_t i = 0; i < a.summary.size(); ++i) {
    const std::string& name = app::batch_columns().summary[i];
    if (name == "reference_prism_base_deg") continue;  // of a prism of 1e-9: rounding
    EXPECT_TRUE(std::isnan(a.summary[i]) || std::abs(a.summary[i] - b.summary[i]) < 1e-6)  // STEP: 15 digits
        << name << ": " << a.summary[i] << ", " << b.summary[i];
  }
  EXPECT_NE(ordered.key, read(folder, "[[prescriptions]]\nsph = -4\nmaterial = 1.5\n" + pose).cases[0].key);
}

TEST(BatchOutline, IsToldWhereItIsWrong) {
  const TemporaryFolder folder;
  folder.write("shape.txt", "-20 -12\n20 -12\n18 fourteen\n");
  const std::string lens = "[[prescriptions]]\nmaterial = 1.5\n";
  EXPECT_NE(refusal(folder, lens + "outline = \"none.txt\"\n").find("line 3, prescriptions.outline: '"),
            std::string::npos);
  EXPECT_NE(refusal(folder, lens + "outline = \"shape.txt\"\n").find("shape.txt': line 3"), std::string::npos)
      << refusal(folder, lens + "outline = \"shape.txt\"\n");
  EXPECT_NE(
      refusal(folder, lens + "diameter = 50\noutline = \"shape.txt\"\n").find("outline excludes diameter"),
      std::string::npos);
  EXPECT_NE(refusal(folder, lens + "outlin = \"shape.txt\"\n").find("did you mean 'outline'?"),
            std::string::npos);
}

}  // namespace
}  // namespace catoptra::test
