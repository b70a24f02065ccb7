#include "optics/dispersion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace catoptra::optics {
namespace {

constexpr std::size_t kMaxPairs = 8;  // the database's longest formula has eight pairs behind the constant
constexpr std::size_t kMaxCoefficients = 1 + 2 * kMaxPairs;

/// sum over pairs (b, c) of b L^2 / (L^2 - c).
double sellmeier_sum(const std::vector<double>& c, std::size_t first, std::size_t terms, double l2) {
  double sum = 0;
  for (std::size_t i = 0; i < terms; ++i) {
    const double b = c[first + 2 * i];
    if (b != 0) sum += b * l2 / (l2 - c[first + 2 * i + 1]);
  }
  return sum;
}

/// The same with squared resonances: b L^2 / (L^2 - c^2).
double sellmeier_root_sum(const std::vector<double>& c, std::size_t first, std::size_t terms, double l2) {
  double sum = 0;
  for (std::size_t i = 0; i < terms; ++i) {
    const double b = c[first + 2 * i], root = c[first + 2 * i + 1];
    if (b != 0) sum += b * l2 / (l2 - root * root);
  }
  return sum;
}

/// sum over pairs (b, e) of b L^e.
double exponent_sum(const std::vector<double>& c, std::size_t first, double l) {
  double sum = 0;
  for (std::size_t i = first; i + 1 < c.size(); i += 2)
    if (c[i] != 0) sum += c[i] * std::pow(l, c[i + 1]);
  return sum;
}

/// sum over pairs (b, c) of b / (c - L^-2).
double gas_sum(const std::vector<double>& c, double l2) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < c.size(); i += 2)
    if (c[i] != 0) sum += c[i] / (c[i + 1] - 1 / l2);
  return sum;
}

/// c0 + c1 L^2 + c2 L^-2 + c3 L^-4 + ... with `inverse` inverse powers.
double power_sum(const std::vector<double>& c, std::size_t inverse, double l2) {
  double sum = c[0] + c[1] * l2, power = 1;
  for (std::size_t i = 0; i < inverse; ++i) {
    power /= l2;
    sum += c[2 + i] * power;
  }
  return sum;
}

/// Slopes of the monotone cubic interpolant. Source: Fritsch & Butland 1984.
double monotone_slope(const std::vector<IndexSample>& s, std::size_t i) {
  const auto secant = [&](std::size_t k) {
    return (s[k + 1].n - s[k].n) / (s[k + 1].wavelength_nm - s[k].wavelength_nm);
  };
  if (i == 0) return secant(0);
  if (i + 1 == s.size()) return secant(i - 1);
  const double a = secant(i - 1), b = secant(i);
  if (a * b <= 0) return 0;
  const double h0 = s[i].wavelength_nm - s[i - 1].wavelength_nm,
               h1 = s[i + 1].wavelength_nm - s[i].wavelength_nm;
  const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / a + w1 / b);
}

double interpolate(const std::vector<IndexSample>& s, double wavelength_nm) {
  if (s.size() == 1 || wavelength_nm <= s.front().wavelength_nm) return s.front().n;
  if (wavelength_nm >= s.back().wavelength_nm) return s.back().n;
  const auto above =
      std::upper_bound(s.begin(), s.end(), wavelength_nm,
                       [](double w, const IndexSample& sample) { return w < sample.wavelength_nm; });
  const std::size_t i = static_cast<std::size_t>(above - s.begin()) - 1;
  const double h = s[i + 1].wavelength_nm - s[i].wavelength_nm, x = (wavelength_nm - s[i].wavelength_nm) / h;
  const double m0 = monotone_slope(s, i) * h, m1 = monotone_slope(s, i + 1) * h;
  const double y = 1 - x;
  return s[i].n * y * y * (1 + 2 * x) + s[i + 1].n * x * x * (3 - 2 * x) + x * y * (m0 * y - m1 * x);
}

}  // namespace

Dispersion::Dispersion(double n) : coefficients_(kMaxCoefficients, 0.0) {
  coefficients_[0] = n;
}

Dispersion::Dispersion(DispersionFormula formula, std::vector<double> coefficients, double min_nm,
                       double max_nm)
    : formula_(formula), coefficients_(std::move(coefficients)), min_nm_(min_nm), max_nm_(max_nm) {
  coefficients_.resize(std::max(coefficients_.size(), kMaxCoefficients), 0.0);
}

Dispersion::Dispersion(std::vector<IndexSample> samples)
    : formula_(DispersionFormula::table), samples_(std::move(samples)) {
  std::sort(samples_.begin(), samples_.end(),
            [](const IndexSample& a, const IndexSample& b) { return a.wavelength_nm < b.wavelength_nm; });
  // Tables joined from two sources repeat a wavelength; a slope there has no meaning.
  const auto repeated = std::ranges::unique(samples_, {}, &IndexSample::wavelength_nm);
  samples_.erase(repeated.begin(), repeated.end());
  min_nm_ = samples_.front().wavelength_nm;
  max_nm_ = samples_.back().wavelength_nm;
}

