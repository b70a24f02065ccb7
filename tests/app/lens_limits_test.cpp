// A reading against an order by the rules in the program: which figure is taken, and what counts as a
// deviation.
#include "app/src/lens_limits.h"

#include <gtest/gtest.h>

#include <numbers>

#include "app/src/file_hash.h"
#include "tests/app/temporary_folder.h"

namespace catoptra::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

LensOrder order(double sphere, double cylinder, double axis_deg) {
  LensOrder result;
  result.power = {sphere, cylinder, axis_deg * kDegree};
  return result;
}

LensReading reading(double sphere, double cylinder, double axis_deg) {
  LensReading result;
  result.power = {sphere, cylinder, axis_deg * kDegree};
  return result;
}

LensVerdict judged(const std::string& rule, const LensOrder& order, const LensReading& reading) {
  return judge_lens(find_rule(rule, lens_rule_words()), order, reading);
}

/// The first limit on `quantity`; fails the test and returns an empty one where there is none.
LensLimit limit_on(const LensVerdict& verdict, const std::string& quantity) {
  for (const LensLimit& limit : verdict.limits)
    if (limit.figure.quantity == quantity) return limit;
  ADD_FAILURE() << "no limit on " << quantity;
  return {};
}

bool skipped(const LensVerdict& verdict, const std::string& quantity) {
  for (const NotJudged& n : verdict.not_judged)
    if (n.quantity == quantity) return true;
  return false;
}

/// Table 1: rows by the higher meridian, columns of the cylinder.
TEST(JudgeLens, FigureByMeridianAndCylinder) {
  struct Case {
    double sphere, cylinder, meridian_limit, cylinder_limit;
  };
  for (const Case& c : {Case{0, 0, 0.12, 0.09}, Case{-2, -0.75, 0.12, 0.09}, Case{-2, -1, 0.12, 0.12},
                        Case{-5, -2, 0.12, 0.18}, Case{-10, -2, 0.18, 0.18}, Case{2, 5, 0.12, 0.18},
                        Case{-15, -7, 0.37, 0.37}, Case{13, -6.5, 0.25, 0.25}}) {
    const LensVerdict verdict =
        judged("iso-8980-1-2004", order(c.sphere, c.cylinder, 90), reading(c.sphere, c.cylinder, 90));
    EXPECT_EQ(limit_on(verdict, "meridian_power").limit, c.meridian_limit) << c.sphere << " " << c.cylinder;
    EXPECT_EQ(limit_on(verdict, "cylinder").limit, c.cylinder_limit) << c.sphere << " " << c.cylinder;
    EXPECT_TRUE(verdict.passed());
  }
}

TEST(JudgeLens, OnTheLimitPassesAndBeyondFails) {
  EXPECT_TRUE(judged("iso-8980-1-2004", order(-3, 0, 180), reading(-3.12, 0, 180)).passed());
  EXPECT_FALSE(judged("iso-8980-1-2004", order(-3, 0, 180), reading(-3.13, 0, 180)).passed());
  EXPECT_FALSE(judged("iso-8980-1-2004", order(-3, 0, 180), reading(-3, -0.1, 180)).passed())
      << "no cylinder ordered";
}

TEST(JudgeLens, PercentOfTheOrder) {
  const LensVerdict verdict = judged("ansi-z80.1-2015", order(-8, -5, 10), reading(-8.1, -5.1, 10));
  EXPECT_NEAR(limit_on(verdict, "sphere").limit, 0.16, 1e-12);
  EXPECT_NEAR(limit_on(verdict, "cylinder").limit, 0.2, 1e-12);
  EXPECT_EQ(limit_on(verdict, "sphere").unit, "D");
}

TEST(JudgeLens, AxisGoesRoundAt180) {
  const LensVerdict near = judged("ansi-z80.1-2015", order(-1, -2, 179), reading(-1, -2, 1));
  EXPECT_NEAR(limit_on(near, "axis").deviation, 2, 1e-9);
  EXPECT_TRUE(limit_on(near, "axis").pass);
  EXPECT_FALSE(limit_on(judged("ansi-z80.1-2015", order(-1, -2, 179), reading(-1, -2, 2)), "axis").pass);
  EXPECT_TRUE(skipped(judged("ansi-z80.1-2015", order(-1, 0, 180), reading(-1, 0, 180)), "axis"));
}

/// -4 / -1.5 x 20 is -5.5 / +1.5 x 110.
TEST(JudgeLens, InTheFormOfTheOrder) {
  const LensVerdict verdict = judged("ansi-z80.1-2015", order(-5.5, 1.5, 110), reading(-4, -1.5, 20));
  EXPECT_NEAR(limit_on(verdict, "sphere").measured, -5.5, 1e-12);
  EXPECT_NEAR(limit_on(verdict, "cylinder").measured, 1.5, 1e-12);
  EXPECT_NEAR(limit_on(verdict, "axis").deviation, 0, 1e-9);
}

TEST(JudgeLens, PrismByMillimetresOrComponents) {
  LensOrder ordered = order(-5, 0, 180);
  ordered.prism = {3, 0};
  LensReading read = reading(-5, 0, 180);
  read.prism = {3.3, 0.4};
  const LensLimit whole = limit_on(judged("ansi-z80.1-2015", ordered, read), "prism");
  EXPECT_NEAR(whole.limit, 0.5, 1e-12) << "1 mm by Prentice's rule";
  EXPECT_NEAR(whole.deviation, 0.5, 1e-12) << "the distance of (3.3, 0.4) from (3, 0)";
  const LensVerdict iso = judged("iso-8980-1-2004", ordered, read);
  EXPECT_NEAR(limit_on(iso, "prism_horizontal").limit, 0.37 + 0.5, 1e-12);
  EXPECT_NEAR(limit_on(iso, "prism_vertical").limit, 0.37 + 0.25, 1e-12);
  EXPECT_NEAR(limit_on(iso, "prism_vertical").deviation, 0.4, 1e-12);
}

TEST(JudgeLens, WhatHasNoFigureHasNoVerdict) {
  LensOrder ordered = order(-8, -1, 20);
  ordered.type = LensType::progressive;
  ordered.addition_d = 2;
  const LensVerdict verdict = judged("iso-8980-2-2004", ordered, reading(-8, -1, 20));
  EXPECT_TRUE(skipped(verdict, "cylinder")) << "only the first row is known";
  EXPECT_TRUE(skipped(verdict, "addition")) << "not measured";
  EXPECT_EQ(limit_on(verdict, "meridian_power").limit, 0.18);
  EXPECT_FALSE(LensVerdict{}.passed()) << "nothing judged is not passed";
}

TEST(JudgeLens, LeastSureFigureCounts) {
  LensOrder ordered = order(0, 0, 180);
  EXPECT_EQ(judged("iso-8980-1-2004", ordered, reading(0, 0, 180)).certainty(), Certainty::unverified);
  EXPECT_EQ(judged("ansi-z80.1-2015", ordered, reading(0, 0, 180)).certainty(), Certainty::verified);
  ordered.type = LensType::progressive;
  EXPECT_EQ(judged("ansi-z80.1-2015", ordered, reading(0, 0, 180)).certainty(), Certainty::unverified);
  EXPECT_EQ(LensVerdict{}.certainty(), std::nullopt);
}

/// Examples of FIPS 180-4.
TEST(Sha256, PublishedValues) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  const test::TemporaryFolder folder;
  const auto file = folder.write("million", std::string(1000000, 'a'));
  EXPECT_EQ(sha256_of_file(file), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_THROW((void)sha256_of_file(folder / "none"), Error);
}

}  // namespace
}  // namespace catoptra::app
