#include "optics/refraction.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>

namespace catoptra::optics {
namespace {

/// Squares of both Fresnel amplitudes; index and cosine in an absorbing medium are complex.
FresnelReflectance reflectance(double cos_i, double n_from, std::complex<double> n_to) {
  const std::complex<double> sin_t = n_from / n_to * std::sqrt(std::max(0.0, 1 - cos_i * cos_i));
  const std::complex<double> cos_t = std::sqrt(1.0 - sin_t * sin_t);
  const double s = std::norm((n_from * cos_i - n_to * cos_t) / (n_from * cos_i + n_to * cos_t));
  const double p = std::norm((n_to * cos_i - n_from * cos_t) / (n_to * cos_i + n_from * cos_t));
  return {s, p, 0.5 * (s + p)};
}

}  // namespace

std::optional<glm::dvec3> refract(const glm::dvec3& d, const glm::dvec3& n, double eta) {
  const double cos_i = -glm::dot(d, n);
  const double cos2_t = 1 - eta * eta * (1 - cos_i * cos_i);
  if (cos2_t < 0) return std::nullopt;
  return eta * d + (eta * cos_i - std::sqrt(cos2_t)) * n;  // as long as d and n are, to rounding
}

std::optional<double> critical_angle(double n_from, double n_to) {
  if (n_from <= n_to) return std::nullopt;
  return std::asin(n_to / n_from);
}

FresnelReflectance fresnel_dielectric(double cos_theta_i, double n_from, double n_to) {
  const double sin_t = n_from / n_to * std::sqrt(std::max(0.0, 1 - cos_theta_i * cos_theta_i));
  if (sin_t >= 1) return {1, 1, 1};
  const double cos_t = std::sqrt(1 - sin_t * sin_t);
  const double s = (n_from * cos_theta_i - n_to * cos_t) / (n_from * cos_theta_i + n_to * cos_t);
  const double p = (n_to * cos_theta_i - n_from * cos_t) / (n_to * cos_theta_i + n_from * cos_t);
  return {s * s, p * p, 0.5 * (s * s + p * p)};
}

FresnelReflectance fresnel_conductor(double cos_theta_i, double n_from, double n_to, double k_to) {
  return reflectance(cos_theta_i, n_from, {n_to, k_to});
}

}  // namespace catoptra::optics
