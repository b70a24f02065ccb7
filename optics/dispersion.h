// Refractive index as a function of wavelength: the formulas of glass catalogues, Abbe pairs and tables.
#pragma once

#include <string_view>
#include <vector>

namespace catoptra::optics {

/// Spectral lines, nm (ISO 7944 uses d and e as reference wavelengths).
inline constexpr double kLineF_nm = 486.1327, kLineFprime_nm = 479.9914, kLineE_nm = 546.0740,
                        kLineD_nm = 587.5618, kLineC_nm = 656.2725, kLineCprime_nm = 643.8469;

/// How the coefficients c0, c1, ... are read. L is the wavelength in micrometres. The numbers in brackets are
/// those of the .agf catalogue format (nzhagen/zemaxglass).
enum class DispersionFormula {
  constant,    ///< n = c0
  table,       ///< cubic through (wavelength, n) pairs, monotone between neighbours; constant outside
  cauchy,      ///< n = c0 + c1 / L^2 + c2 / L^4 + ...
  schott,      ///< [1] n^2 = c0 + c1 L^2 + c2 L^-2 + c3 L^-4 + c4 L^-6 + c5 L^-8
  sellmeier1,  ///< [2] n^2 = 1 + c0 L^2 / (L^2 - c1) + c2 L^2 / (L^2 - c3) + c4 L^2 / (L^2 - c5)
  herzberger,  ///< [3] n = c0 + c1 H + c2 H^2 + c3 L^2 + c4 L^4 + c5 L^6 with H = 1 / (L^2 - 0.028)
  sellmeier2,  ///< [4] n^2 = 1 + c0 + c1 L^2 / (L^2 - c2^2) + c3 L^2 / (L^2 - c4^2)
  conrady,     ///< [5] n = c0 + c1 / L + c2 / L^3.5
  sellmeier3,  ///< [6] as [2] with four terms
  handbook1,   ///< [7] n^2 = c0 + c1 / (L^2 - c2) - c3 L^2
  handbook2,   ///< [8] n^2 = c0 + c1 L^2 / (L^2 - c2) - c3 L^2
  sellmeier4,  ///< [9] n^2 = c0 + c1 L^2 / (L^2 - c2) + c3 L^2 / (L^2 - c4)
  extended1,   ///< [10] n^2 = c0 + c1 L^2 + c2 L^-2 + c3 L^-4 + c4 L^-6 + c5 L^-8 + c6 L^-10 + c7 L^-12
  sellmeier5,  ///< [11] as [2] with five terms
  extended2,   ///< [12] n^2 = c0 + c1 L^2 + c2 L^-2 + c3 L^-4 + c4 L^-6 + c5 L^-8 + c6 L^4 + c7 L^6
  // Formulas 1 to 6 of the refractiveindex.info database, sums over pairs of coefficients.
  database1,  ///< n^2 = 1 + c0 + sum c1 L^2 / (L^2 - c2^2)
  database2,  ///< n^2 = 1 + c0 + sum c1 L^2 / (L^2 - c2)
  database3,  ///< n^2 = c0 + sum c1 L^c2
  database4,  ///< n^2 = c0 + c1 L^c2 / (L^2 - c3^c4) + c5 L^c6 / (L^2 - c7^c8) + sum c9 L^c10
  database5,  ///< n = c0 + sum c1 L^c2
  database6,  ///< n = 1 + c0 + sum c1 / (c2 - L^-2)
};

/// One point of a table.
struct IndexSample {
  double wavelength_nm = 0, n = 1;
};

/// A dispersion curve. Immutable, cheap to evaluate.
class Dispersion {
 public:
  /// A constant index.
  explicit Dispersion(double n = 1);
  /// Coefficients as the formula lists them; missing ones are 0. `range_nm`: where the fit holds (0, 0:
  /// unknown).
  Dispersion(DispersionFormula formula, std::vector<double> coefficients, double min_nm = 0,
             double max_nm = 0);
  /// A table of at least one sample, in any order of wavelength.
  explicit Dispersion(std::vector<IndexSample> samples);

  /// The two-term Cauchy curve through n_d with Abbe number V_d = (n_d - 1) / (n_F - n_C).
  /// Its error against Sellmeier fits is below 4e-4 for crown glass and PMMA and about 2e-3 at 405 nm for
  /// polycarbonate.
  [[nodiscard]] static Dispersion from_abbe(double nd, double vd);
  /// The same from n_e and V_e = (n_e - 1) / (n_F' - n_C').
  [[nodiscard]] static Dispersion from_abbe_e(double ne, double ve);

  [[nodiscard]] double index(double wavelength_nm) const;
  [[nodiscard]] bool in_range(double wavelength_nm) const;

  /// What the curve was made from; `samples` (by rising wavelength) where the formula is table, else
  /// `coefficients`.
  [[nodiscard]] DispersionFormula formula() const { return formula_; }
  [[nodiscard]] const std::vector<double>& coefficients() const { return coefficients_; }
  [[nodiscard]] const std::vector<IndexSample>& samples() const { return samples_; }

  /// (n_d - 1) / (n_F - n_C); infinity without dispersion.
  [[nodiscard]] double abbe_number_d() const;
  /// (n_e - 1) / (n_F' - n_C').
  [[nodiscard]] double abbe_number_e() const;

 private:
  DispersionFormula formula_ = DispersionFormula::constant;
  std::vector<double> coefficients_;
  std::vector<IndexSample> samples_;
  double min_nm_ = 0, max_nm_ = 0;
};

}  // namespace catoptra::optics
