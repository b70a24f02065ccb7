#include "optics/src/homography.h"

#include "optics/src/least_squares.h"

namespace catoptra::optics {

// Direct linear transformation: multiplied by its denominator the map is linear in the eight parameters.
// Weighting by the last denominator turns the algebraic error into the geometric one, which a few rounds
// settle.
glm::dvec2 homography_denominator(std::span<const MapSample> samples) {
  if (samples.size() < 4) return glm::dvec2(0);
  glm::dvec2 g{0};
  for (int round = 0; round < 4; ++round) {
    LeastSquares<8> fit;
    for (const auto& [p, m] : samples) {
      const double q = 1 + g.x * p.x + g.y * p.y;
      if (!(q > 0)) continue;
      fit.add({p.x, p.y, 1, 0, 0, 0, -m.x * p.x, -m.x * p.y}, m.x, 1 / (q * q));
      fit.add({0, 0, 0, p.x, p.y, 1, -m.y * p.x, -m.y * p.y}, m.y, 1 / (q * q));
    }
    const auto h = fit.solve();
    g = {h[6], h[7]};
  }
  return g;
}

}  // namespace catoptra::optics
