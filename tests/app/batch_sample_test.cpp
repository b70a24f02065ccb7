// Random samples of prescriptions, materials, poses and wavelengths: what is drawn, and that it depends on
// nothing but seed, draw and key.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "app/batch.h"
#include "app/src/counter_random.h"
#include "cad_import/error.h"
#include "tests/app/batch_files.h"
#include "tests/app/batch_plans.h"

namespace catoptra::test {
namespace {

using nlohmann::json;

std::vector<std::string> keys_of(const app::BatchPlan& plan) {
  std::vector<std::string> keys;
  for (const auto& entry : plan.cases) keys.push_back(entry.key);
  return keys;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / double(values.size());
}

double sd_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double sum = 0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / double(values.size() - 1));
}

// The known answers that come with the method (Salmon et al. 2011, Random123).
TEST(CounterRandom, PhiloxGivesItsKnownAnswers) {
  using Words = std::array<std::uint32_t, 4>;
  EXPECT_EQ(app::philox4x32({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(app::philox4x32({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(app::philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

// Phi(quantile(p)) = p, by the C library's error function.
TEST(CounterRandom, QuantilesAreThoseOfTheNormalDistribution) {
  for (const double p : {1e-15, 1e-9, 1e-4, 0.01, 0.0749, 0.075, 0.3, 0.5, 0.8, 0.9251, 0.99, 0.9999}) {
    const double z = app::normal_quantile(p);
    EXPECT_NEAR(0.5 * std::erfc(-z / std::sqrt(2.0)), p, 4e-14 * p) << z;
  }
  EXPECT_NEAR(app::normal_quantile(0.975), 1.959963984540054, 4e-15) << "tables";
}

TEST(CounterRandom, FieldsDrawsAndSeedsAreIndependent) {
  const app::RandomNumber one{7, 3, "panto_deg"};
  EXPECT_EQ(one.uniform(), (app::RandomNumber{7, 3, "panto_deg"}.uniform()));
  std::set<double> values;
  for (const std::uint32_t seed : {7u, 8u})
    for (const std::uint64_t draw : {std::uint64_t(3), std::uint64_t(4), std::uint64_t(1) << 32})
      for (const char* field : {"panto_deg",
                                "wrap_deg",
                                "rotation_centre_mm",
                                "vertex_distance_mm",
                                "object_distance_mm",
                                "wavelengths_nm",
                                "material",
                                "nd",
                                "vd",
                                "sph",
                                "cyl",
                                "axis",
                                "add",
                                "corridor",
                                "prism",
                                "base_deg",
                                "front_curve",
                                "conic",
                                "back_conic",
                                "center_thickness",
                                "edge_thickness",
                                "diameter"})
        values.insert(app::RandomNumber{seed, draw, field}.uniform());
  EXPECT_EQ(values.size(), 2u * 3 * 22) << "two keys of plans share their stream";
}

const std::string kEverything =
    "wavelengths_nm = { from = 450, to = 650 }\n"
    "[[prescriptions]]\nsph = { mean = -2, sd = 1.5, min = -6, max = 3 }\ncyl = { from = -2, to = 0, step = "
    "0.25 }\n"
    "axis = { from = 0, to = 180 }\ndiameter = 40\n"
    "materials = [\"CR-39\", 1.6, { nd = { from = 1.5, to = 1.7 }, vd = { from = 30, to = 58 } }]\n"
    "[[poses]]\nmode = \"as-worn\"\n"
    "vertex_distance_mm = { mean = 12, sd = 1, min = 9, max = 15 }\n"
    "panto_deg = { mean = 8, sd = 2, min = 7, max = 12 }\n"
    "wrap_deg = { from = 0, to = 10 }\nobject_distance_mm = [400, 1000]\n"
    "rotation_centre_mm = { from = 24, to = 28, step = 0.5 }\n"
    "[[gaze]]\nmax_deg = 20\nstep_deg = 20\n";

std::string sampled(int count, int seed) {
  return "sample = { count = " + std::to_string(count) + ", seed = " + std::to_string(seed) + " }\n" +
         kEverything;
}

// Standard error of a mean: sd / sqrt(n); of a standard deviation: at most sd / sqrt(2 n) for these shapes.
// Four of them at a fixed seed.
TEST(BatchSample, MomentsAndRangesAreThoseAskedFor) {
  constexpr int kCount = 4000;
  const app::BatchPlan plan = read(sampled(kCount, 11));
  ASSERT_EQ(plan.cases.size(), std::size_t(kCount)) << "one case per draw";
  struct Expected {
    const char* name;
    double mean, sd, min, max;
  };
  // Normal distributions cut to [a, b] (in sd): mean + sd (phi(a) - phi(b)) / Z, var by the usual formula;
  // from Johnson, Kotz and Balakrishnan 1994, 10.1. Even ones: the middle, and the width / sqrt(12).
  const auto cut = [](double mean, double sd, double min, double max) {
    const auto phi = [](double z) { return std::exp(-z * z / 2) / std::sqrt(2 * M_PI); };
    const auto big = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
    const double a = (min - mean) / sd, b = (max - mean) / sd, z = big(b) - big(a);
    const double shift = (phi(a) - phi(b)) / z;
    return std::pair(mean + sd * shift, sd * std::sqrt(1 + (a * phi(a) - b * phi(b)) / z - shift * shift));
  };
  const auto sph = cut(-2, 1.5, -6, 3), vertex = cut(12, 1, 9, 15), panto = cut(8, 2, 7, 12);
  for (const Expected& e : {Expected{"sph_d", sph.first, sph.second, -6, 3},
                            {"vertex_distance_mm", vertex.first, vertex.second, 9, 15},
                            {"panto_deg", panto.first, panto.second, 7, 12},
                            {"wrap_deg", 5, 10 / std::sqrt(12.0), 0, 10},
                            {"wavelength_nm", 550, 200 / std::sqrt(12.0), 450, 650},
                            {"object_distance_mm", 700, 300, 400, 1000},
                            {"rotation_centre_mm", 26, std::sqrt((81 - 1) / 12.0) / 2, 24, 28}}) {
    const auto values = column(plan, e.name);
    EXPECT_GE(*std::min_element(values.begin(), values.end()), e.min) << e.name;
    EXPECT_LE(*std::max_element(values.begin(), values.end()), e.max) << e.name;
    EXPECT_NEAR(mean_of(values), e.mean, 4 * e.sd / std::sqrt(double(kCount))) << e.name;
    EXPECT_NEAR(sd_of(values), e.sd, 4 * e.sd / std::sqrt(2.0 * kCount)) << e.name;
  }
  // No key follows another: correlations within 4 / sqrt(n).
  const auto a = column(plan, "wrap_deg"), b = column(plan, "wavelength_nm");
  double product = 0;
  for (std::size_t i = 0; i < a.size(); ++i) product += (a[i] - mean_of(a)) * (b[i] - mean_of(b));
  EXPECT_LT(std::abs(product / double(kCount) / sd_of(a) / sd_of(b)), 4 / std::sqrt(double(kCount)));
}

TEST(BatchSample, MaterialsComeEvenlyFromTheirList) {
  constexpr int kCount = 3000;
  const app::BatchPlan plan = read(sampled(kCount, 5));
  int named = 0, constant = 0;
  std::vector<double> nd, vd;
  for (const auto& entry : plan.cases) {
    const json inputs = json::parse(entry.inputs);
    if (inputs["material"] == "CR-39") {
      ++named;
    } else if (inputs["vd"].is_null()) {
      EXPECT_EQ(inputs["nd"], 1.6);
      ++constant;
    } else {
      nd.push_back(inputs["nd"].get<double>());
      vd.push_back(inputs["vd"].get<double>());
    }
  }
  // Of a binomial distribution, four standard deviations.
  const double width = 4 * std::sqrt(kCount * (1.0 / 3) * (2.0 / 3));
  EXPECT_NEAR(named, kCount / 3.0, width);
  EXPECT_NEAR(constant, kCount / 3.0, width);
  EXPECT_TRUE(std::all_of(nd.begin(), nd.end(), [](double n) { return n >= 1.5 && n <= 1.7; }));
  EXPECT_TRUE(std::all_of(vd.begin(), vd.end(), [](double v) { return v >= 30 && v <= 58; }));
  EXPECT_NEAR(mean_of(nd), 1.6, 4 * 0.2 / std::sqrt(12.0 * double(nd.size())));
  EXPECT_NEAR(mean_of(vd), 44, 4 * 28 / std::sqrt(12.0 * double(vd.size())));
}

TEST(BatchSample, MoreDrawsKeepTheFirstOnes) {
  const auto few = keys_of(read(sampled(50, 3))), many = keys_of(read(sampled(80, 3)));
  ASSERT_EQ(few.size(), 50u);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
  EXPECT_NE(keys_of(read(sampled(50, 4))), few);
}

TEST(BatchSample, OneKeyMoreChangesNoOther) {
  const std::string plan =
      "[sample]\ncount = 30\nseed = 2\n[[prescriptions]]\nsph = { from = -4, to = 4 }\nmaterial = 1.5\n"
      "[[poses]]\nmode = \"as-worn\"\npanto_deg = { from = 0, to = 12 }\n";
  const auto before = read(plan), after = read(plan + "wrap_deg = { from = 0, to = 5 }\n");
  EXPECT_EQ(column(before, "sph_d"), column(after, "sph_d"));
  EXPECT_EQ(column(before, "panto_deg"), column(after, "panto_deg"));
}

TEST(BatchSample, TablesAreCombinedAndShareTheirDraws) {
  const auto plan = read(
      "sample = { count = 10, seed = 2 }\n"
      "[[prescriptions]]\nsph = { from = -4, to = 4 }\nmaterial = 1.5\n"
      "[[poses]]\neye = \"left\"\npanto_deg = { from = 0, to = 12 }\n"
      "[[poses]]\neye = \"right\"\npanto_deg = { from = 0, to = 12 }\n"
      "[[gaze]]\n[[gaze]]\nmax_deg = 20\n");
  ASSERT_EQ(plan.cases.size(), 10u * 2 * 2);
  const auto panto = column(plan, "panto_deg"), sph = column(plan, "sph_d");
  for (std::size_t i = 0; i < plan.cases.size(); i += 4)
    for (std::size_t k = 1; k < 4; ++k) {
      EXPECT_EQ(panto[i + k], panto[i]);
      EXPECT_EQ(sph[i + k], sph[i]);
    }
}

TEST(BatchSample, ASampleOfOneTableEntersTheGrid) {
  const auto plan = read(
      "wavelengths_nm = { from = 450, to = 650 }\nwavelength_sample = { count = 3, seed = 1 }\n"
      "[[prescriptions]]\nsph = [-4, 4]\nmaterial = { from = 1.5, to = 1.7 }\n"
      "material_sample = { count = 5, seed = 1 }\n"
      "[[poses]]\nsample = { count = 4, seed = 9 }\npanto_deg = { from = 0, to = 12 }\n"
      "[[poses]]\nwrap_deg = [0, 5]\n");
  EXPECT_EQ(plan.cases.size(), 2u * 5 * (4 + 2) * 3);
  const auto nd = column(plan, "nd"), nm = column(plan, "wavelength_nm");
  EXPECT_EQ(std::set<double>(nd.begin(), nd.end()).size(), 5u);
  EXPECT_EQ(std::set<double>(nm.begin(), nm.end()).size(), 3u);
  // A grid of materials, too.
  EXPECT_EQ(
      read("[[prescriptions]]\nmaterial = { nd = [1.5, 1.6], vd = { from = 30, to = 50, step = 10 } }\n")
          .cases.size(),
      6u);
}

TEST(BatchSample, OldPlansKeepTheirKeys) {
  for (const std::string name : {"grid", "sample"}) {
    const std::filesystem::path folder = CATOPTRA_GOLDEN_PLANS;
    std::istringstream golden(read_file(folder / (name + ".keys")));
    std::vector<std::string> keys;
    for (std::string key; golden >> key;) keys.push_back(key);
    ASSERT_GT(keys.size(), 400u);
    EXPECT_EQ(keys_of(app::read_batch_plan(folder / (name + ".toml"))), keys) << name;
  }
}

TEST(BatchSample, RowsAreTheSameForAnyNumberOfThreadsAndShards) {
  const TemporaryFolder folder;
  const auto plan = folder.write("plan.toml", sampled(24, 1));
  const auto one = folder / "1.sqlite", shards = folder / "shards.sqlite";
  ASSERT_EQ(run_catoptra({"batch", "run", plan.string(), "--db", one.string(), "--jobs", "1"}).code, 0);
  for (const std::string jobs : {"2", "3"}) {
    const auto several = folder / (jobs + ".sqlite");
    ASSERT_EQ(run_catoptra({"batch", "run", plan.string(), "--db", several.string(), "--jobs", jobs}).code,
              0);
    EXPECT_EQ(differing_table(several, one), "") << jobs;
  }
  {  // every third case first, then the others backwards
    app::BatchStore store(shards);
    const app::BatchPlan read_plan = app::read_batch_plan(plan);
    store.add(read_plan);
    for (std::size_t i = 0; i < read_plan.cases.size(); i += 3)
      store.put(app::result_from_json(app::evaluate_case(app::to_json(read_plan.cases[i]))));
    for (std::size_t i = read_plan.cases.size(); i-- > 0;)
      if (i % 3) store.put(app::result_from_json(app::evaluate_case(app::to_json(read_plan.cases[i]))));
  }
  EXPECT_EQ(differing_table(shards, one), "");
  // A larger count goes on from there.
  const auto larger = folder.write("larger.toml", sampled(30, 1));
  const CommandResult more = run_catoptra({"batch", "run", larger.string(), "--db", one.string()});
  EXPECT_NE(more.output.find("30 cases in the plan, 6 computed, 0 of them failed"), std::string::npos)
      << more.output << more.errors;
}

TEST(BatchSample, TheExampleRuns) {
  const TemporaryFolder folder;
  const auto database = folder / "r.sqlite";
  const CommandResult ran = run_catoptra(
      {"batch", "run", CATOPTRA_PLANS "/tolerances.toml", "--db", database.string(), "--strict"});
  EXPECT_EQ(ran.code, 0) << ran.output << ran.errors;
  EXPECT_NE(ran.output.find("60 cases in the plan, 60 computed, 0 of them failed"), std::string::npos)
      << ran.output;
}

TEST(BatchSample, WhatIsWrongIsToldWithItsLine) {
  const std::string sample = "sample = { count = 3, seed = 1 }\n",
                    lens = "[[prescriptions]]\nmaterial = 1.5\n";
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"smaple = { count = 3, seed = 1 }\n" + lens, "line 1, smaple: unknown key (did you mean 'sample'?)"},
      {"sample = { count = 3 }\n" + lens, "sample.seed: this key is required"},
      {"sample = { cont = 3, seed = 1 }\n" + lens, "did you mean 'count'?"},
      {"sample = 3\n" + lens, "line 1, sample: expected a table"},
      {sample + lens + "[[poses]]\nsample = { count = 3, seed = 1 }\n",
       "line 5, poses.sample: the sample of the whole plan draws the poses already"},
      {sample + lens + "material_sample = { count = 3, seed = 1 }\n", "draws the materials already"},
      {sample + lens + "sample = { count = 3, seed = 1 }\n", "draws the prescriptions already"},
      {"wavelength_sample = { count = 3, seed = 1 }\n" + lens, "there is no wavelengths_nm to draw from"},
      {lens + "[[poses]]\nsmple = { count = 3, seed = 1 }\n", "did you mean 'sample'?"},
      {lens + "[[poses]]\npanto_deg = { mean = 8, sd = 1, min = 5, max = 11 }\n",
       "line 4, poses.panto_deg: only samples draw from a normal distribution"},
      {sample + lens + "sph = { mean = 8, sd = 1 }\n",
       "line 4, prescriptions.sph: the normal distribution has no 'min'"},
      {sample + lens + "sph = { mean = 8, sd = 0, min = 5, max = 11 }\n", "sph.sd: 0 is out of range"},
      {sample + lens + "sph = { mean = 8, sd = 1, min = 9, max = 11 }\n",
       "the mean is not between min and max"},
      {sample + lens + "sph = { mean = 8, sd = 1, min = 8, max = 8.05 }\n", "nearer to one another"},
      {sample + lens + "sph = { mean = 8, sd = 1, min = 5, max = 11, step = 1 }\n",
       "mean and sd exclude 'step'"},
      {sample + lens + "sph = { men = 8, sd = 1, min = 5, max = 11 }\n", "did you mean 'mean'?"},
      {sample + lens + "[[poses]]\nvertex_distance_mm = { mean = 1, sd = 1, min = -1, max = 3 }\n",
       "vertex_distance_mm.min: -1 is out of range"},
      {sample + "[[prescriptions]]\nmaterial = { nd = { from = 0.9, to = 1.5 }, vd = 40 }\n",
       "nd.from: 0.9 is out of range"},
      {"[[prescriptions]]\nmaterial = { nd = { from = 1.4, to = 1.5 }, vd = 40 }\n",
       "the range has no 'step'"},
      {"[[prescriptions]]\nmaterials = [{ nd = 1.5 }]\n", "has nd and vd"},
      {"sample = { count = 1000000, seed = 1 }\n" + lens + "[[poses]]\n[[poses]]\n",
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
