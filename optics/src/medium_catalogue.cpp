// The built-in media. Every row names its source; indices are for 20 C in air.
#include <array>
#include <utility>

#include "optics/medium.h"

namespace catoptra::optics {
namespace {

/// n_d, n_e and V_d as the trade quotes them; the curve is the two-term Cauchy fit through n_d and V_d.
struct AbbeRow {
  const char* name;
  double nd, ne, vd;
  const char* source;
  Certainty certainty;
};

constexpr std::array<AbbeRow, 12> kAbbeRows{{
    {"CR-39", 1.498, 1.502, 58, "PPG bulletin (n_d); ophthalmiclenses.blogspot.com (V)", Certainty::verified},
    {"Trivex", 1.532, 1.535, 44, "igateoptics.com (n_d); V 43-45 quoted", Certainty::unverified},
    {"Polycarbonate", 1.586, 1.590, 30, "igateoptics.com; V 28-30 quoted", Certainty::verified},
    {"MR-8", 1.598, 1.600, 41, "Mitsui table (n_e, V_e)", Certainty::unverified},
    {"MR-7", 1.665, 1.670, 31, "Mitsui table (n_e, V_e)", Certainty::unverified},
    {"MR-10", 1.665, 1.670, 31, "Mitsui table (n_e, V_e)", Certainty::unverified},
    {"MR-174", 1.737, 1.740, 32, "Mitsui table (n_e, V_e); vendors also quote V 33", Certainty::unverified},
    {"Crown glass", 1.523, 1.52510, 58.76, "Schott B270 data, refractiveindex.info", Certainty::verified},
    {"1.6 glass", 1.601, 0, 41, "trade figure", Certainty::unverified},
    {"1.7 glass", 1.701, 0, 41.6, "trade figure", Certainty::unverified},
    {"1.8 glass", 1.802, 0, 35, "trade figure", Certainty::unverified},
    {"1.9 glass", 1.885, 0, 30.4, "trade figure", Certainty::unverified},
}};

/// n^2 = 1 + sum b L^2 / (L^2 - c), the glass maker's own coefficients b1 c1 b2 c2 b3 c3.
struct SellmeierRow {
  const char* name;
  std::array<double, 6> coefficients;
  double nd, vd;
  double min_nm, max_nm;
};

constexpr std::array<SellmeierRow, 10> kSchottRows{{
    {"N-BK7",
     {1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653},
     1.51680,
     64.17,
     300,
     2500},
    {"N-K5",
     {1.08511833, 0.00661099503, 0.199562005, 0.024110866, 0.930511663, 111.982777},
     1.52249,
     59.48,
     310,
     2500},
    {"N-LAF2",
     {1.80984227, 0.0101711622, 0.15729555, 0.0442431765, 1.0930037, 100.687748},
     1.74397,
     44.85,
     350,
     2500},
    {"N-LAF21",
     {1.87134529, 0.0093332228, 0.25078301, 0.0345637762, 1.22048639, 83.2404866},
     1.78800,
     47.49,
     334,
     2500},
    {"N-LASF44",
     {1.78897105, 0.00872506277, 0.38675867, 0.0308085023, 1.30506243, 92.7743824},
     1.80420,
     46.50,
     334,
     2500},
    {"P-LASF50",
     {1.84910553, 0.00999234757, 0.329828674, 0.0387437988, 1.30400901, 95.8967681},
     1.80860,
     40.46,
     334,
     2500},
    {"N-SF6",
     {1.77931763, 0.0133714182, 0.338149866, 0.0617533621, 2.08734474, 174.01759},
     1.80518,
     25.36,
     370,
     2500},
    {"N-LASF9",
     {2.00029547, 0.0121426017, 0.298926886, 0.0538736236, 1.80691843, 156.530829},
     1.85025,
     32.17,
     365,
     2500},
    {"N-LASF31A",
     {1.96485075, 0.00982060155, 0.475231259, 0.0344713438, 1.48360109, 110.739863},
     1.88300,
     40.76,
     250,
     2500},
    {"N-LASF46B",
     {2.17988922, 0.0125805384, 0.306495184, 0.0567191367, 1.56882437, 105.316538},
     1.90366,
     31.32,
     365,
     2500},
}};

std::vector<Medium> make_media() {
  std::vector<Medium> media{air()};
  for (const AbbeRow& row : kAbbeRows)
    media.push_back(
        {row.name, Dispersion::from_abbe(row.nd, row.vd), row.nd, row.ne, row.vd, row.source, row.certainty});
  for (const SellmeierRow& row : kSchottRows)
    media.push_back({row.name,
                     {DispersionFormula::sellmeier1,
                      {row.coefficients.begin(), row.coefficients.end()},
                      row.min_nm,
                      row.max_nm},
                     row.nd,
                     0,
                     row.vd,
                     "SCHOTT data sheet 2017",
                     Certainty::verified});
  // Polymers measured by laboratories, where the fit is better than the trade's Abbe pair.
  media.push_back(
      {"PMMA",
       {DispersionFormula::sellmeier1, {0.99654, 0.00787, 0.18964, 0.02191, 0.00411, 3.85727}, 405, 1080},
       1.49060,
       1.49261,
       58.00,
       "Szczurowski 2013, refractiveindex.info",
       Certainty::verified});
  media.push_back({"PC Sultanova",
                   {DispersionFormula::sellmeier1, {1.4182, 0.021304}, 436.8, 1052},
                   1.58476,
                   1.58975,
                   27.86,
                   "Sultanova 2009, refractiveindex.info",
                   Certainty::verified});
  media.push_back({"Polystyrene",
                   {DispersionFormula::sellmeier1, {1.4435, 0.020216}, 436.8, 1052},
                   1.59163,
                   1.59640,
                   29.53,
                   "Sultanova 2009, refractiveindex.info",
                   Certainty::verified});
  return media;
}

}  // namespace

const MediumCatalogue& built_in_media() {
  static const MediumCatalogue catalogue(make_media());
  return catalogue;
}

}  // namespace catoptra::optics
