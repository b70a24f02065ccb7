#include "optics/spectrum.h"

#include <cmath>
#include <glm/matrix.hpp>
#include <string>

#include "cad_import/error.h"
#include "optics/dispersion.h"

namespace catoptra::optics {
namespace {

constexpr double kShortest_nm = 390, kLongest_nm = 720;
// Where the blue band gives way to the green one and the green to the red, and over what width: near the
// crossings of the sRGB primaries' matching functions.
constexpr double kBlueGreen_nm = 490, kGreenRed_nm = 585, kBandWidth_nm = 50;

/// A two-sided Gaussian lobe.
double lobe(double nm, double height, double centre, double left, double right) {
  const double t = (nm - centre) * (nm < centre ? left : right);
  return height * std::exp(-0.5 * t * t);
}

double smooth_step(double x) {
  x = x < 0 ? 0 : x > 1 ? 1 : x;
  return x * x * (3 - 2 * x);
}

/// Three bands (red, green, blue) that add up to 1 at every wavelength.
glm::dvec3 band_spectra(double nm) {
  const double not_blue = smooth_step((nm - kBlueGreen_nm) / kBandWidth_nm + 0.5);
  const double red = smooth_step((nm - kGreenRed_nm) / kBandWidth_nm + 0.5);
  return {red, not_blue - red, 1 - not_blue};
}

glm::dmat3 channel_mask(int channel) {
  glm::dmat3 mask(0);
  mask[channel][channel] = 1;
  return mask;
}

std::vector<SpectralSample> continuous_samples(int count) {
  std::vector<SpectralSample> samples;
  glm::dmat3 sum(0);
  for (int i = 0; i < count; ++i) {
    const double nm = kShortest_nm + (i + 0.5) * (kLongest_nm - kShortest_nm) / count;
    samples.push_back({nm, glm::outerProduct(xyz_to_linear_srgb(cie_matching(nm)), band_spectra(nm))});
    sum += samples.back().weight;
  }
  const glm::dmat3 normalise = glm::inverse(sum);
  for (SpectralSample& sample : samples) sample.weight = sample.weight * normalise;
  return samples;
}

}  // namespace

glm::dvec3 cie_matching(double nm) {
  return {lobe(nm, 0.362, 442.0, 0.0624, 0.0374) + lobe(nm, 1.056, 599.8, 0.0264, 0.0323) -
              lobe(nm, 0.065, 501.1, 0.0490, 0.0382),
          lobe(nm, 0.821, 568.8, 0.0213, 0.0247) + lobe(nm, 0.286, 530.9, 0.0613, 0.0322),
          lobe(nm, 1.217, 437.0, 0.0845, 0.0278) + lobe(nm, 0.681, 459.0, 0.0385, 0.0725)};
}

glm::dvec3 xyz_to_linear_srgb(const glm::dvec3& c) {
  return {3.2406 * c.x - 1.5372 * c.y - 0.4986 * c.z, -0.9689 * c.x + 1.8758 * c.y + 0.0415 * c.z,
          0.0557 * c.x - 0.2040 * c.y + 1.0570 * c.z};
}

std::vector<SpectralSample> spectral_samples(int count) {
  if (count == 1) return {{kLineD_nm, glm::dmat3(1)}};
  if (count == 3)
    return {{kLineC_nm, channel_mask(0)}, {kLineE_nm, channel_mask(1)}, {kLineF_nm, channel_mask(2)}};
  if (count < 4)
    throw Error("", "wavelengths " + std::to_string(count), "is not a number of wavelengths",
                "give 1, 3, or more than 3");
  return continuous_samples(count);
}

}  // namespace catoptra::optics
