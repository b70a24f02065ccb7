#include "optics/medium.h"

#include <gtest/gtest.h>

#include <cmath>

namespace catoptra::optics {
namespace {

// The makers' own n_d and V_d judge the dispersion coefficients; both were read from other tables than the
// coefficients.
TEST(BuiltInMedia, CurvesReproduceQuotedIndexAndAbbeNumber) {
  for (const Medium& medium : built_in_media().media()) {
    if (medium.vd == 0) continue;
    SCOPED_TRACE(medium.name);
    EXPECT_NEAR(medium.index(kLineD_nm), medium.nd, 2e-5);
    EXPECT_NEAR(medium.dispersion.abbe_number_d(), medium.vd, 0.02);
    EXPECT_FALSE(medium.source.empty());
  }
}

// n_e of laboratory fits, computed elsewhere from the same files.
TEST(BuiltInMedia, LaboratoryFitsReproduceIndexAtE) {
  EXPECT_NEAR(built_in_media().find("N-BK7").index(kLineE_nm), 1.51872, 1e-5);
  EXPECT_NEAR(built_in_media().find("PMMA").index(kLineE_nm), 1.49261, 1e-5);
  EXPECT_NEAR(built_in_media().find("PC Sultanova").index(kLineE_nm), 1.58975, 1e-5);
}

TEST(BuiltInMedia, NamesAreFoundWithoutCaseAndPunctuation) {
  EXPECT_EQ(built_in_media().find("cr39").name, "CR-39");
  EXPECT_EQ(built_in_media().find("n-bk7").name, "N-BK7");
}

TEST(BuiltInMedia, AnUnknownNameListsItsNeighbours) {
  try {
    (void)built_in_media().find("CR-93");
    FAIL() << "an unknown medium was found";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("CR-39"), std::string::npos) << error.what();
  }
}

TEST(ConstantMedium, RefusesAnIndexBelowOne) {
  EXPECT_THROW((void)constant_medium(0.9), Error);
  EXPECT_THROW((void)abbe_medium(1.5, 0), Error);
  EXPECT_DOUBLE_EQ(constant_medium(1.6).index(500), 1.6);
}

// Error of the two-term curve against the Sellmeier fit: at most 4e-4 over 405 to 700 nm for crown glass.
TEST(Dispersion, AbbePairFollowsCrownGlass) {
  const Dispersion pair = Dispersion::from_abbe(1.51680, 64.17);
  const Medium& glass = built_in_media().find("N-BK7");
  for (double nm = 405; nm <= 700; nm += 5) EXPECT_NEAR(pair.index(nm), glass.index(nm), 4e-4) << nm;
}

TEST(Dispersion, TableGoesThroughItsSamplesAndStaysMonotone) {
  const Dispersion table({{656.3, 1.52}, {486.1, 1.53}, {587.6, 1.523}});
  EXPECT_DOUBLE_EQ(table.index(587.6), 1.523);
  EXPECT_DOUBLE_EQ(table.index(400), 1.53);
  double last = 2;
  for (double nm = 486.1; nm < 656.3; nm += 1) {
    EXPECT_LE(table.index(nm), last);
    last = table.index(nm);
  }
}

}  // namespace
}  // namespace catoptra::optics
