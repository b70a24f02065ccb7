// The wavelengths that a dispersed picture is made of, and what each contributes to it.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace catoptra::optics {

/// One wavelength of a picture: linear RGB of the picture = sum over samples of weight * (RGB seen along that
/// wavelength's ray). The weights of all samples add up to the identity, so that without dispersion every
/// colour stays what it is.
struct SpectralSample {
  double wavelength_nm = 0;
  glm::dmat3 weight{1};
};

/// `count` = 1: the d line. 3: colour masks, red at C, green at e and blue at F (one traced index per
/// channel, as the paper's Figure 15). Above 3: the spectrum from 390 to 720 nm in `count` equal steps; scene
/// colours are taken as spectra made of three smooth bands, weighted by the CIE 1931 matching functions.
/// Throws Error for count 2 or < 1.
[[nodiscard]] std::vector<SpectralSample> spectral_samples(int count);

/// CIE 1931 2-degree colour matching functions by the fit of Wyman, Sloan & Shirley, JCGT 2(2), 2013.
[[nodiscard]] glm::dvec3 cie_matching(double wavelength_nm);

/// CIE XYZ (D65) to linear sRGB. Source: IEC 61966-2-1.
[[nodiscard]] glm::dvec3 xyz_to_linear_srgb(const glm::dvec3& xyz);

}  // namespace catoptra::optics
