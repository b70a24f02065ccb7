#include "app/src/coating.h"

namespace catoptra::app {
namespace {

// Order of wavelengths: 650, 550, 450 nm; metals at room temperature.
constexpr CoatingEntry kCoatings[] = {
    {"aluminium", {1.558, 1.015, 0.633}, {7.712, 6.627, 5.454}, "Rakic 1995, Applied Optics 34, 4755"},
    {"silver",
     {0.052, 0.060, 0.040},
     {4.409, 3.597, 2.648},
     "Johnson and Christy 1972, Physical Review B 6, 4370"},
    {"chromium",
     {3.107, 3.181, 2.323},
     {3.331, 3.329, 3.135},
     "Johnson and Christy 1974, Physical Review B 9, 5056"},
};

}  // namespace

std::span<const CoatingEntry> coatings() {
  return kCoatings;
}

glm::vec3 coating_reflectance(const CoatingEntry& coating) {
  glm::vec3 rgb{0};
  for (int c = 0; c < 3; ++c) {
    const double n = coating.n[static_cast<std::size_t>(c)], k = coating.k[static_cast<std::size_t>(c)];
    rgb[c] = static_cast<float>(((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k));
  }
  return rgb;
}

}  // namespace catoptra::app
