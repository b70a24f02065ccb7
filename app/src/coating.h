// Mirror coatings by name.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>

namespace catoptra::app {

/// A first-surface coating: reflectance in air at normal incidence, from n and k by R =
/// ((n-1)^2+k^2)/((n+1)^2+k^2).
struct CoatingEntry {
  std::string_view name;
  std::array<double, 3> n, k;  ///< refractive index and extinction at 650, 550 and 450 nm
  std::string_view source;
};

/// Every coating known. Sources: refractiveindex.info (CC0) main/Al Rakic 1995, main/Ag and main/Cr
/// Johnson-Christy.
[[nodiscard]] std::span<const CoatingEntry> coatings();

/// Linear RGB reflectance of a coating: its reflectance at 650, 550 and 450 nm (three samples, not an
/// integral over the spectrum: the coatings are smooth there). The angle of incidence is not regarded.
[[nodiscard]] glm::vec3 coating_reflectance(const CoatingEntry& coating);

}  // namespace catoptra::app
