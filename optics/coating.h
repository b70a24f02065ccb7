// Metal coatings of mirrors: complex refractive index n + ik by wavelength, and what they reflect.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cad_import/error.h"

namespace catoptra::optics {

/// Wavelengths at which linear RGB reflectances are taken, nm: red, green, blue. Three samples, not an
/// integral over the spectrum: metals are smooth there.
inline constexpr double kRed_nm = 650, kGreen_nm = 550, kBlue_nm = 450;

/// Refractive index n and extinction k at one wavelength.
struct ComplexIndexSample {
  double wavelength_nm = 0, n = 1, k = 0;
};

/// An opaque metal layer.
struct Coating {
  std::string name;
  std::vector<ComplexIndexSample> samples;  ///< at least one, wavelengths rising
  std::string source;

  /// n and k at a wavelength: linear between samples, constant outside.
  [[nodiscard]] ComplexIndexSample index(double wavelength_nm) const;

  /// Share of unpolarised light that is reflected, met from a medium of index `n_from` (1: a first-surface
  /// mirror in air; the glass's index: a coating behind glass, without the glass's own front reflection).
  /// `cos_theta_i` in [0, 1]: cosine of the angle of incidence.
  [[nodiscard]] double reflectance(double wavelength_nm, double cos_theta_i = 1, double n_from = 1) const;

  /// The same at kRed_nm, kGreen_nm and kBlue_nm: the linear RGB reflectance of a mirror.
  [[nodiscard]] glm::dvec3 reflectance_rgb(double cos_theta_i = 1, double n_from = 1) const;
};

/// aluminium, silver and chromium.
[[nodiscard]] std::span<const Coating> built_in_coatings();

/// Throws Error naming the nearest names where there is no such coating. Letter case aside.
[[nodiscard]] const Coating& find_coating(std::string_view name);

/// Reads a metal of the refractiveindex.info database (.yml): the first table of n and k. Throws Error naming
/// file and entry.
[[nodiscard]] Coating read_coating_yml(const std::filesystem::path& file);

}  // namespace catoptra::optics
