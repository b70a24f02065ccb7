// Snell's law and Fresnel's equations at the border of two media.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

namespace catoptra::optics {

/// Refracts the unit direction `d` at the unit normal `n` (Snell, vector form). `n` points against `d`;
/// `eta` = n_from / n_to > 0. Returns a unit direction, or nullopt beyond the critical angle.
/// Source: Hecht 2017, 4.4.
[[nodiscard]] std::optional<glm::dvec3> refract(const glm::dvec3& d, const glm::dvec3& n, double eta);

/// Angle of incidence from which all light is reflected, radians; nullopt where n_from <= n_to.
[[nodiscard]] std::optional<double> critical_angle(double n_from, double n_to);

/// Share of the power that a smooth border reflects, for the two polarisations and for unpolarised light,
/// each in [0, 1]; what is not reflected is transmitted. 1 beyond the critical angle. Source: Hecht
/// 2017, 4.6.2.
struct FresnelReflectance {
  double s = 0;            ///< electric field across the plane of incidence
  double p = 0;            ///< electric field in it
  double unpolarised = 0;  ///< mean of both
};

/// `cos_theta_i` in [0, 1]: cosine of the angle of incidence, in the medium of index `n_from`.
[[nodiscard]] FresnelReflectance fresnel_dielectric(double cos_theta_i, double n_from, double n_to);

/// The same at a metal of complex index n_to + i k_to. Source: Born & Wolf, Principles of Optics, 7th
/// ed., 14.4.
[[nodiscard]] FresnelReflectance fresnel_conductor(double cos_theta_i, double n_from, double n_to,
                                                   double k_to);

}  // namespace catoptra::optics
