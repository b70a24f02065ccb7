#include "optics/coating.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/optics/text_file.h"

namespace catoptra::optics {
namespace {

// Reflectance at normal incidence, computed elsewhere from the same sources' n and k, to the digits given
// there; the n and k themselves have three decimals.
TEST(Coating, ReflectsWhatItsSourceSays) {
  struct Row {
    const char* name;
    glm::dvec3 in_air, behind_glass;  // 650, 550, 450 nm; glass of index 1.52
  };
  for (const Row& row : {Row{"aluminium", {0.906, 0.915, 0.922}, {0.863, 0.877, 0.888}},
                         Row{"silver", {0.990, 0.983, 0.980}, {0.986, 0.977, 0.974}},
                         Row{"chromium", {0.556, 0.555, 0.555}, {0.419, 0.417, 0.426}}}) {
    SCOPED_TRACE(row.name);
    const Coating& coating = find_coating(row.name);
    EXPECT_FALSE(coating.source.empty());
    const glm::dvec3 air = coating.reflectance_rgb(), glass = coating.reflectance_rgb(1, 1.52);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(air[c], row.in_air[c], 1e-3);
      EXPECT_NEAR(glass[c], row.behind_glass[c], 1e-3);
    }
  }
}

TEST(Coating, IndexIsLinearBetweenSamplesAndConstantOutside) {
  const Coating& silver = find_coating("Silver");
  EXPECT_NEAR(silver.index(500).k, 0.5 * (2.648 + 3.597), 1e-12);
  EXPECT_NEAR(silver.index(500).n, 0.5 * (0.040 + 0.060), 1e-12);
  EXPECT_EQ(silver.index(550).k, 3.597);
  EXPECT_EQ(silver.index(300).k, 2.648);
  EXPECT_EQ(silver.index(900).k, 4.409);
}

// A metal reflects all light that grazes it, and on the way there unpolarised light loses nothing of note.
TEST(Coating, GrazingLightIsReflected) {
  for (const Coating& coating : built_in_coatings()) {
    EXPECT_NEAR(coating.reflectance(550, 0), 1, 1e-12);
    EXPECT_GT(coating.reflectance(550, 0.1), 0.5);
  }
}

TEST(Coating, AnUnknownNameListsTheNearest) {
  try {
    (void)find_coating("aluminum");
    FAIL() << "an unknown coating was found";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("aluminium"), std::string::npos) << error.what();
  }
}

TEST(CoatingYml, ReadsATableOfNAndK) {
  const test::TextFile file(
      "Metal.yml",
      "DATA:\n  - type: tabulated nk\n    data: |\n        0.60 1.0 6.0\n        0.50 0.8 5.0\n");
  const Coating coating = read_coating_yml(file.path());
  EXPECT_EQ(coating.name, "Metal");
  ASSERT_EQ(coating.samples.size(), 2u);
  EXPECT_NEAR(coating.index(550).n, 0.9, 1e-12);
  EXPECT_NEAR(coating.index(550).k, 5.5, 1e-12);
}

TEST(CoatingYml, DamagedFilesAreErrors) {
  EXPECT_THROW((void)read_coating_yml("nowhere/metal.yml"), Error);
  for (const char* text :
       {"", "DATA:\n", "DATA:\n  - type: tabulated n\n    data: |\n        0.5 1.5\n",
        "DATA:\n  - type: tabulated nk\n    data: |\n        0.5 1.5\n",
        "DATA:\n  - type: tabulated nk\n    data: |\n",
        "DATA:\n  - type: tabulated nk\n    data: |\n        -0.5 1.5 1\n", "DATA: [", "\t{"}) {
    const test::TextFile file("damaged.yml", text);
    EXPECT_THROW((void)read_coating_yml(file.path()), Error) << text;
  }
}

}  // namespace
}  // namespace catoptra::optics