Dispersion Dispersion::from_abbe(double nd, double vd) {
  const auto inverse_square = [](double nm) { return 1e6 / (nm * nm); };
  const double b = (nd - 1) / vd / (inverse_square(kLineF_nm) - inverse_square(kLineC_nm));
  return {DispersionFormula::cauchy, {nd - b * inverse_square(kLineD_nm), b}};
}

Dispersion Dispersion::from_abbe_e(double ne, double ve) {
  const auto inverse_square = [](double nm) { return 1e6 / (nm * nm); };
  const double b = (ne - 1) / ve / (inverse_square(kLineFprime_nm) - inverse_square(kLineCprime_nm));
  return {DispersionFormula::cauchy, {ne - b * inverse_square(kLineE_nm), b}};
}

double Dispersion::index(double wavelength_nm) const {
  const std::vector<double>& c = coefficients_;
  const double l = wavelength_nm * 1e-3, l2 = l * l;
  switch (formula_) {
    case DispersionFormula::constant:
      return c[0];
    case DispersionFormula::table:
      return interpolate(samples_, wavelength_nm);
    case DispersionFormula::cauchy:
      return c[0] + c[1] / l2 + c[2] / (l2 * l2) + c[3] / (l2 * l2 * l2);
    case DispersionFormula::schott:
      return std::sqrt(power_sum(c, 4, l2));
    case DispersionFormula::sellmeier1:
      return std::sqrt(1 + sellmeier_sum(c, 0, 3, l2));
    case DispersionFormula::herzberger: {
      const double h = 1 / (l2 - 0.028);
      return c[0] + c[1] * h + c[2] * h * h + c[3] * l2 + c[4] * l2 * l2 + c[5] * l2 * l2 * l2;
    }
    case DispersionFormula::sellmeier2:
      return std::sqrt(1 + c[0] + sellmeier_root_sum(c, 1, 2, l2));
    case DispersionFormula::conrady:
      return c[0] + c[1] / l + c[2] / std::pow(l, 3.5);
    case DispersionFormula::sellmeier3:
      return std::sqrt(1 + sellmeier_sum(c, 0, 4, l2));
    case DispersionFormula::handbook1:
      return std::sqrt(c[0] + c[1] / (l2 - c[2]) - c[3] * l2);
    case DispersionFormula::handbook2:
      return std::sqrt(c[0] + c[1] * l2 / (l2 - c[2]) - c[3] * l2);
    case DispersionFormula::sellmeier4:
      return std::sqrt(c[0] + sellmeier_sum(c, 1, 2, l2));
    case DispersionFormula::extended1:
      return std::sqrt(power_sum(c, 6, l2));
    case DispersionFormula::sellmeier5:
      return std::sqrt(1 + sellmeier_sum(c, 0, 5, l2));
    case DispersionFormula::extended2:
      return std::sqrt(power_sum(c, 4, l2) + c[6] * l2 * l2 + c[7] * l2 * l2 * l2);
    case DispersionFormula::database1:
      return std::sqrt(1 + c[0] + sellmeier_root_sum(c, 1, kMaxPairs, l2));
    case DispersionFormula::database2:
      return std::sqrt(1 + c[0] + sellmeier_sum(c, 1, kMaxPairs, l2));
    case DispersionFormula::database3:
      return std::sqrt(c[0] + exponent_sum(c, 1, l));
    case DispersionFormula::database4:
      return std::sqrt(c[0] + c[1] * std::pow(l, c[2]) / (l2 - std::pow(c[3], c[4])) +
                       c[5] * std::pow(l, c[6]) / (l2 - std::pow(c[7], c[8])) + exponent_sum(c, 9, l));
    case DispersionFormula::database5:
      return c[0] + exponent_sum(c, 1, l);
    case DispersionFormula::database6:
      return 1 + c[0] + gas_sum(c, l2);
  }
  return 1;
}

bool Dispersion::in_range(double wavelength_nm) const {
  return max_nm_ <= 0 || (wavelength_nm >= min_nm_ && wavelength_nm <= max_nm_);
}

double Dispersion::abbe_number_d() const {
  const double spread = index(kLineF_nm) - index(kLineC_nm);
  return spread > 0 ? (index(kLineD_nm) - 1) / spread : std::numeric_limits<double>::infinity();
}

double Dispersion::abbe_number_e() const {
  const double spread = index(kLineFprime_nm) - index(kLineCprime_nm);
  return spread > 0 ? (index(kLineE_nm) - 1) / spread : std::numeric_limits<double>::infinity();
}

}  // namespace catoptra::optics
