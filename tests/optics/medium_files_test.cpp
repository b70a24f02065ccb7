// Glass catalogues that users bring: every formula against values computed elsewhere, and damaged files.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>

#include "optics/medium.h"
#include "tests/optics/text_file.h"

namespace catoptra::optics {
namespace {

struct FormulaRow {
  int number;
  const char* coefficients;
  double n550;  ///< at 550 nm, by 30-digit arithmetic from the formula as the format defines it
};

constexpr FormulaRow kFormulas[] = {
    {1, "2.2718929 -0.010108077 0.010592509 0.00020816965 -7.6472538e-06 4.9240991e-07", 1.51852205364},
    {2, "1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653", 1.51852238762},
    {3, "1.5 0.004 0.0002 -0.003 0.0001 -1e-05", 1.51632759404},
    {4, "0.3 1.0 0.1 0.5 9.0", 1.5271914584},
    {5, "1.47 0.01 0.0005", 1.49223410887},
    {6, "0.7 0.005 0.4 0.01 0.9 97.9 0.1 50.0", 1.45672293826},
    {7, "2.4 0.01 0.02 0.008", 1.55980070204},
    {8, "1.35 0.9 0.02 0.008", 1.52029497604},
    {9, "1.3 0.95 0.012 0.9 100.0", 1.51212166325},
    {10, "2.27 -0.01 0.0106 0.0002 -7e-06 5e-07 1e-08 2e-09", 1.51789833394},
    {11, "0.5 0.005 0.3 0.01 0.2 0.015 0.1 50.0 0.9 100.0", 1.42329024135},
    {12, "2.27 -0.01 0.0106 0.0002 -7e-06 5e-07 -0.0001 2e-05", 1.51789334177},
};

std::string glass(const std::string& name, int formula, const std::string& coefficients) {
  std::ostringstream text;
  text << "NM " << name << ' ' << formula << " 517642 1.5168 64.17 0 0 0\nCD " << coefficients
       << "\nLD 0.35 2.5\n";
  return text.str();
}

TEST(Agf, EveryFormulaGivesWhatItSays) {
  std::string text = "CC twelve glasses\n";
  for (const FormulaRow& row : kFormulas)
    text += glass(std::string("G").append(std::to_string(row.number)), row.number, row.coefficients);
  const test::TextFile file("formulas.agf", text);
  const auto media = read_agf(file.path());
  ASSERT_EQ(media.size(), std::size(kFormulas));
  for (std::size_t i = 0; i < media.size(); ++i) {
    EXPECT_NEAR(media[i].index(550), kFormulas[i].n550, 1e-11) << media[i].name;
    EXPECT_EQ(media[i].nd, 1.5168);
    EXPECT_EQ(media[i].vd, 64.17);
    EXPECT_TRUE(media[i].dispersion.in_range(550));
    EXPECT_FALSE(media[i].dispersion.in_range(300));
  }
}

// Carriage returns, zeros of a UTF-16 file and padded coefficients are met in the wild.
TEST(Agf, OtherLineEndsAndEncodings) {
  std::string text = "\xff\xfe";
  for (const char c : glass("N-BK7", 2, kFormulas[1].coefficients)) {
    if (c == '\n') text += std::string("\r\0", 2);
    text += c;
    text += '\0';
  }
  const test::TextFile file("wide.agf", text);
  const test::TextFile plain("plain.agf",
                             glass("N-BK7", 2, std::string(kFormulas[1].coefficients) + " 0 0 0 0"));
  EXPECT_NEAR(read_agf(plain.path())[0].index(550), kFormulas[1].n550, 1e-11);
  EXPECT_NEAR(read_agf(file.path())[0].index(550), kFormulas[1].n550, 1e-11);
}

TEST(Agf, DamagedFilesAreErrors) {
  EXPECT_THROW((void)read_agf("nowhere/glass.agf"), Error);
  const std::string good = glass("A", 1, "2.27 -0.01 0.0106 0.0002 -7e-06 5e-07");
  for (const std::string& text :
       {std::string(), std::string("hello\n"), glass("A", 13, "2.27"), glass("A", 0, "2.27"),
        std::string("NM A\n"), good.substr(0, good.find("CD")), good.substr(0, good.find("CD") + 3),
        good + "NM B 1 1 1.5 60\n", glass("A", 1, "nonsense"), glass("A", 1, "-5"),
        std::string("NM A 1 1 1.5 60\nCD 2.2\nLD 0.3\n")}) {
    const test::TextFile file("damaged.agf", text);
    EXPECT_THROW((void)read_agf(file.path()), Error) << text;
  }
}

TEST(Agf, NamesAreFoundInAUsersCatalogue) {
  const test::TextFile file("user.agf", glass("MY-GLASS", 2, kFormulas[1].coefficients) +
                                            glass("MY-OTHER", 5, kFormulas[4].coefficients));
  MediumCatalogue catalogue = built_in_media();
  catalogue.add(read_agf(file.path()));
  EXPECT_EQ(catalogue.find("my-other").source, "user.agf");
  try {
    (void)catalogue.find("MY-GRASS");
    FAIL() << "an unknown glass was found";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("MY-GLASS"), std::string::npos) << error.what();
  }
}

struct YmlRow {
  int number;
  const char* coefficients;
  double n550;
};

// Formulas of the database at 550 nm, likewise computed elsewhere.
constexpr YmlRow kDatabase[] = {
    {1, "0 0.6961663 0.0684043 0.4079426 0.1162414 0.8974794 9.896161", 1.45991088647},
    {2, "0 1.4182 0.021304", 1.58922805566},
    {3, "2.2 -0.01 2 0.012 -2", 1.49554151446},
    {4, "1.5 0.8 2 0.01 1 0.01 0 0 1 0.02 -2", 1.55773039422},
    {5, "1.46 0.005 -2 0.0001 -4", 1.47762174715},
    {6, "0 0.05792105 238.0185 0.00167917 57.362", 1.0002778376354},
};

TEST(DatabaseYml, EveryFormulaGivesWhatItSays) {
  for (const YmlRow& row : kDatabase) {
    std::string text = "DATA:\n  - type: formula ";
    text.append(std::to_string(row.number));
    text.append("\n    wavelength_range: 0.3 2.0\n    coefficients: ").append(row.coefficients).append("\n");
    const test::TextFile file("formula.yml", text);
    EXPECT_NEAR(read_refractive_index_yml(file.path()).index(550), row.n550, 1e-11) << row.number;
  }
}

TEST(DatabaseYml, DamagedFilesAreErrors) {
  EXPECT_THROW((void)read_refractive_index_yml("nowhere/glass.yml"), Error);
  for (const char* text :
       {"", "DATA:\n", "DATA:\n  - type: formula 7\n    wavelength_range: 0.3 2\n    coefficients: 1 2\n",
        "DATA:\n  - type: formula 2\n    wavelength_range: 0.3 2\n    coefficients: \n",
        "DATA:\n  - type: formula 2\n    coefficients: 0 1 0.01\n",
        "DATA:\n  - type: formula 2\n    wavelength_range: 0.3\n    coefficients: 0 1 0.01\n",
        "DATA:\n  - type: tabulated n\n    data: |\n",
        "DATA:\n  - type: tabulated k\n    data: |\n        0.5 1e-6\n", "DATA:\n  - data: 1\n", "DATA: 5\n",
        "just text\n", "DATA: [", "\t{"}) {
    const test::TextFile file("damaged.yml", text);
    EXPECT_THROW((void)read_refractive_index_yml(file.path()), Error) << text;
  }
}

// Two rows of the same wavelength, as tables joined from two sources have.
TEST(DatabaseYml, RepeatedWavelengthsOfATableDoNoHarm) {
  const test::TextFile file(
      "table.yml",
      "DATA:\n  - type: tabulated n\n    data: |\n        0.5 1.52\n        0.6 1.51\n        0.6 "
      "1.51\n        0.7 1.505\n");
  const Medium medium = read_refractive_index_yml(file.path());
  for (const double nm : {450.0, 550.0, 600.0, 650.0, 800.0}) {
    EXPECT_GE(medium.index(nm), 1.505) << nm;
    EXPECT_LE(medium.index(nm), 1.52) << nm;
  }
}

}  // namespace
}  // namespace catoptra::optics
